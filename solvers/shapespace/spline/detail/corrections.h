#ifndef SHAPESPACE_SPLINE_DETAIL_CORRECTIONS_H_
#define SHAPESPACE_SPLINE_DETAIL_CORRECTIONS_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/spline/spline.h>

namespace shapespace::internal {

/// A stretch of a chain between two poses, for any number of quantities, one 3-vector (a column)
/// each: how far they go, and how fast at both ends, per interval.
struct Interval {
  double length = 1;  ///< in time
  Eigen::Matrix3Xd way, first_velocity, last_velocity;
};

/// Makes the velocities of a chain continuous: cubic splines through the same values at the poses
/// have velocities v_i, and the chain is corrected by the cubic that has no value, and the missing
/// velocity, at both ends of each interval. With s in [0, 1] on interval i, h_i long, and u the
/// chain's velocities at its ends,
///   c(s) = s (1 - s)^2 (h_i v_i - u_i^+) - s^2 (1 - s) (h_i v_{i+1} - u_{i+1}^-).
class Corrections {
 public:
  /// `first` and `last` are the velocities per unit of time at the ends, for `kClamped`. A limit of
  /// 0 is none. One interval alone is not corrected, unless it is clamped.
  Corrections(std::vector<Interval> intervals, SplineEnds ends, double limit,
              const Eigen::Matrix3Xd& first, const Eigen::Matrix3Xd& last);

  /// The correction at s of an interval.
  Eigen::Matrix3Xd At(int interval, double s) const;

 private:
  std::vector<Interval> intervals_;
  std::vector<Eigen::Matrix3Xd> velocities_;  // at the beginning of each interval, and at the end
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SPLINE_DETAIL_CORRECTIONS_H_
