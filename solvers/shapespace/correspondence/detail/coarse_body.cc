#include <shapespace/correspondence/detail/coarse_body.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include <shapespace/base/internal/sort_unique.h>
#include <shapespace/hierarchy/hierarchy.h>

namespace shapespace::internal {

int CoarseBody::IndexOf(int whole) const {
  return static_cast<int>(std::lower_bound(vertices.begin(), vertices.end(), whole) -
                          vertices.begin());
}

CoarseBody Coarsen(const FitBody& whole, int triangles, std::vector<int> pinned) {
  if (whole.connectivity->NumTriangles() < 2 * triangles) {
    std::vector<int> all(whole.connectivity->NumVertices());
    std::iota(all.begin(), all.end(), 0);
    return {whole, std::move(all)};
  }
  HierarchyOptions options;
  options.coarsest = triangles;
  options.pinned = std::move(pinned);
  SortUnique(&options.pinned);
  const Hierarchy hierarchy(whole.connectivity, {whole.own}, options);
  return {{hierarchy.LevelConnectivity(0), hierarchy.Restrict(whole.own, 0)},
          hierarchy.Vertices(0)};
}

std::vector<int> MarkerVertices(const std::vector<CorrespondenceMarker>& markers,
                                int CorrespondenceMarker::*side) {
  std::vector<int> vertices;
  for (const CorrespondenceMarker& marker : markers) vertices.push_back(marker.*side);
  return vertices;
}

}  // namespace shapespace::internal
