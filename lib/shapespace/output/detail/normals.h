#ifndef SHAPESPACE_OUTPUT_DETAIL_NORMALS_H_
#define SHAPESPACE_OUTPUT_DETAIL_NORMALS_H_

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// Normals for smooth shading with sharp edges: the normal at a corner of a triangle is the
/// area-weighted mean over those triangles around the vertex whose normals are within a crease
/// angle of the triangle's own.
/// \return unit normals, 3 x 3F, column 3 f + k for corner k of triangle f; zero if all triangles
///         there have no area.
Eigen::Matrix3Xf CornerNormals(const Connectivity& connectivity, const Shape& shape);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_NORMALS_H_
