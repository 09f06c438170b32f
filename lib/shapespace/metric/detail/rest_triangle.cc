#include <shapespace/metric/detail/rest_triangle.h>

#include <cmath>

#include <shapespace/metric/triangle_strain.h>

namespace shapespace::internal {

Eigen::Vector4d RestNumbers(const MetricBasis& basis, double collapsed_squared, int a, int b,
                            int c) {
  // The mean of the first fundamental forms is that of one triangle in a space of 3 coordinates for
  // each pose; its sides' components are found without the loss of digits that its determinant has.
  double along_squared = 0, product = 0;
  for (const Shape& pose : basis.poses) {
    const Eigen::Vector3d u = pose.col(b) - pose.col(a);
    along_squared += u.squaredNorm();
    product += u.dot(pose.col(c) - pose.col(a));
  }
  const auto count = static_cast<double>(basis.poses.size());
  if (!(along_squared > count * collapsed_squared)) return TriangleStrain::UsualNumbers();
  const double share = product / along_squared;
  double across_squared = 0;
  for (const Shape& pose : basis.poses) {
    const Eigen::Vector3d u = pose.col(b) - pose.col(a);
    across_squared += (pose.col(c) - pose.col(a) - share * u).squaredNorm();
  }
  if (!(across_squared > count * collapsed_squared)) return TriangleStrain::UsualNumbers();
  // The triangle at rest has the edges (along, 0) and (share along, across); E has those of the
  // equilateral triangle of the same area.
  const double along = std::sqrt(along_squared / count), across = std::sqrt(across_squared / count);
  const double side = std::sqrt(2 / std::sqrt(3.0) * along * across);
  const Eigen::Matrix2d edges{{along, share * along}, {0, across}};
  const Eigen::Matrix2d equilateral{{side, 0.5 * side}, {0, std::sqrt(0.75) * side}};
  const Eigen::Matrix2d inverse{{1, -std::sqrt(1 / 3.0)}, {0, std::sqrt(4 / 3.0)}};
  // The map from the equilateral triangle, whose determinant is 1, is a rotation times the
  // symmetric P, and R = E^-1 P^-1 E.
  const Eigen::Matrix2d map = edges * inverse / side, squared = map.transpose() * map;
  const double root = std::sqrt(squared.trace() + 2);
  const Eigen::Matrix2d of_p{{(1 + squared(1, 1)) / root, -squared(0, 1) / root},
                             {-squared(0, 1) / root, (1 + squared(0, 0)) / root}};
  const Eigen::Matrix2d rest = inverse / side * of_p * equilateral;
  return {rest(0, 0), rest(1, 0), rest(0, 1), rest(1, 1)};
}

}  // namespace shapespace::internal
