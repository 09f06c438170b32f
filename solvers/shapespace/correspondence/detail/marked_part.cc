#include <shapespace/correspondence/detail/marked_part.h>

#include <algorithm>

#include <shapespace/base/parallel.h>
#include <shapespace/correspondence/surface_map.h>
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
  std::vector<int> index(body->NumVertices(), -1);
  for (int v = 0; v < body->NumVertices(); ++v) {
    const int component = topology.component[v];
    if (!IsAll() && (component < 0 || !marked[component])) continue;
    index[v] = static_cast<int>(vertices.size());
    vertices.push_back(v);
  }
  if (IsAll()) return;
  Eigen::Matrix3Xi triangles(3, body->NumTriangles());
  int count = 0;
  for (const auto& triangle : body->Triangles().colwise()) {
    if (index[triangle(0)] < 0) continue;
    for (int k = 0; k < 3; ++k) triangles(k, count) = index[triangle(k)];
    ++count;
  }
  connectivity =
      Connectivity::FromTriangles(static_cast<int>(vertices.size()), triangles.leftCols(count));
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
  SurfacePoints points;
  points.triangle.resize(own.cols());
  points.barycentric.resize(3, own.cols());
  ParallelFor(static_cast<int>(own.cols()), [&](int i) {
    const ClosestPoint nearest = surface.Nearest(own.col(i));
    points.triangle(i) = nearest.triangle;
    points.barycentric.col(i) = nearest.barycentric;
  });
  const Shape carried = CarryAlong(points, *connectivity, part_rest, moved, own);
  Shape body(3, rest.cols());
  for (size_t i = 0; i < vertices.size(); ++i) body.col(vertices[i]) = moved.col(i);
  for (size_t i = 0; i < following.size(); ++i) body.col(following[i]) = carried.col(i);
  return body;
}

}  // namespace shapespace::internal
