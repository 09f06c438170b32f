#include <shapespace/mesh/volume.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <shapespace/mesh/internal/geometry.h>

namespace shapespace {
namespace {

/// The enclosed volume, relative to a ball of the same surface area.
double ShareOfBall(const Eigen::Matrix3Xi& triangles, const Shape& shape) {
  double area = 0;
  for (const auto& t : triangles.colwise()) area += internal::TriangleArea(shape, t);
  const double ball = std::pow(area, 1.5) / (6 * std::sqrt(internal::kPi));
  return ball > 0 ? EnclosedVolume(triangles, shape) / ball : 0;
}

}  // namespace

bool IsClosed(const Eigen::Matrix3Xi& triangles) {
  std::vector<std::pair<int, int>> up, down;  // smaller vertex first
  for (const auto& t : triangles.colwise()) {
    for (int k = 0; k < 3; ++k) {
      const int a = t(k), b = t((k + 1) % 3);
      if (a < b) up.emplace_back(a, b);
      if (a > b) down.emplace_back(b, a);
    }
  }
  std::sort(up.begin(), up.end());
  std::sort(down.begin(), down.end());
  return !up.empty() && up == down;
}

double EnclosedVolume(const Eigen::Matrix3Xi& triangles, const Shape& shape) {
  // Relative to the mean of the vertices, so that determinants do not grow with the distance from
  // the origin.
  const Eigen::Vector3d centre = shape.rowwise().mean();
  double volume = 0;
  for (const auto& t : triangles.colwise()) {
    const Eigen::Vector3d a = shape.col(t(0)) - centre, b = shape.col(t(1)) - centre,
                          c = shape.col(t(2)) - centre;
    volume += a.dot(b.cross(c)) / 6;
  }
  return volume;
}

bool EnclosesVolume(const Eigen::Matrix3Xi& triangles, const Shape& shape) {
  constexpr double kMinShare = 1e-6;
  return IsClosed(triangles) && std::abs(ShareOfBall(triangles, shape)) > kMinShare;
}

bool IsInsideOut(const Eigen::Matrix3Xi& triangles, const Shape& reference, const Shape& pose) {
  // Bodies of people and animals have a fifth to a half of the ball's volume; a body thinner than a
  // leaf may turn over.
  constexpr double kMinShare = 0.01;
  const double before = ShareOfBall(triangles, reference);
  const double after = ShareOfBall(triangles, pose);
  // The test for a closed mesh is last because it is the slowest and rarely needed.
  return before * after < 0 && std::min(std::abs(before), std::abs(after)) > kMinShare &&
         IsClosed(triangles);
}

}  // namespace shapespace
