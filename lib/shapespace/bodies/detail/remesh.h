#ifndef SHAPESPACE_BODIES_DETAIL_REMESH_H_
#define SHAPESPACE_BODIES_DETAIL_REMESH_H_

#include <vector>

#include <shapespace/bodies/detail/implicit.h>
#include <shapespace/bodies/detail/marching_tetrahedra.h>

namespace shapespace::internal {

/// Replaces `mesh` by about `triangles` nearly equilateral triangles with all vertices on the
/// surface of `cones`; edges are longer where the body is thicker. Repeatedly splits, collapses and
/// flips edges and moves vertices within the surface: M. Botsch, L. Kobbelt, "A Remeshing Approach
/// to Multiresolution Modeling", SGP 2004. Keeps the topology.
TriangleMesh Remesh(const TriangleMesh& mesh, const std::vector<RoundCone>& cones, int triangles);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BODIES_DETAIL_REMESH_H_
