#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_COARSE_BODY_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_COARSE_BODY_H_

#include <vector>

#include <shapespace/correspondence/correspondence.h>
#include <shapespace/correspondence/detail/marker_fit.h>

namespace shapespace::internal {

/// A body with fewer triangles. Its vertices are some of the whole one's.
struct CoarseBody {
  FitBody body;
  std::vector<int> vertices;  ///< per vertex, its number in the whole body; ascending

  /// The number here of a vertex of the whole body, which must be one of `vertices`.
  int IndexOf(int whole) const;
};

/// A body with about so many triangles that keeps the `pinned` vertices. One with less than twice
/// as many keeps all.
CoarseBody Coarsen(const FitBody& whole, int triangles, std::vector<int> pinned);

/// The vertices of the template, or of the target, that have markers.
std::vector<int> MarkerVertices(const std::vector<CorrespondenceMarker>& markers,
                                int CorrespondenceMarker::*side);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_COARSE_BODY_H_
