#include <shapespace/exponential/internal/memory.h>

#include <algorithm>
#include <cmath>

namespace shapespace::internal {

// On meshes of 2 K to 40 K vertices the factor had 30 to 60 log2(vertices) numbers per vertex. The
// matrix has 60 entries per vertex, and the analysis has copies of its pattern.
double MetricFactorBytes(double vertices) {
  constexpr double kFactorNumbers = 65, kMatrix = 5000;
  return vertices *
         (sizeof(double) * kFactorNumbers * std::log2(std::max(2.0, vertices)) + kMatrix);
}

double MetricSolverBytes(const Metric& metric) {
  double derivative = 0;  // numbers, with the features' values
  for (const auto& feature : metric.features) {
    derivative += feature->NumElements() * feature->ValuesPerElement() *
                  (3.0 * feature->VerticesPerElement() + 3.0);
  }
  return MetricFactorBytes(metric.connectivity->NumVertices()) + sizeof(double) * derivative;
}

double TransportBytes(const Metric& metric, int tangents) {
  constexpr double kVectors = 20;  // of the linear solver
  return 2 * MetricSolverBytes(metric) +
         (kVectors + 2.0 * tangents) * 3 * sizeof(double) * metric.connectivity->NumVertices();
}

}  // namespace shapespace::internal
