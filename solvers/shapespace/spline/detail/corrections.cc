#include <shapespace/spline/detail/corrections.h>

#include <algorithm>
#include <utility>

#include <shapespace/path/internal/velocity.h>

namespace shapespace::internal {
namespace {

using Columns = Eigen::Matrix3Xd;

// A tridiagonal system: below_[i] x_{i-1} + diagonal_[i] x_i + above_[i] x_{i+1} = right_[i].
struct Tridiagonal {
  std::vector<double> below, diagonal, above;
  std::vector<Columns> right;

  explicit Tridiagonal(size_t size) : below(size), diagonal(size), above(size), right(size) {}

  void SetRow(size_t i, double b, double d, double a, Columns columns) {
    below[i] = b;
    diagonal[i] = d;
    above[i] = a;
    right[i] = std::move(columns);
  }

  // By elimination (Thomas), which is stable because the matrices here are diagonally dominant, but
  // for the not-a-knot rows, whose elimination leaves such a matrix.
  std::vector<Columns> Solve() && {
    for (size_t i = 1; i < diagonal.size(); ++i) {
      const double factor = below[i] / diagonal[i - 1];
      diagonal[i] -= factor * above[i - 1];
      right[i] -= factor * right[i - 1];
    }
    for (size_t i = diagonal.size(); i-- > 0;) {
      if (i + 1 < diagonal.size()) right[i] -= above[i] * right[i + 1];
      right[i] /= diagonal[i];
    }
    return std::move(right);
  }
};

// Mean velocity of an interval.
Columns Slope(const Interval& interval) { return interval.way / interval.length; }

// The row of pose i between intervals `before` and `after`: the second derivative is continuous.
void SetInner(const Interval& before, const Interval& after, size_t i, Tridiagonal* system) {
  const double h = before.length, k = after.length;
  system->SetRow(i, k, 2 * (h + k), h, 3 * (k * Slope(before) + h * Slope(after)));
}

// The velocity at the end of `first` on the parabola through both intervals.
Columns NotAKnotRight(const Interval& first, const Interval& second) {
  const double h = first.length, k = second.length;
  return ((h + 2 * (h + k)) * k * Slope(first) + h * h * Slope(second)) / (h + k);
}

// Cyclic: the last pose is the first. Solved as a tridiagonal system with a correction of rank one
// (Sherman and Morrison).
std::vector<Columns> PeriodicVelocities(const std::vector<Interval>& intervals) {
  const size_t count = intervals.size();
  if (count == 2) {  // both neighbours of a pose are the other one
    const auto right = [&](int i) -> Columns {
      const Interval &before = intervals[1 - i], &after = intervals[i];
      return 3 * (after.length * Slope(before) + before.length * Slope(after));
    };
    const double sum = intervals[0].length + intervals[1].length;
    const Columns a = right(0), b = right(1);
    const Columns first = (2 * a - b) / (3 * sum), second = (2 * b - a) / (3 * sum);
    return {first, second, first};
  }
  Tridiagonal system(count);
  for (size_t i = 0; i < count; ++i) {
    SetInner(intervals[(i + count - 1) % count], intervals[i], i, &system);
  }
  const double corner_above = system.below[0], corner_below = system.above[count - 1];
  const double gamma = -system.diagonal[0];
  system.below[0] = system.above[count - 1] = 0;
  system.diagonal[0] -= gamma;
  system.diagonal[count - 1] -= corner_above * corner_below / gamma;
  Tridiagonal rank_one = system;
  for (Columns& right : rank_one.right) right = Columns::Zero(3, 1);
  rank_one.right[0](0) = gamma;
  rank_one.right[count - 1](0) = corner_below;
  std::vector<Columns> x = std::move(system).Solve();
  const std::vector<Columns> z = std::move(rank_one).Solve();
  const double share = corner_above / gamma;
  const double denominator = 1 + z[0](0) + share * z[count - 1](0);
  const Columns factor = (x[0] + share * x[count - 1]) / denominator;
  for (size_t i = 0; i < count; ++i) x[i] -= z[i](0) * factor;
  x.push_back(x[0]);
  return x;
}

std::vector<Columns> Velocities(const std::vector<Interval>& intervals, SplineEnds ends,
                                const Columns& first, const Columns& last) {
  const size_t count = intervals.size();
  if (ends == SplineEnds::kPeriodic) return PeriodicVelocities(intervals);
  Tridiagonal system(count + 1);
  for (size_t i = 1; i < count; ++i) SetInner(intervals[i - 1], intervals[i], i, &system);
  const Interval &a = intervals.front(), &b = intervals.back();
  if (ends == SplineEnds::kClamped) {
    system.SetRow(0, 0, 1, 0, first);
    system.SetRow(count, 0, 1, 0, last);
  } else if (ends == SplineEnds::kNatural || count == 1) {
    system.SetRow(0, 0, 2, 1, 3 * Slope(a));
    system.SetRow(count, 1, 2, 0, 3 * Slope(b));
  } else if (count == 2) {  // one parabola
    system.SetRow(0, 0, 1, 1, 2 * Slope(a));
    system.SetRow(count, 1, 1, 0, 2 * Slope(b));
  } else {
    const Interval &second = intervals[1], &last_but_one = intervals[count - 2];
    system.SetRow(0, 0, second.length, a.length + second.length, NotAKnotRight(a, second));
    system.SetRow(count, b.length + last_but_one.length, last_but_one.length, 0,
                  NotAKnotRight(b, last_but_one));
  }
  return std::move(system).Solve();
}

// Limits the velocities at a pose by the slower of its two intervals.
void Limit(const Interval& before, const Interval& after, double limit, Columns* velocities) {
  const Eigen::RowVectorXd slower = (before.way.colwise().norm() / before.length)
                                        .cwiseMin(after.way.colwise().norm() / after.length);
  for (Eigen::Index i = 0; i < velocities->cols(); ++i) {
    const double most = limit * slower(i), norm = velocities->col(i).norm();
    if (norm > most) velocities->col(i) *= most / norm;
  }
}

}  // namespace

Corrections::Corrections(std::vector<Interval> intervals, SplineEnds ends, double limit,
                         const Columns& first, const Columns& last)
    : intervals_(std::move(intervals)), velocities_(Velocities(intervals_, ends, first, last)) {
  const size_t count = intervals_.size();
  if (limit > 0) {
    for (size_t i = 1; i < count; ++i) {
      Limit(intervals_[i - 1], intervals_[i], limit, &velocities_[i]);
    }
    const Interval &a = intervals_.front(), &b = intervals_.back();
    const bool periodic = ends == SplineEnds::kPeriodic;
    if (ends != SplineEnds::kClamped) {
      Limit(periodic ? b : a, a, limit, &velocities_[0]);
      Limit(b, periodic ? a : b, limit, &velocities_[count]);
    }
  }
}

Columns Corrections::At(int interval, double s) const {
  const Interval& i = intervals_[interval];
  const EndSlopes slopes(s);
  return slopes.first * (i.length * velocities_[interval] - i.first_velocity) +
         slopes.last * (i.length * velocities_[interval + 1] - i.last_velocity);
}

}  // namespace shapespace::internal
