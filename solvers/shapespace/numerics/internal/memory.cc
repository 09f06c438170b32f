#include <shapespace/numerics/internal/memory.h>

#include <algorithm>
#include <cmath>

#include <shapespace/base/error.h>
#include <shapespace/numerics/internal/minimise.h>
#include <shapespace/path/energy.h>

namespace shapespace::internal {
namespace {

constexpr double kNumber = sizeof(double), kShape = 3 * kNumber;

// Numbers in the factor of a preconditioner, which has one unknown per vertex: an estimate from
// meshes of 2 K to 40 K vertices (120 to 250 numbers per vertex with bending, a seventh of it
// without).
double PreconditionerNumbers(const Metric& metric) {
  const double per_vertex = metric.options.bending > 0 ? 300 : 45;
  return per_vertex * metric.connectivity->NumVertices();
}

// The metric's matrix, with three unknowns per vertex, and its factor. On the same meshes the
// factor had 30 to 60 log2(vertices) numbers per vertex. The matrix has 60 entries per vertex, and
// the analysis has copies of its pattern.
double MetricFactorBytes(double vertices) {
  constexpr double kFactorNumbers = 65, kMatrix = 5000;
  return vertices * (kNumber * kFactorNumbers * std::log2(std::max(2.0, vertices)) + kMatrix);
}

// The derivative of the features at one shape, and their values.
double DerivativeBytes(const Metric& metric) {
  double numbers = 0;
  for (const auto& feature : metric.features) {
    numbers += feature->NumElements() * feature->ValuesPerElement() *
               (3.0 * feature->VerticesPerElement() + 3.0);
  }
  return kNumber * numbers;
}

double MetricSolverBytes(const Metric& metric) {
  return MetricFactorBytes(metric.connectivity->NumVertices()) + DerivativeBytes(metric);
}

}  // namespace

void CheckMemoryLimit(double memory_limit) {
  if (!(memory_limit > 0)) throw InvalidOptions("memory_limit", "must be positive");
}

void CheckMemory(const std::string& call, double bytes, double memory_limit,
                 const std::string& remedy) {
  if (bytes <= memory_limit) return;
  throw SolverError(call + " needs about " + std::to_string(std::lround(bytes / 1e6)) +
                    " MB, more than the memory limit; " + remedy + " or raise memory_limit");
}

double GeodesicBytes(const Metric& metric, int poses, int shapes) {
  const double vertices = metric.connectivity->NumVertices();
  const double unknowns = 3 * vertices * shapes;
  const double vectors = HistoryRank(unknowns) + 10.0;
  const double all_shapes = 3 * vertices * (poses + (poses - 1.0) * shapes);
  return kNumber * (vectors * unknowns + PreconditionerNumbers(metric) + 2 * all_shapes) +
         PathEnergy::EstimateBytes(metric, shapes);
}

double FurtherGeodesicBytes(const Metric& metric, int shapes) {
  // Under the trapezoid every pair has a factor of its own.
  const bool shares_factor = metric.options.discretization != Discretization::kTrapezoid;
  return GeodesicBytes(metric, 2, shapes) -
         (shares_factor ? kNumber * PreconditionerNumbers(metric) : 0);
}

double SplineBytes(const Connectivity& connectivity, int poses, int shapes) {
  constexpr double kIntegrator = 3000;  // matrix and factor, per vertex, and sides
  const double vertices = connectivity.NumVertices();
  const double quantities = 2.0 * connectivity.NumTriangles() + vertices;
  const double all_shapes = poses + (poses - 1.0) * shapes;
  // Of each quantity its way and velocities in every interval, and the system for its velocities.
  return kShape * (6.0 * poses * quantities + 2 * all_shapes * vertices) + kIntegrator * vertices;
}

double DeformationBytes(const Metric& metric, int shapes) {
  const double unknowns = 3.0 * metric.connectivity->NumVertices() * shapes;
  const double vectors = HistoryRank(unknowns) + 18.0;  // with shapes and data derived from them
  // Two factors in single precision, and one in double precision while they are computed.
  return kNumber * (vectors * unknowns + 2 * PreconditionerNumbers(metric)) +
         PathEnergy::EstimateBytes(metric, shapes);
}

double TransportBytes(const Metric& metric, int tangents) {
  constexpr double kVectors = 20;  // of the linear solver
  return 2 * MetricSolverBytes(metric) +
         (kVectors + 2.0 * tangents) * kShape * metric.connectivity->NumVertices();
}

double AverageBytes(const Metric& metric, int poses) {
  double values = 0;
  for (const auto& feature : metric.features) values += feature->NumValues();
  return MetricSolverBytes(metric) + kNumber * (2.0 * poses + 6) * values +
         2 * kShape * poses * metric.connectivity->NumVertices();
}

double FeatureTransferBytes(const Metric& metric, int shapes) {
  constexpr double kGradients = 3000;  // of Sumner and Popovic's method, per vertex
  return MetricSolverBytes(metric) +
         (kGradients + 4 * kShape * shapes) * metric.connectivity->NumVertices();
}

double LadderBytes(const Metric& metric, int shapes, int rung_shapes) {
  return TransportBytes(metric, 1) + GeodesicBytes(metric, 2, rung_shapes) +
         4 * kShape * shapes * metric.connectivity->NumVertices();
}

double CorrespondenceBytes(const Connectivity& template_connectivity,
                           const Connectivity& target_connectivity, int markers) {
  // Strains and angles; search trees, normals and areas, and the distances from the markers, which
  // are computed a second time if some are dropped.
  constexpr double kDerivative = 1200, kSurface = 1000;
  const double vertices = template_connectivity.NumVertices();
  const double all = vertices + target_connectivity.NumVertices();
  return MetricFactorBytes(vertices) + kDerivative * vertices +
         (kSurface + 2 * sizeof(float) * markers) * all;
}

}  // namespace shapespace::internal
