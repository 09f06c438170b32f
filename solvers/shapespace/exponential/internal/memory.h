#ifndef SHAPESPACE_EXPONENTIAL_INTERNAL_MEMORY_H_
#define SHAPESPACE_EXPONENTIAL_INTERNAL_MEMORY_H_

#include <shapespace/metric/metric.h>

namespace shapespace::internal {

/// Bytes of the metric's matrix, with three unknowns per vertex, and of its factor.
double MetricFactorBytes(double vertices);

/// Of a MetricSolver with the features' derivative at one shape.
double MetricSolverBytes(const Metric& metric);

/// Of parallel transport of this number of tangents.
double TransportBytes(const Metric& metric, int tangents);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_EXPONENTIAL_INTERNAL_MEMORY_H_
