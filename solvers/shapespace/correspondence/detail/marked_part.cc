#include <shapespace/correspondence/detail/marked_part.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include <shapespace/base/parallel.h>
#include <shapespace/correspondence/detail/closest.h>
#include <shapespace/mesh/internal/submesh.h>
#include <shapespace/mesh/surface.h>
#include <shapespace/mesh/topology.h>

namespace shapespace::internal {

MarkedPart::MarkedPart(const std::shared_ptr<const Connectivity>& body,
                       const std::vector<CorrespondenceMarker>& markers)
    : connectivity(body) {
  const Topology topology = ComputeTopology(*body);
  std::vector<bool> marked(topology.components, false);
  for (const CorrespondenceMarker& marker : markers) {
    marked[topology.component[marker.template_vertex]] = true;
  }
  others = static_cast<int>(std::count(marked.begin(), marked.end(), false));
  if (IsAll()) {
    vertices.resize(body->NumVertices());
    std::iota(vertices.begin(), vertices.end(), 0);
    return;
  }
  std::vector<bool> keep;
  for (const int component : topology.component) {
    keep.push_back(component >= 0 && marked[component]);
  }
  Submesh part = MakeSubmesh(*body, keep);
  connectivity = std::move(part.connectivity);
  vertices = std::move(part.vertices);
}

int MarkedPart::IndexOf(int vertex) const {
  return static_cast<int>(std::lower_bound(vertices.begin(), vertices.end(), vertex) -
                          vertices.begin());
}

Shape MarkedPart::Follow(const Shape& rest, const Shape& moved) const {
  if (IsAll()) return moved;
  std::vector<bool> is_part(rest.cols(), false);
  for (const int v : vertices) is_part[v] = true;
  std::vector<int> following;
  for (int v = 0; v < rest.cols(); ++v) {
    if (!is_part[v]) following.push_back(v);
  }
  const Shape part_rest = rest(Eigen::all, vertices), own = rest(Eigen::all, following);
  const MeshSurface surface(connectivity, part_rest);
  std::vector<ClosestPoint> nearest(following.size());
  ParallelFor(static_cast<int>(nearest.size()),
              [&](int i) { nearest[i] = surface.Nearest(own.col(i)); });
  const Shape carried = CarryAlong(PointsOf(nearest), *connectivity, part_rest, moved, own);
  Shape body(3, rest.cols());
  for (size_t i = 0; i < vertices.size(); ++i) body.col(vertices[i]) = moved.col(i);
  for (size_t i = 0; i < following.size(); ++i) body.col(following[i]) = carried.col(i);
  return body;
}

}  // namespace shapespace::internal
