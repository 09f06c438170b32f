#ifndef SHAPESPACE_MESH_INTERNAL_POLYGONS_H_
#define SHAPESPACE_MESH_INTERNAL_POLYGONS_H_

#include <vector>

#include <Eigen/Core>

// Polygons in the form of `Soup`, `polygon_begin` of size P + 1 and `corners`.

namespace shapespace::internal {

/// \throw MeshError if `polygon_begin` does not ascend from 0 to the number of corners, a polygon
///        has fewer than three corners, or an index is outside [0, num_vertices).
void CheckPolygons(int num_vertices, const std::vector<int>& polygon_begin,
                   const std::vector<int>& corners);

/// Triangulates valid polygons as fans from their smallest vertices: 3 x T, polygon after polygon,
/// for each two triangles less than it has corners.
Eigen::Matrix3Xi Fans(const std::vector<int>& polygon_begin, const std::vector<int>& corners);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MESH_INTERNAL_POLYGONS_H_
