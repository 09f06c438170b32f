#include <shapespace/geodesic/internal/memory.h>

#include <shapespace/minimise/internal/memory.h>
#include <shapespace/minimise/internal/minimise.h>
#include <shapespace/path/energy.h>

namespace shapespace::internal {

double GeodesicBytes(const Metric& metric, int poses, int shapes) {
  const double vertices = metric.connectivity->NumVertices();
  const double unknowns = 3 * vertices * shapes;
  const double vectors = HistoryRank(unknowns) + 10.0;
  const double all_shapes = 3 * vertices * (poses + (poses - 1.0) * shapes);
  return sizeof(double) * (vectors * unknowns + 2 * all_shapes) + PreconditionerBytes(metric) +
         PathEnergy::EstimateBytes(metric, shapes);
}

double FurtherGeodesicBytes(const Metric& metric, int shapes) {
  // Under the trapezoid every pair has a factor of its own.
  const bool shares_factor = metric.options.discretization != Discretization::kTrapezoid;
  return GeodesicBytes(metric, 2, shapes) - (shares_factor ? PreconditionerBytes(metric) : 0);
}

}  // namespace shapespace::internal
