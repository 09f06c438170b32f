#include <shapespace/matching/detail/surface_graph.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include <Eigen/Geometry>

#include <shapespace/base/parallel.h>

namespace shapespace::internal {
namespace {

// Width of a bucket as a share of the mean line, and the greatest number of buckets that the
// longest line may reach over. Wider ones hold vertices that are processed several times, narrower
// ones are mostly empty.
constexpr float kStep = 0.5F, kMostSteps = 1000;

struct GraphLine {
  int a, b;
  float length;
};

// A point in the plane of the edge from p along the unit vector u: how far along the edge, and how
// far from its line.
struct BesideEdge {
  double along, off;

  BesideEdge(const Eigen::Vector3d& point, const Eigen::Vector3d& p, const Eigen::Vector3d& u)
      : along((point - p).dot(u)), off((point - p).cross(u).norm()) {}
};

// The straight line between the corners opposite to edge e, if both triangles lie in a plane, on
// different sides of e.
void AddUnfolded(const Connectivity& connectivity, const Shape& shape, int e,
                 std::vector<GraphLine>* lines) {
  const IndexLists::Row sides = connectivity.TrianglesOfEdges()[e];
  if (sides.size() != 2) return;
  const int p = connectivity.Edges()(0, e), q = connectivity.Edges()(1, e);
  const Eigen::Vector3d edge = shape.col(q) - shape.col(p);
  const double length = edge.norm();
  if (!(length > 0)) return;
  const auto opposite = [&](int f) { return connectivity.Triangles().col(f).sum() - p - q; };
  const int r = opposite(sides[0]), s = opposite(sides[1]);
  if (r == s) return;
  const BesideEdge first(shape.col(r), shape.col(p), edge / length);
  const BesideEdge second(shape.col(s), shape.col(p), edge / length);
  const double apart = first.off + second.off;
  if (!(apart > 0)) return;
  const double crossing = first.along + (second.along - first.along) * first.off / apart;
  if (crossing <= 0 || crossing >= length) return;
  lines->push_back({r, s, static_cast<float>(std::hypot(first.along - second.along, apart))});
}

}  // namespace

SurfaceGraph::SurfaceGraph(const Connectivity& connectivity, const Shape& shape)
    : begin_(connectivity.NumVertices() + 1, 0) {
  std::vector<GraphLine> lines;
  lines.reserve(2 * static_cast<size_t>(connectivity.NumTriangleEdges()));
  for (int e = 0; e < connectivity.NumTriangleEdges(); ++e) {
    const int a = connectivity.Edges()(0, e), b = connectivity.Edges()(1, e);
    lines.push_back({a, b, static_cast<float>((shape.col(a) - shape.col(b)).norm())});
    AddUnfolded(connectivity, shape, e, &lines);
  }
  for (const GraphLine& line : lines) {
    ++begin_[line.a + 1];
    ++begin_[line.b + 1];
  }
  std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
  lines_.resize(begin_.back());
  std::vector<int> fill(begin_.begin(), begin_.end() - 1);
  float sum = 0, longest = 0;
  for (const GraphLine& line : lines) {
    lines_[fill[line.a]++] = {line.b, line.length};
    lines_[fill[line.b]++] = {line.a, line.length};
    sum += line.length;
    longest = std::max(longest, line.length);
  }
  if (!(longest > 0)) return;
  step_ = std::max(kStep * sum / static_cast<float>(lines.size()), longest / kMostSteps);
  steps_ = static_cast<int>(longest / step_) + 1;
}

// Shortest paths by buckets of distances (U. Meyer and P. Sanders, "Delta-stepping", 2003): what is
// nearer comes first, but within a bucket in any order, and again if it proves to be nearer still.
// The result is that of Dijkstra's algorithm to the bit, for the sums of lengths along paths do not
// depend on the order.
Eigen::VectorXf SurfaceGraph::Search(const std::vector<int>& sources,
                                     std::vector<int>* nearest) const {
  constexpr float kInfinity = std::numeric_limits<float>::infinity();
  Eigen::VectorXf distance = Eigen::VectorXf::Constant(NumVertices(), kInfinity);
  Eigen::VectorXf settled = distance;  // with which distance a vertex has been processed
  const int num_buckets = steps_ + 2;
  std::vector<std::vector<int>> buckets(num_buckets);
  for (size_t k = 0; k < sources.size(); ++k) {
    distance(sources[k]) = 0;
    if (nearest != nullptr) (*nearest)[sources[k]] = static_cast<int>(k);
    buckets[0].push_back(sources[k]);
  }
  size_t waiting = buckets[0].size();
  for (int current = 0; waiting > 0; current = (current + 1) % num_buckets) {
    std::vector<int>& bucket = buckets[current];
    for (size_t i = 0; i < bucket.size(); ++i) {
      const int v = bucket[i];
      const float so_far = distance(v);
      if (so_far == settled(v)) continue;
      settled(v) = so_far;
      for (int k = begin_[v]; k < begin_[v + 1]; ++k) {
        const Line& line = lines_[k];
        const float next = so_far + line.length;
        if (next >= distance(line.to)) continue;
        distance(line.to) = next;
        if (nearest != nullptr) (*nearest)[line.to] = (*nearest)[v];
        buckets[static_cast<int>(next / step_) % num_buckets].push_back(line.to);
        ++waiting;
      }
    }
    waiting -= bucket.size();
    bucket.clear();
  }
  return distance;
}

Eigen::VectorXf SurfaceGraph::From(int source) const { return Search({source}, nullptr); }

Eigen::VectorXf SurfaceGraph::FromAny(const std::vector<int>& sources) const {
  return Search(sources, nullptr);
}

Eigen::MatrixXf SurfaceGraph::FromEach(const std::vector<int>& sources) const {
  Eigen::MatrixXf distances(NumVertices(), sources.size());
  ParallelFor(static_cast<int>(sources.size()),
              [&](int k) { distances.col(k) = From(sources[k]); });
  return distances;
}

std::vector<int> SurfaceGraph::NearestOf(const std::vector<int>& sources) const {
  std::vector<int> nearest(NumVertices(), -1);
  Search(sources, &nearest);
  return nearest;
}

}  // namespace shapespace::internal
