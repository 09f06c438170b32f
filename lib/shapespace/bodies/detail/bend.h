#ifndef SHAPESPACE_BODIES_DETAIL_BEND_H_
#define SHAPESPACE_BODIES_DETAIL_BEND_H_

#include <cmath>

#include <Eigen/Core>

namespace shapespace::internal {

/// sin(x) / x; near 0 the first terms of the series, which are accurate to rounding there.
inline double Sinc(double x) { return std::abs(x) < 1e-4 ? 1 - x * x / 6 : std::sin(x) / x; }

/// Bends space about the y axis: maps the x axis to an arc of the given curvature that passes
/// through the origin and rises to +z, with the same length; normals of the axis remain normals, at
/// the same distance. Exact for a curvature of zero and accurate near it.
inline Eigen::Vector3d Bend(const Eigen::Vector3d& point, double curvature) {
  const double turn = curvature * point.x();
  const double half = Sinc(turn / 2) * point.x() / 2;  // half the chord, seen from the origin
  return {point.x() * Sinc(turn) - point.z() * std::sin(turn), point.y(),
          2 * half * std::sin(turn / 2) + point.z() * std::cos(turn)};
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BODIES_DETAIL_BEND_H_
