#ifndef SHAPESPACE_MESH_INTERNAL_SURFACE_TRIANGLES_H_
#define SHAPESPACE_MESH_INTERNAL_SURFACE_TRIANGLES_H_

#include <Eigen/Core>

#include <shapespace/mesh/internal/polygons.h>
#include <shapespace/mesh/seams.h>
#include <shapespace/mesh/soup.h>

namespace shapespace::internal {

/// The triangles of a mesh as fans, with those vertices joined that are at seams in its own shape
/// and in that of another pose: whether a body is closed does not depend on how a file stores it.
inline Eigen::Matrix3Xi SurfaceTriangles(const Soup& soup, const Soup& pose) {
  Eigen::Matrix3Xi triangles = Fans(soup.polygon_begin, soup.corners);
  const Seams seams = FindSeams(soup.polygon_begin, soup.corners, {soup.vertices, pose.vertices});
  if (seams.joined == 0) return triangles;
  return triangles.unaryExpr([&](int v) { return seams.representatives[v]; });
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MESH_INTERNAL_SURFACE_TRIANGLES_H_
