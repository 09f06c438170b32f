#ifndef SHAPESPACE_MATCHING_DETAIL_CANDIDATE_MAPS_H_
#define SHAPESPACE_MATCHING_DETAIL_CANDIDATE_MAPS_H_

#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/matching/detail/assignments.h>
#include <shapespace/matching/detail/landmarks.h>
#include <shapespace/matching/detail/matching_body.h>
#include <shapespace/matching/detail/zoomout.h>

namespace shapespace::internal {

/// A map that was made of an assignment of extremities.
struct CandidateMap {
  Assignment assignment;
  SpectralMap map;
};

/// Makes maps of assignments, at least one, by ZoomOut, from descriptors of the landmarks: the
/// extremities of each body, and after them as many points of each that are known to correspond.
/// Of maps that are nearly the same, the one of the cheapest assignment remains.
std::vector<CandidateMap> MakeMaps(const MatchingBody& on_template, const MatchingBody& on_target,
                                   const Landmarks& template_landmarks,
                                   const Landmarks& target_landmarks,
                                   const std::vector<Assignment>& assignments, Progress* progress);

/// A finer map of functions from one of vertices, with which each vertex of the template has one of
/// the target, and the reverse.
SpectralMap RefineMap(const MatchingBody& on_template, const MatchingBody& on_target,
                      const std::vector<int>& to_target, const std::vector<int>& to_template,
                      Progress* progress);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_CANDIDATE_MAPS_H_
