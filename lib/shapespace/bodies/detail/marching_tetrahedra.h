#ifndef SHAPESPACE_BODIES_DETAIL_MARCHING_TETRAHEDRA_H_
#define SHAPESPACE_BODIES_DETAIL_MARCHING_TETRAHEDRA_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/bodies/detail/grid.h>
#include <shapespace/bodies/detail/implicit.h>

namespace shapespace::internal {

struct TriangleMesh {
  std::vector<Eigen::Vector3d> points;
  TriangleList triangles;
};

/// The surface of `cones`, sampled on a grid of cells of the given size, by marching tetrahedra: a
/// closed manifold, oriented outwards; its triangles may be of any quality.
TriangleMesh March(const std::vector<RoundCone>& cones, double cell);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BODIES_DETAIL_MARCHING_TETRAHEDRA_H_
