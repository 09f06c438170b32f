#ifndef SHAPESPACE_BODIES_POLYGONISE_H_
#define SHAPESPACE_BODIES_POLYGONISE_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/bodies/grid.h>
#include <shapespace/bodies/implicit.h>

namespace shapespace::internal {

struct TriangleMesh {
  std::vector<Eigen::Vector3d> points;
  TriangleList triangles;
};

/// The surface of `cones` as a grid of cells of the given size sees it, by marching tetrahedra:
/// closed, wound outwards, a manifold; its triangles may be as bad as can be.
TriangleMesh March(const std::vector<RoundCone>& cones, double cell);

/// `mesh` in about `triangles` nearly equilateral triangles, with all vertices on the surface of
/// `cones`; sides are the longer the thicker the body is. Rounds of splitting, collapsing and
/// flipping edges and of moving vertices within the surface: M. Botsch, L. Kobbelt, "A Remeshing
/// Approach to Multiresolution Modeling", SGP 2004. Keeps the topology.
TriangleMesh Remesh(const TriangleMesh& mesh, const std::vector<RoundCone>& cones, int triangles);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BODIES_POLYGONISE_H_
