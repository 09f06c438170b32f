#ifndef SHAPESPACE_MESH_VOLUME_H_
#define SHAPESPACE_MESH_VOLUME_H_

#include <Eigen/Core>

#include <shapespace/mesh/shape.h>

namespace shapespace {

// Of triangles, 3 x T, each column the vertices of one, in its winding.

/// True if there are triangles and every edge has as many that run along it in one direction as in
/// the other, so that they enclose a volume.
bool IsClosed(const Eigen::Matrix3Xi& triangles);

/// The volume that a closed mesh encloses, in the cubed unit of `shape` (3 x m); negative if the
/// triangles are wound inwards. Exact to rounding in the size of the shape, however far from the
/// origin it lies.
double EnclosedVolume(const Eigen::Matrix3Xi& triangles, const Shape& shape);

/// Whether `pose` is turned inside out against `reference`, as the mirror image of a closed body
/// is: both enclose a volume that is clearly none, of opposite signs. False if the mesh is open.
bool IsMirrored(const Eigen::Matrix3Xi& triangles, const Shape& reference, const Shape& pose);

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_VOLUME_H_
