#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_FIT_MAP_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_FIT_MAP_H_

#include <vector>

#include <shapespace/correspondence/correspondence.h>
#include <shapespace/correspondence/detail/closest.h>
#include <shapespace/correspondence/surface_map.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// Vertices of the target nearer than this to the fitted template are covered; share of the square
/// root of its area.
inline constexpr double kCovered = 0.03;

/// Both directions of the map that a fitted template makes, and their figures of quality in the
/// summary. `level` is the template itself, `rest` its shape, of area 1. `held` are met exactly.
SurfaceMap MakeMap(const Level& level, const Shape& fitted, const Shape& rest, const Target& target,
                   const std::vector<CorrespondenceMarker>& held, CorrespondenceSummary* summary);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_FIT_MAP_H_
