#ifndef SHAPESPACE_BODIES_DETAIL_POLYGONISE_H_
#define SHAPESPACE_BODIES_DETAIL_POLYGONISE_H_

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

/// Replaces `mesh` by about `triangles` nearly equilateral triangles with all vertices on the
/// surface of `cones`; edges are longer where the body is thicker. Repeatedly splits, collapses and
/// flips edges and moves vertices within the surface: M. Botsch, L. Kobbelt, "A Remeshing Approach
/// to Multiresolution Modeling", SGP 2004. Keeps the topology.
TriangleMesh Remesh(const TriangleMesh& mesh, const std::vector<RoundCone>& cones, int triangles);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BODIES_DETAIL_POLYGONISE_H_
