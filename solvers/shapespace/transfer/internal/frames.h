#ifndef SHAPESPACE_TRANSFER_INTERNAL_FRAMES_H_
#define SHAPESPACE_TRANSFER_INTERNAL_FRAMES_H_

#include <Eigen/Core>

#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// Two edges of a triangle, and a normal with the square root of twice the area as its length, so
/// that it scales with the triangle (Sumner and Popovic 2004, section 3).
Eigen::Matrix3d Frame(const Shape& shape, const Eigen::Vector3i& triangle);

/// Its inverse; for a collapsed triangle the pseudo-inverse.
Eigen::Matrix3d InverseFrame(const Eigen::Matrix3d& frame);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_TRANSFER_INTERNAL_FRAMES_H_
