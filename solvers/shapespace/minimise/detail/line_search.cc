#include <shapespace/minimise/detail/line_search.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace shapespace::internal {
namespace {

// The usual constants of quasi-Newton methods: a small decrease is sufficient, and the slope need
// only be slightly flatter than at the start.
constexpr double kDecrease = 1e-4, kFlatness = 0.9;
// Relative differences of sums of millions of terms below this are rounding.
constexpr double kValueRounding = 1e-14;
constexpr int kMaxTrials = 20;
// A new trial stays away from the bracket's ends by this share of its width; without a bracket it
// goes at most kFurthest times as far.
constexpr double kMargin = 0.1, kFurthest = 10;

// The minimum of the cubic through both values and slopes, limited to the bracket; the bracket's
// middle if there is no minimum, or a value is not finite.
double Between(const LinePoint& low, const LinePoint& high) {
  const double width = high.step - low.step;
  const double sum = low.slope + high.slope - 3 * (high.value - low.value) / width;
  const double root = std::sqrt(sum * sum - low.slope * high.slope);
  const double share = 1 - (high.slope + root - sum) / (high.slope - low.slope + 2 * root);
  return low.step + width * (std::isfinite(share) ? std::clamp(share, kMargin, 1 - kMargin) : 0.5);
}

// The zero of the slope, extrapolated linearly from `before` and `low`.
double Beyond(const LinePoint& before, const LinePoint& low) {
  const double flatter = low.slope - before.slope;
  const double further =
      flatter > 0 ? -low.slope / flatter * (low.step - before.step) : kFurthest * low.step;
  return low.step + std::clamp(further, low.step, (kFurthest - 1) * low.step);
}

}  // namespace

LinePoint SearchLine(const LinePoint& start, const std::function<LinePoint(double step)>& evaluate,
                     double longest) {
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  LinePoint low = start, high = {kInfinity, kInfinity, kInfinity};
  double step = std::min(1.0, longest);
  for (int trial = 0; trial < kMaxTrials; ++trial) {
    const LinePoint point = evaluate(step);
    const bool decreases = point.value <= start.value + kDecrease * step * start.slope;
    const bool equal =
        std::abs(point.value - start.value) <= kValueRounding * std::abs(start.value) &&
        point.slope <= (2 * kDecrease - 1) * start.slope;
    if ((decreases || equal) && std::isfinite(point.slope)) {
      // A point beyond the minimum is accepted too, which saves trials, unless the decrease may be
      // due to rounding.
      const bool lower = point.value < start.value && point.slope >= kFlatness * start.slope;
      if (lower || std::abs(point.slope) <= -kFlatness * start.slope) return point;
      if (point.slope < 0 && step == longest) return point;
      if (point.slope > 0) {
        high = point;
        step = Between(low, high);
      } else {
        const LinePoint before = low;
        low = point;
        step = high.step < kInfinity ? Between(low, high) : std::min(Beyond(before, low), longest);
      }
    } else {
      high = point;
      step = Between(low, high);
    }
  }
  return low.step > 0 ? evaluate(low.step) : start;
}

}  // namespace shapespace::internal
