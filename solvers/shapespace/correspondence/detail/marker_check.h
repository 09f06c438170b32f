#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_MARKER_CHECK_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_MARKER_CHECK_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/correspondence/correspondence.h>

namespace shapespace::internal {

/// Finds markers that contradict the others, the worst first. Each marker is predicted from all
/// others: its distances from them along the target's surface should be equal to those on the
/// template. The prediction is the vertex with the least sum of absolute differences, which is
/// robust against a few wrong markers. The worst marker is removed and the search repeated.
///
/// Distances are those of `MarkerDistances`; `target_vertices` are the markers'.
std::vector<CorrespondenceSummary::Doubt> FindDoubtfulMarkers(
    const Eigen::MatrixXf& on_template, const Eigen::MatrixXf& on_target,
    const std::vector<int>& template_vertices, const std::vector<int>& target_vertices);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_MARKER_CHECK_H_
