#ifndef SHAPESPACE_SOLVERS_CORRESPONDENCE_MARKER_CHECK_H_
#define SHAPESPACE_SOLVERS_CORRESPONDENCE_MARKER_CHECK_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/solvers/correspondence.h>

// Private.

namespace shapespace::internal {

/// Markers that the others contradict, the worst first. Each marker is predicted by all others: it
/// should lie on the target as far from them, along the surface, as it does on the template. Where
/// sums of absolute differences are least it is expected, so that a few wrong markers do not spoil
/// the prediction of the right ones. The worst is taken out, then the next is looked for.
///
/// Distances are those of `MarkerDistances`; `target_vertices` are the markers'.
std::vector<CorrespondenceSummary::Doubt> FindDoubtfulMarkers(
    const Eigen::MatrixXf& on_template, const Eigen::MatrixXf& on_target,
    const std::vector<int>& template_vertices, const std::vector<int>& target_vertices);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_CORRESPONDENCE_MARKER_CHECK_H_
