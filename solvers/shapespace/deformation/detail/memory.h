#ifndef SHAPESPACE_DEFORMATION_DETAIL_MEMORY_H_
#define SHAPESPACE_DEFORMATION_DETAIL_MEMORY_H_

#include <shapespace/metric/metric.h>
#include <shapespace/minimise/internal/memory.h>
#include <shapespace/minimise/internal/minimise.h>
#include <shapespace/path/energy.h>

namespace shapespace::internal {

/// Bytes of a deformation with `shapes` shapes after the first.
inline double DeformationBytes(const Metric& metric, int shapes) {
  const double unknowns = 3.0 * metric.connectivity->NumVertices() * shapes;
  const double vectors = HistoryRank(unknowns) + 18.0;  // with shapes and data derived from them
  // Two factors in single precision, and one in double precision while they are computed.
  return sizeof(double) * vectors * unknowns + 2 * PreconditionerBytes(metric) +
         PathEnergy::EstimateBytes(metric, shapes);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_DEFORMATION_DETAIL_MEMORY_H_
