#ifndef SHAPESPACE_MINIMISE_INTERNAL_MEMORY_H_
#define SHAPESPACE_MINIMISE_INTERNAL_MEMORY_H_

#include <shapespace/metric/metric.h>

namespace shapespace::internal {

/// Bytes of a preconditioner's factor, which has one unknown per vertex: an estimate from meshes of
/// 2 K to 40 K vertices (120 to 250 numbers per vertex with bending, a seventh of it without).
inline double PreconditionerBytes(const Metric& metric) {
  const double per_vertex = metric.options.bending > 0 ? 300 : 45;
  return sizeof(double) * per_vertex * metric.connectivity->NumVertices();
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MINIMISE_INTERNAL_MEMORY_H_
