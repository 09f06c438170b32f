#ifndef SHAPESPACE_GEODESIC_INTERNAL_MEMORY_H_
#define SHAPESPACE_GEODESIC_INTERNAL_MEMORY_H_

#include <shapespace/metric/metric.h>

namespace shapespace::internal {

/// Bytes of a geodesic through `poses` poses, with `shapes` between two of them.
double GeodesicBytes(const Metric& metric, int poses, int shapes);

/// What each further geodesic between two of the poses needs that is solved at the same time.
double FurtherGeodesicBytes(const Metric& metric, int shapes);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_GEODESIC_INTERNAL_MEMORY_H_
