#ifndef SHAPESPACE_MATCHING_DETAIL_CANDIDATE_MAPS_H_
#define SHAPESPACE_MATCHING_DETAIL_CANDIDATE_MAPS_H_

#include <utility>
#include <vector>

#include <Eigen/Core>

#include <shapespace/base/progress.h>
#include <shapespace/matching/detail/assignments.h>
#include <shapespace/matching/detail/landmarks.h>
#include <shapespace/matching/detail/matching_body.h>
#include <shapespace/matching/detail/zoomout.h>

namespace shapespace::internal {

/// A map, and the assignment of extremities of which it was made, if it was.
struct CandidateMap {
  Assignment assignment;
  SpectralMap map;
};

/// Descriptors of MatchingBody::spread of both bodies by the landmarks that an assignment joins and
/// those that are known, which come after the extremities.
std::pair<Eigen::MatrixXf, Eigen::MatrixXf> DescribeBoth(const Landmarks& template_landmarks,
                                                         int template_extremities,
                                                         const Landmarks& target_landmarks,
                                                         int target_extremities,
                                                         const Assignment& assignment);

/// Starts of maps from descriptors of the landmarks: the extremities of each body, and after them
/// as many points of each that are known to correspond.
std::vector<CandidateMap> StartAtLandmarks(const MatchingBody& on_template,
                                           const MatchingBody& on_target,
                                           const Landmarks& template_landmarks,
                                           const Landmarks& target_landmarks,
                                           const std::vector<Assignment>& assignments);

/// Starts of maps of bodies in similar poses, which need no extremities, such as faces, leaves and
/// vases: nearest points, after one body's principal axes have become the other's in each of the 24
/// ways that do not reflect.
std::vector<CandidateMap> StartAtAxes(const MatchingBody& on_template,
                                      const MatchingBody& on_target);

/// Refines starts by ZoomOut. Of maps that are nearly the same, the first remains.
std::vector<CandidateMap> MakeMaps(const MatchingBody& on_template, const MatchingBody& on_target,
                                   std::vector<CandidateMap> starts, Progress* progress);

/// Of maps that send nearly all samples to the same places, leaves the first. `direction` says
/// which of the map's samples: those that have images on `body`.
void RemoveRepeated(const MatchingBody& body, std::vector<int> SpectralMap::*direction,
                    std::vector<CandidateMap>* maps);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_CANDIDATE_MAPS_H_
