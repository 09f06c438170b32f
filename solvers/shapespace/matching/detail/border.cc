#include <shapespace/matching/detail/border.h>

#include <algorithm>

#include <Eigen/Core>

#include <shapespace/mesh/internal/sides.h>

namespace shapespace::internal {

SurfaceBorder::SurfaceBorder(const Connectivity& connectivity, const Shape& shape) {
  std::vector<bool> ends(connectivity.NumVertices(), false);
  std::vector<int> edges;
  UnionFind loops(connectivity.NumVertices());
  for (int e = 0; e < connectivity.NumTriangleEdges(); ++e) {
    if (connectivity.TrianglesOfEdges()[e].size() != 1) continue;
    const auto edge = connectivity.Edges().col(e);
    ends[edge(0)] = ends[edge(1)] = true;
    loops.Join(edge(0), edge(1));
    edges.push_back(e);
  }
  Eigen::VectorXd lengths = Eigen::VectorXd::Zero(connectivity.NumVertices());
  for (const int e : edges) {
    const auto edge = connectivity.Edges().col(e);
    lengths(loops.Find(edge(0))) += (shape.col(edge(1)) - shape.col(edge(0))).norm();
  }
  longest = lengths.maxCoeff();
  for (int v = 0; v < connectivity.NumVertices(); ++v) {
    if (ends[v]) vertices.push_back(v);
  }
}

}  // namespace shapespace::internal
