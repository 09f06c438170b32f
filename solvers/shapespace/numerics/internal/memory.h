#ifndef SHAPESPACE_NUMERICS_INTERNAL_MEMORY_H_
#define SHAPESPACE_NUMERICS_INTERNAL_MEMORY_H_

#include <string>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/metric/metric.h>

// How much memory the solvers need, and their refusal of what is more than permitted.

namespace shapespace::internal {

/// \throw InvalidOptions if the limit is not positive.
void CheckMemoryLimit(double memory_limit);

/// \throw SolverError if `bytes`, the estimate for `call` ("this solve"), exceed the limit;
///        `remedy` ("insert fewer shapes") says what needs less.
void CheckMemory(const std::string& call, double bytes, double memory_limit,
                 const std::string& remedy);

// Estimates in bytes of what a call needs at its peak, in addition to its input. The size of
// factors depends on the mesh and is estimated for unfavourable ones: on bodies of 2 K to 43 K
// vertices the peaks were 60 to 90 % of the estimates, for geodesics with few shapes nearly 100 %.

/// A geodesic through `poses` poses, with `shapes` between two of them.
double GeodesicBytes(const Metric& metric, int poses, int shapes);

/// What each further geodesic between two of the poses needs that is solved at the same time.
double FurtherGeodesicBytes(const Metric& metric, int shapes);

/// The correction of a chain of geodesics to a spline; the chain itself is `GeodesicBytes`.
double SplineBytes(const Connectivity& connectivity, int poses, int shapes);

/// The average of so many poses; its certificate is `GeodesicBytes`.
double AverageBytes(const Metric& metric, int poses);

/// A deformation with `shapes` shapes after the first.
double DeformationBytes(const Metric& metric, int shapes);

/// Parallel transport of this number of tangents.
double TransportBytes(const Metric& metric, int tangents);

/// A transfer in feature space of a path of this number of shapes; `metric` is that of the
/// features.
double FeatureTransferBytes(const Metric& metric, int shapes);

/// A transfer by the ladder; `rung_shapes` are LadderOptions::rung_shapes.
double LadderBytes(const Metric& metric, int shapes, int rung_shapes);

/// A fit of a template onto a target.
double CorrespondenceBytes(const Connectivity& template_connectivity,
                           const Connectivity& target_connectivity, int markers);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_NUMERICS_INTERNAL_MEMORY_H_
