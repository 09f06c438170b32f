#ifndef SHAPESPACE_BODIES_BEND_H_
#define SHAPESPACE_BODIES_BEND_H_

#include <cmath>

#include <Eigen/Core>

namespace shapespace::internal {

/// sin(x) / x; the first terms of its series are exact to rounding where the quotient is not.
inline double Sinc(double x) { return std::abs(x) < 1e-4 ? 1 - x * x / 6 : std::sin(x) / x; }

/// Takes space bent about the y axis: the x axis goes to an arc of the given curvature that stays
/// at the origin and rises to +z, keeping its length; what was normal to it stays so, at the same
/// distance. Exact for a curvature of zero and accurate near it.
inline Eigen::Vector3d Bend(const Eigen::Vector3d& point, double curvature) {
  const double turn = curvature * point.x();
  const double half = Sinc(turn / 2) * point.x() / 2;  // half the chord, seen from the origin
  return {point.x() * Sinc(turn) - point.z() * std::sin(turn), point.y(),
          2 * half * std::sin(turn / 2) + point.z() * std::cos(turn)};
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BODIES_BEND_H_
