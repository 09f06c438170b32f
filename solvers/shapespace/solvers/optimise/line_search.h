#ifndef SHAPESPACE_SOLVERS_OPTIMISE_LINE_SEARCH_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_LINE_SEARCH_H_

#include <functional>

namespace shapespace::internal {

/// A function's value and slope where one is after `step` times a direction.
struct LinePoint {
  double step, value, slope;
};

/// A step that satisfies the Wolfe conditions (Nocedal and Wright, Numerical Optimization, section
/// 3.1): 1 if it does, else found by bracketing and cubic interpolation. `start` is at step
/// 0 and goes down. Values that are not finite count as too large. Near the minimum, where values
/// differ by rounding only, slopes decide (Hager and Zhang 2005, approximate Wolfe conditions).
/// \return the last point that `evaluate` was called for; if none was found that satisfies both
///         conditions, one that is lower than the start, or else `start`.
LinePoint SearchLine(const LinePoint& start, const std::function<LinePoint(double step)>& evaluate);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_LINE_SEARCH_H_
