#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_UNFOLD_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_UNFOLD_H_

#include <array>
#include <vector>

#include <shapespace/correspondence/detail/closest.h>

namespace shapespace::internal {

/// Neighbours of each vertex, with M. Floater's mean value weights ("Mean value coordinates",
/// 2003). They are positive, so that no folds arise, and approximately preserve the triangles'
/// shapes: in a plane each vertex is the mean of the neighbours around it.
class MeanValueWeights {
 public:
  /// `connectivity` is kept by reference.
  MeanValueWeights(const Connectivity& connectivity, const Shape& rest);

  /// Calls use(neighbour, weight) for each.
  template <typename Use>
  void ForEach(int v, const Use& use) const {
    for (const int e : connectivity_.EdgesOfVertices()[v]) {
      const double weight = weights_[e][v == connectivity_.Edges()(0, e) ? 0 : 1];
      if (weight > 0) use(connectivity_.OtherEnd(e, v), weight);
    }
  }

 private:
  const Connectivity& connectivity_;
  std::vector<std::array<double, 2>> weights_;  // per edge: for its first vertex and its second
};

/// Which triangles have normals opposite to the target's: the comparison is with the sum of the
/// normals of the target's triangles on which the corners lie.
std::vector<bool> TurnedTriangles(const Level& level, const Shape& shape, const Target& target,
                                  const std::vector<ClosestPoint>& closest);

/// The points of the target that correspond to the vertices of `shape`: the nearest point that is
/// compatible by normal and by distances from the markers; if there is none, the nearest that is
/// compatible by distances; otherwise the nearest.
std::vector<ClosestPoint> MapVertices(const Level& level, const Shape& shape, const Target& target);

/// Removes folds. Around triangles whose normals are opposite to the target's, vertices other than
/// `held` move to a weighted mean of their neighbours, as in W. Tutte's embedding ("How to draw a
/// graph", 1963), and are projected back onto the target. Patches grow ring by ring until the fold
/// is gone, in several passes; a patch without success is restored. Parts of the template that the
/// target does not have, such as the inside of a mouth, become flat.
void Unfold(const Level& level, const Shape& rest, const Target& target,
            const std::vector<int>& held, Shape* shape);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_UNFOLD_H_
