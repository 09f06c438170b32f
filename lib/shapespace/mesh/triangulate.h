#ifndef SHAPESPACE_MESH_TRIANGULATE_H_
#define SHAPESPACE_MESH_TRIANGULATE_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/shape.h>

namespace shapespace {

/// Cuts polygons into triangles by ear clipping, so that concave polygons are covered exactly once.
/// Polygons are as in `Soup`: `polygon_begin` of size P + 1, `corners` with indices into the
/// columns of every pose. All poses are cut alike: each polygon is flattened in every pose (onto
/// the plane across its vector area), and the mean of these, turned onto each other and taken in
/// one size, decides. Of the ears that can be cut, the one nearest to equilateral is taken. The
/// result does not depend on the corner at which the list of a polygon begins, nor on the place,
/// orientation and size of the poses.
/// \return vertices, 3 x T, polygon after polygon, two triangles less than a polygon has corners,
///         wound as the polygon is: what `Connectivity::Make` takes.
/// \throw MeshError if there is no pose, `polygon_begin` does not fit `corners`, a polygon has
///        fewer than three corners, or an index is out of range.
Eigen::Matrix3Xi Triangulate(const std::vector<int>& polygon_begin, const std::vector<int>& corners,
                             const std::vector<Shape>& poses);

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_TRIANGULATE_H_
