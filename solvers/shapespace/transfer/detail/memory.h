#ifndef SHAPESPACE_TRANSFER_DETAIL_MEMORY_H_
#define SHAPESPACE_TRANSFER_DETAIL_MEMORY_H_

#include <shapespace/exponential/internal/memory.h>
#include <shapespace/geodesic/internal/memory.h>

namespace shapespace::internal {

constexpr double kShapeBytesPerVertex = 3 * sizeof(double);

/// Bytes of a transfer in feature space of a path of this number of shapes; `metric` is that of the
/// features.
inline double FeatureTransferBytes(const Metric& metric, int shapes) {
  constexpr double kGradients = 3000;  // of Sumner and Popovic's method, per vertex
  return MetricSolverBytes(metric) +
         (kGradients + 4 * kShapeBytesPerVertex * shapes) * metric.connectivity->NumVertices();
}

/// Bytes of a transfer by the ladder; `rung_shapes` are LadderOptions::rung_shapes.
inline double LadderBytes(const Metric& metric, int shapes, int rung_shapes) {
  return TransportBytes(metric, 1) + GeodesicBytes(metric, 2, rung_shapes) +
         4 * kShapeBytesPerVertex * shapes * metric.connectivity->NumVertices();
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_TRANSFER_DETAIL_MEMORY_H_
