#ifndef SHAPESPACE_SOLVERS_OPTIMISE_FRAMES_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_FRAMES_H_

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Dense>

#include <shapespace/mesh/shape.h>

// Private.

namespace shapespace::internal {

/// Two edges of a triangle, and a normal with the square root of twice the area as its length, so
/// that it scales with the triangle (Sumner and Popovic 2004, section 3).
inline Eigen::Matrix3d Frame(const Shape& shape, const Eigen::Vector3i& triangle) {
  Eigen::Matrix3d frame;
  frame.col(0) = shape.col(triangle(1)) - shape.col(triangle(0));
  frame.col(1) = shape.col(triangle(2)) - shape.col(triangle(0));
  const Eigen::Vector3d normal = frame.col(0).cross(frame.col(1));
  frame.col(2) = normal / std::sqrt(std::max(normal.norm(), std::numeric_limits<double>::min()));
  return frame;
}

/// Its inverse; for a collapsed triangle the pseudo-inverse.
inline Eigen::Matrix3d InverseFrame(const Eigen::Matrix3d& frame) {
  return frame.completeOrthogonalDecomposition().pseudoInverse();
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_FRAMES_H_
