#ifndef SHAPESPACE_MESH_VOLUME_H_
#define SHAPESPACE_MESH_VOLUME_H_

#include <Eigen/Core>

#include <shapespace/mesh/shape.h>

namespace shapespace {

// `triangles`, 3 x T, contains the vertices of each triangle, in its orientation.

/// Whether there are triangles and every edge has equally many of them in both directions, so that
/// they enclose a volume.
bool IsClosed(const Eigen::Matrix3Xi& triangles);

/// The volume enclosed by a closed mesh, in the cubed unit of `shape` (3 x m); negative if the
/// triangles are oriented inwards. Accurate to rounding relative to the size of the shape, at any
/// distance from the origin.
double EnclosedVolume(const Eigen::Matrix3Xi& triangles, const Shape& shape);

/// Whether the mesh is closed and its volume is not zero up to the rounding of coordinates in
/// single precision, as that of two sheets that are joined along their border is.
bool EnclosesVolume(const Eigen::Matrix3Xi& triangles, const Shape& shape);

/// Whether both shapes enclose volumes that are clearly not zero, of opposite signs: the pose is a
/// mirror image (`IsMirrored`, mesh/mirrored.h), or has a part that is turned inside out. False if
/// the mesh is open.
bool IsInsideOut(const Eigen::Matrix3Xi& triangles, const Shape& reference, const Shape& pose);

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_VOLUME_H_
