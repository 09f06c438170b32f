#ifndef SHAPESPACE_MINIMISE_DETAIL_LINE_SEARCH_H_
#define SHAPESPACE_MINIMISE_DETAIL_LINE_SEARCH_H_

#include <functional>
#include <limits>

namespace shapespace::internal {

/// Value and slope of a function along a direction, at `step` times the direction.
struct LinePoint {
  double step, value, slope;
};

/// Finds a step that satisfies the Wolfe conditions (Nocedal and Wright, Numerical Optimization,
/// section 3.1): 1 if it does, otherwise by bracketing and cubic interpolation. `start` is at step
/// 0 and has a negative slope. Values that are not finite count as too large. Near the minimum,
/// where values differ only by rounding, slopes are compared instead (Hager and Zhang 2005,
/// approximate Wolfe conditions). \return the last point for which `evaluate` was called; if no
/// point satisfies both conditions, one lower than the start, or else `start`. No step is longer
/// than `longest`; at that step a sufficient decrease is enough.
LinePoint SearchLine(const LinePoint& start, const std::function<LinePoint(double step)>& evaluate,
                     double longest = std::numeric_limits<double>::infinity());

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MINIMISE_DETAIL_LINE_SEARCH_H_
