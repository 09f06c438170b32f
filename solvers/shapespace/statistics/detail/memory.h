#ifndef SHAPESPACE_STATISTICS_DETAIL_MEMORY_H_
#define SHAPESPACE_STATISTICS_DETAIL_MEMORY_H_

#include <shapespace/exponential/internal/memory.h>

namespace shapespace::internal {

/// Bytes of the average of so many poses; its certificate is `GeodesicBytes`.
inline double AverageBytes(const Metric& metric, int poses) {
  double values = 0;
  for (const auto& feature : metric.features) values += feature->NumValues();
  return MetricSolverBytes(metric) +
         sizeof(double) *
             ((2.0 * poses + 6) * values + 2.0 * 3 * poses * metric.connectivity->NumVertices());
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_STATISTICS_DETAIL_MEMORY_H_
