#include <shapespace/transfer/internal/frames.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Geometry>
#include <Eigen/QR>

namespace shapespace::internal {

Eigen::Matrix3d Frame(const Shape& shape, const Eigen::Vector3i& triangle) {
  Eigen::Matrix3d frame;
  frame.col(0) = shape.col(triangle(1)) - shape.col(triangle(0));
  frame.col(1) = shape.col(triangle(2)) - shape.col(triangle(0));
  const Eigen::Vector3d normal = frame.col(0).cross(frame.col(1));
  frame.col(2) = normal / std::sqrt(std::max(normal.norm(), std::numeric_limits<double>::min()));
  return frame;
}

Eigen::Matrix3d InverseFrame(const Eigen::Matrix3d& frame) {
  return frame.completeOrthogonalDecomposition().pseudoInverse();
}

}  // namespace shapespace::internal
