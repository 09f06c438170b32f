#include <shapespace/geodesic/internal/arc_length.h>

#include <shapespace/path/energy.h>

namespace shapespace::internal {

std::vector<double> ArcLengthTimes(const Metric& metric, const std::vector<Shape>& shapes) {
  constexpr double kUniformShare = 0.01;
  const int segments = static_cast<int>(shapes.size()) - 1;
  const std::vector<double> lengths = ChordLengths(metric, shapes);
  double total = 0;
  for (const double length : lengths) total += length;
  const double share = total > 0 ? 1 - kUniformShare : 0;  // not a number under the rigid metric
  std::vector<double> times(segments + 1, 0.0);
  double way = 0;
  for (int i = 1; i <= segments; ++i) {
    way += lengths[i - 1];
    times[i] = static_cast<double>(i) / segments;
    if (share > 0 && i < segments) times[i] += share * (way / total - times[i]);
  }
  return times;
}

std::vector<double> UniformTimes(int inner) {
  std::vector<double> times(inner + 2);
  for (int i = 0; i < inner + 2; ++i) times[i] = static_cast<double>(i) / (inner + 1);
  return times;
}

}  // namespace shapespace::internal
