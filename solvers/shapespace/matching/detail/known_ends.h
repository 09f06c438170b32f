#ifndef SHAPESPACE_MATCHING_DETAIL_KNOWN_ENDS_H_
#define SHAPESPACE_MATCHING_DETAIL_KNOWN_ENDS_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/matching/detail/markers.h>
#include <shapespace/matching/detail/matching_body.h>

namespace shapespace::internal {

/// What pairs that are known to correspond say of extremities. A pair at an extremity of each body
/// says that the one is the other, and is no landmark beside them: a limb with two would count for
/// as much as two limbs.
struct KnownEnds {
  /// Extremities are vertices of the working surfaces, as the pairs are.
  KnownEnds(const MatchingBody& on_template, const std::vector<int>& template_extremities,
            const MatchingBody& on_target, const std::vector<int>& target_extremities,
            const VertexPairs& known);

  /// The other known pairs.
  VertexPairs landmarks;
  /// To be added to how different extremities are (template x target): much where a known pair says
  /// that the one is not the other.
  Eigen::MatrixXd difference;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_KNOWN_ENDS_H_
