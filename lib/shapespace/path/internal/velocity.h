#ifndef SHAPESPACE_PATH_INTERNAL_VELOCITY_H_
#define SHAPESPACE_PATH_INTERNAL_VELOCITY_H_

#include <shapespace/path/path.h>

namespace shapespace::internal {

/// The velocity of the placed vertices at shape `at`, seen from one side of it (`step` is -1 or 1),
/// by differences of second order over the two next shapes.
inline Shape OneSidedVelocity(const Path& path, int at, int step) {
  const double a = path.parameters[at + step] - path.parameters[at];
  const double b = path.parameters[at + 2 * step] - path.parameters[at];
  const Shape here = path.Placed(at);
  const Shape near = path.Placed(at + step) - here, far = path.Placed(at + 2 * step) - here;
  return (b / a * near - a / b * far) / (b - a);
}

/// The cubics on [0, 1] that vanish at both ends and have the slope 1 at one end and 0 at the
/// other: by them velocities at the ends of an interval are changed and nothing else is.
struct EndSlopes {
  double first, last;

  explicit EndSlopes(double s) : first(s * (1 - s) * (1 - s)), last(-s * s * (1 - s)) {}
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_PATH_INTERNAL_VELOCITY_H_
