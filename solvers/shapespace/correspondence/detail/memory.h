#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_MEMORY_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_MEMORY_H_

#include <shapespace/exponential/internal/memory.h>
#include <shapespace/mesh/connectivity.h>

namespace shapespace::internal {

/// Bytes of a fit of a template onto a target.
inline double CorrespondenceBytes(const Connectivity& template_connectivity,
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

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_MEMORY_H_
