#ifndef SHAPESPACE_MATCHING_DETAIL_PART_MAPS_H_
#define SHAPESPACE_MATCHING_DETAIL_PART_MAPS_H_

#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/matching/detail/candidate_maps.h>
#include <shapespace/matching/detail/markers.h>
#include <shapespace/matching/detail/matching_body.h>
#include <shapespace/matching/detail/zoomout.h>

namespace shapespace::internal {

// Maps of a target that is a part of what the template is. They send the target to the template
// alone. Both surfaces have area 1; how much of the template the target is, and therefore in which
// ratio lengths are, is not known: each map has a scale.

/// Extremities without which no map of a part can be found. With three, too many cut bodies had no
/// right assignment.
inline constexpr int kFewestOfAPart = 2;

/// Assignments of the target's extremities to the template's inner ones, with which the distances
/// agree under any of several scales: at most `count` of its inner ones alone, then at most `count`
/// with one or more on its border (MatchingBody::part_extremities), each cheapest first. Known
/// pairs are landmarks too. `difference` is added to how different extremities are (template x
/// target).
struct ScaledAssignment {
  Assignment assignment;
  double scale = 1;
};
std::vector<ScaledAssignment> AssignAtScales(const MatchingBody& on_template,
                                             const Landmarks& template_landmarks,
                                             const MatchingBody& on_target,
                                             const Landmarks& target_landmarks,
                                             const Eigen::MatrixXd& difference, int count);

/// Different maps of these assignments, made by ZoomOut from the target to the template. Each
/// begins with the scale of its assignment, and then takes the one that its own distances have.
std::vector<CandidateMap> MakePartMaps(const MatchingBody& on_template,
                                       const Landmarks& template_landmarks,
                                       const MatchingBody& on_target,
                                       const Landmarks& target_landmarks,
                                       const std::vector<ScaledAssignment>& assignments,
                                       Progress* progress);

/// A finer map of functions from one of vertices, with which each vertex of the target has one of
/// the template.
SpectralMap RefinePartMap(const MatchingBody& on_template, const MatchingBody& on_target,
                          const std::vector<int>& to_template, Progress* progress);

/// The ratio of distances on the template to those on the target, the median over pairs.
double RelativeScale(const MatchingBody& on_template, const MatchingBody& on_target,
                     const VertexPairs& pairs);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_PART_MAPS_H_
