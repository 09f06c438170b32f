#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_FOUND_MARKERS_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_FOUND_MARKERS_H_

#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/correspondence/correspondence.h>
#include <shapespace/correspondence/detail/marker_fit.h>

namespace shapespace::internal {

/// Fits the template with the markers of each map that `SurfaceMatcher` finds and `given` markers
/// allow, and returns the fit that deforms it least: "the shortest geodesic solves the
/// correspondence problem" (Kilian, Mitra and Pottmann 2007, section 6). It is fitted once more
/// with better markers, which its own map makes. Found markers are soft.
/// \throw as `Correspond`.
CorrespondenceResult FitWithFoundMarkers(const FitBody& from, const FitBody& target,
                                         const std::vector<CorrespondenceMarker>& given,
                                         const CorrespondenceOptions& options,
                                         const CorrespondenceSummary& summary, Progress* progress);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_FOUND_MARKERS_H_
