#ifndef SHAPESPACE_OUTPUT_NORMALS_H_
#define SHAPESPACE_OUTPUT_NORMALS_H_

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

// Private.

namespace shapespace::internal {

/// Normals for smooth shading that leaves sharp edges sharp: a corner of a triangle averages, by
/// area, the triangles around its vertex that lie within a crease angle of its own.
/// \return unit normals, 3 x 3F, column 3 f + k for corner k of triangle f; zero where only
/// triangles
///         without area meet.
Eigen::Matrix3Xf CornerNormals(const Connectivity& connectivity, const Shape& shape);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_NORMALS_H_
