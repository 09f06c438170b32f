#ifndef SHAPESPACE_MESH_TIES_H_
#define SHAPESPACE_MESH_TIES_H_

#include <memory>
#include <utility>
#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// Stiffeners between connected components that stay near each other: eyes, teeth, hair, clothes,
/// and what a hand holds. Without them nothing in a metric says where a component is relative to
/// others.
struct Ties {
  std::vector<std::pair<int, int>> stiffeners;  ///< ascending, the smaller vertex first
  int tied = 0;                                 ///< components that are tied to another one
  int loose = 0;  ///< components that are near another one, but do not stay so, and have no tie
};

/// Chooses ties for the components of a mesh, which are those that its edges of any kind connect,
/// from its poses, of which there is at least one, all finite.
///
/// Of two components the one of smaller extent is tied to the other, at several points that are
/// spread over it (farthest-point sampling), each by three edges in different directions to the
/// other's vertices around the nearest place, so that position and orientation are held. A point
/// serves only if its distances to those vertices are alike in all poses: nothing is tied that
/// parts, passes by or slides along. The ties connect components to trees: each to the largest of
/// those that are about as near as the nearest one.
///
/// The choice is invariant under rigid motion and scale of each pose and under their order, and the
/// same for any number of threads. O(m log m) for one pose.
Ties FindTies(const Connectivity& connectivity, const std::vector<Shape>& poses);

/// The same mesh with further stiffeners.
std::shared_ptr<const Connectivity> WithStiffeners(
    const Connectivity& connectivity, const std::vector<std::pair<int, int>>& stiffeners);

/// The mesh without its stiffeners, for what regards the surface alone: neighbours, distances along
/// it, connected components. `connectivity` itself if it has none.
std::shared_ptr<const Connectivity> WithoutStiffeners(
    const std::shared_ptr<const Connectivity>& connectivity);

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_TIES_H_
