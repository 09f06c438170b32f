#ifndef SHAPESPACE_MESH_TRIANGULATE_H_
#define SHAPESPACE_MESH_TRIANGULATE_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/shape.h>

namespace shapespace {

/// Triangulates polygons by ear clipping, so that concave polygons are covered exactly once.
/// Polygons are as in `Soup`: `polygon_begin` of size P + 1, `corners` with indices into the
/// columns of every pose. The triangulation is the same for all poses: each polygon is projected in
/// every pose onto the plane perpendicular to its vector area; these projections are aligned,
/// scaled to equal size and averaged, and the mean is triangulated. Of the possible ears the one
/// nearest to equilateral is cut. The result does not depend on the first corner in the list of a
/// polygon, nor on the position, orientation and size of the poses. \return vertices, 3 x T,
/// polygon after polygon, for each two triangles less than it has corners, with the polygon's
/// orientation: the argument of `Connectivity::Make`.
/// \throw MeshError if there is no pose, `polygon_begin` does not fit `corners`, a polygon has
///        fewer than three corners, or an index is out of range.
Eigen::Matrix3Xi Triangulate(const std::vector<int>& polygon_begin, const std::vector<int>& corners,
                             const std::vector<Shape>& poses);

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_TRIANGULATE_H_
