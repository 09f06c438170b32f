#ifndef SHAPESPACE_METRIC_EDGE_LENGTH_H_
#define SHAPESPACE_METRIC_EDGE_LENGTH_H_

#include <cmath>

#include <Eigen/Core>

#include <shapespace/metric/feature.h>

namespace shapespace {

struct MetricBasis;

/// |e|^2 / 2 of an edge: the paper's metric (4), since its derivative along X is <X_p - X_q, p -
/// q>.
struct EdgeLength : ElementFeature<2, 1> {
  static constexpr const char* kName = "edge length";

  static EdgeLength Freeze(const MetricBasis& basis);

  template <typename T>
  void operator()(const T* x, T* value) const {
    const T ex = x[3] - x[0], ey = x[4] - x[1], ez = x[5] - x[2];
    value[0] = 0.5 * (ex * ex + ey * ey + ez * ez);
  }
};

/// log |e| of an edge that is not a side of a triangle: its strain, which does not depend on its
/// length.
struct LogLength : ElementFeature<2, 1> {
  static constexpr const char* kName = "log length";

  double epsilon_squared = 0;  ///< keeps the logarithm of a collapsed edge finite

  static LogLength Freeze(const MetricBasis& basis);

  template <typename Self, typename Visit>
  static void ForConstants(Self* self, const Visit& visit) {
    visit("epsilon_squared", self->epsilon_squared);
  }

  template <typename T>
  void operator()(const T* x, T* value) const {
    using std::log;
    const T ex = x[3] - x[0], ey = x[4] - x[1], ez = x[5] - x[2];
    value[0] = 0.5 * log(ex * ex + ey * ey + ez * ez + epsilon_squared);
  }
};

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_EDGE_LENGTH_H_
