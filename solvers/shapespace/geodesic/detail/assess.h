#ifndef SHAPESPACE_GEODESIC_DETAIL_ASSESS_H_
#define SHAPESPACE_GEODESIC_DETAIL_ASSESS_H_

#include <shapespace/geodesic/geodesic.h>
#include <shapespace/geodesic/internal/resolution.h>

namespace shapespace::internal {

/// How the levels of a solve ended together. One that has stalled is a start for the next one, and
/// as good as any other start, unless it is the last of its piece.
Termination EndOf(const GeodesicSummary& summary);

/// Measures the energy of the finished path by feature, and the lower bound, over all pieces.
void MeasureEnergy(const Path& path, const GeodesicOptions& options, Resolution* finest,
                   GeodesicSummary* summary);

/// Measures what is visible in the finished path.
void Assess(const Path& path, const GeodesicOptions& options, GeodesicSummary* summary);

/// Appends warnings about results that are valid but probably not wanted.
void Warn(const GeodesicOptions& options, GeodesicSummary* summary);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_GEODESIC_DETAIL_ASSESS_H_
