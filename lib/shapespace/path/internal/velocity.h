#ifndef SHAPESPACE_PATH_INTERNAL_VELOCITY_H_
#define SHAPESPACE_PATH_INTERNAL_VELOCITY_H_

#include <shapespace/path/path.h>

namespace shapespace::internal {

/// The velocity of the placed vertices at shape `at`, seen from one side of it (`step` is -1 or 1),
/// by differences of second order over the two next shapes; of first order if there is only one.
inline Shape OneSidedVelocity(const Path& path, int at, int step) {
  const Shape here = path.Placed(at), near = path.Placed(at + step) - here;
  const double a = path.parameters[at + step] - path.parameters[at];
  const int next = at + 2 * step;
  if (next < 0 || next >= path.NumShapes()) return near / a;
  const double b = path.parameters[next] - path.parameters[at];
  const Shape far = path.Placed(next) - here;
  return (b / a * near - a / b * far) / (b - a);
}

/// Whether the path ends where it begins, in its first pose.
inline bool IsCycle(const Path& path) {
  const Shape first = path.Placed(path.poses.front()), last = path.Placed(path.poses.back());
  return (last - first).norm() <= 1e-9 * (first.colwise() - first.col(0)).norm();
}

/// The cubics on [0, 1] that vanish at both ends and have the slope 1 at one end and 0 at the
/// other: by them velocities at the ends of an interval are changed and nothing else is.
struct EndSlopes {
  double first, last;

  explicit EndSlopes(double s) : first(s * (1 - s) * (1 - s)), last(-s * s * (1 - s)) {}
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_PATH_INTERNAL_VELOCITY_H_
