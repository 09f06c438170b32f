#include <shapespace/mesh/topology.h>

#include <algorithm>
#include <numeric>

#include <OpenMesh/Core/Mesh/TriConnectivity.hh>

#include <shapespace/mesh/internal/sides.h>

namespace shapespace {
namespace {

using internal::Sides;
using internal::UnionFind;

bool IsManifold(const Connectivity& connectivity, const std::vector<int>& begin,
                const std::vector<int>& corners) {
  const Eigen::Matrix3Xi& triangles = connectivity.Triangles();
  if (triangles.cols() == 0) return false;
  for (int f = 0; f < triangles.cols(); ++f) {
    const auto t = triangles.col(f);
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) return false;
  }
  const int n = connectivity.NumVertices();
  const Sides sides = internal::MakeSides(n, begin, corners);
  for (int e = 0; e < sides.NumEdges(); ++e) {
    if (sides.Count(e) > 2 || sides.WoundAlike(e)) return false;
  }
  const std::vector<int> fans = internal::CountFans(n, begin, corners, sides);
  return std::all_of(fans.begin(), fans.end(), [](int count) { return count <= 1; });
}

/// Returns false if OpenMesh rejects a face.
bool Build(const Connectivity& connectivity, OpenMesh::TriConnectivity* mesh) {
  const Eigen::Matrix3Xi& triangles = connectivity.Triangles();
  mesh->reserve(connectivity.NumVertices(), connectivity.NumTriangleEdges(), triangles.cols());
  for (int v = 0; v < connectivity.NumVertices(); ++v) mesh->add_vertex();
  using Vertex = OpenMesh::VertexHandle;
  for (int f = 0; f < triangles.cols(); ++f) {
    const auto t = triangles.col(f);
    if (!mesh->add_face(Vertex(t[0]), Vertex(t[1]), Vertex(t[2])).is_valid()) return false;
  }
  return true;
}

std::vector<std::vector<int>> BoundaryLoops(const OpenMesh::TriConnectivity& mesh) {
  std::vector<std::vector<int>> loops;
  std::vector<bool> seen(mesh.n_halfedges(), false);
  for (int h = 0; h < static_cast<int>(mesh.n_halfedges()); ++h) {
    const OpenMesh::HalfedgeHandle start(h);
    if (seen[h] || !mesh.is_boundary(start)) continue;
    loops.emplace_back();
    OpenMesh::HalfedgeHandle at = start;
    do {
      seen[at.idx()] = true;
      loops.back().push_back(mesh.from_vertex_handle(at).idx());
      at = mesh.next_halfedge_handle(at);
    } while (at != start);
  }
  return loops;
}

/// Numbers the components in the order of their first vertices.
void FindComponents(const Connectivity& connectivity, Topology* topology) {
  const int n = connectivity.NumVertices();
  UnionFind pieces(n);
  std::vector<bool> used(n, false);
  auto join = [&](int a, int b) {
    pieces.Join(a, b);
    used[a] = used[b] = true;
  };
  for (int e = 0; e < connectivity.NumEdges(); ++e) {
    join(connectivity.Edges()(0, e), connectivity.Edges()(1, e));
  }
  for (int v : connectivity.Corners()) used[connectivity.Representative(v)] = true;
  topology->component.assign(n, -1);
  for (int v = 0; v < n; ++v) {
    if (!used[v]) continue;
    const int root = pieces.Find(v);  // the component's smallest vertex, so it has a number already
    topology->component[v] = root == v ? topology->components++ : topology->component[root];
  }
  connectivity.CopyToTwins(&topology->component);
}

/// From the Euler characteristics of the components: the sum of 2 - 2 genus - loops.
int Genus(const Connectivity& connectivity, int num_loops) {
  const int n = connectivity.NumVertices();
  UnionFind pieces(n);
  std::vector<bool> used(n, false);
  for (int e = 0; e < connectivity.NumTriangleEdges(); ++e) {
    const int a = connectivity.Edges()(0, e), b = connectivity.Edges()(1, e);
    pieces.Join(a, b);
    used[a] = used[b] = true;
  }
  int vertices = 0, surfaces = 0;
  for (int v = 0; v < n; ++v) {
    vertices += used[v];
    surfaces += used[v] && pieces.Find(v) == v;
  }
  const int euler = vertices - connectivity.NumTriangleEdges() + connectivity.NumTriangles();
  return (2 * surfaces - num_loops - euler) / 2;
}

}  // namespace

Topology ComputeTopology(const Connectivity& connectivity) {
  Topology topology;
  FindComponents(connectivity, &topology);
  const Eigen::Matrix3Xi& triangles = connectivity.Triangles();
  std::vector<int> begin(triangles.cols() + 1);
  for (size_t f = 0; f < begin.size(); ++f) begin[f] = static_cast<int>(3 * f);
  const std::vector<int> corners(triangles.data(), triangles.data() + triangles.size());
  // OpenMesh writes to the error stream if it encounters a non-manifold face.
  if (!IsManifold(connectivity, begin, corners)) return topology;
  OpenMesh::TriConnectivity mesh;
  if (!Build(connectivity, &mesh)) return topology;
  topology.manifold = true;
  topology.boundary_loops = BoundaryLoops(mesh);
  topology.genus = Genus(connectivity, static_cast<int>(topology.boundary_loops.size()));
  return topology;
}

}  // namespace shapespace
