#ifndef SHAPESPACE_COST_INTERNAL_REFUSE_SUMS_H_
#define SHAPESPACE_COST_INTERNAL_REFUSE_SUMS_H_

#include <string>

#include <shapespace/base/error.h>
#include <shapespace/cost/path_energy.h>
#include <shapespace/metric/metric.h>

// Checks for sum features, which couple all vertices, so that their rows are dense.

namespace shapespace::cost {

/// \throw InvalidOptions, ending in `remedy`, if the metric has a sum feature and more than
///        `max_vertices` vertices.
inline void RefuseSums(const Metric& metric, int max_vertices, const std::string& remedy) {
  if (metric.connectivity->NumVertices() <= max_vertices) return;
  for (const auto& feature : metric.features) {
    if (feature->IsSum()) {
      throw InvalidOptions(feature->Name(), "couples all vertices; " + remedy);
    }
  }
}

/// The same for solvers on residual blocks, with their limit.
/// \throw InvalidOptions.
inline void RefuseDenseRows(const Metric& metric) {
  RefuseSums(metric, kMaxDenseVertices,
             "above " + std::to_string(kMaxDenseVertices) + " vertices use another solver");
}

}  // namespace shapespace::cost

#endif  // SHAPESPACE_COST_INTERNAL_REFUSE_SUMS_H_
