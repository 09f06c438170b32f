#ifndef SHAPESPACE_MESH_DETAIL_RECUT_H_
#define SHAPESPACE_MESH_DETAIL_RECUT_H_

#include <shapespace/mesh/soup.h>

// Polygons that one of two meshes cuts along other diagonals than the other.

namespace shapespace::internal {

/// If two valid meshes with the same number of vertices become the same polygons when the diagonals
/// that one of them does not have are taken out, such as quads and the triangles that they were cut
/// into, or triangles that were cut from quads in two ways: the number of polygons that are cut in
/// different ways. Otherwise 0.
int CountRecutPolygons(const Soup& a, const Soup& b);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MESH_DETAIL_RECUT_H_
