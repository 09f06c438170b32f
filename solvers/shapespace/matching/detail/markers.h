#ifndef SHAPESPACE_MATCHING_DETAIL_MARKERS_H_
#define SHAPESPACE_MATCHING_DETAIL_MARKERS_H_

#include <functional>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <shapespace/matching/detail/matching_body.h>
#include <shapespace/matching/detail/zoomout.h>

namespace shapespace::internal {

/// Pairs of vertices of the working surfaces of template and target.
using VertexPairs = std::vector<std::pair<int, int>>;

/// Markers of a map: vertices that are spread over the template, and their images. Each is the
/// farthest from those before it among the template's even samples whose way to the target and
/// back ends near where it began. The ends of limbs `extremities` precede them: where their way
/// does not end so, with their partners, unless other ends are near. At most 40, farther than 0.06
/// from the pairs `given`, which are not part of the result; the even samples are so far from all
/// others too. `points` has a column for each vertex of each body. `admits(from, to)` says whether
/// a pair may be a marker.
VertexPairs ChooseMarkers(const MatchingBody& on_template, const MatchingBody& on_target,
                          const AlignedPoints& points, const VertexPairs& extremities,
                          const VertexPairs& given,
                          const std::function<bool(int from, int to)>& admits);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_MARKERS_H_
