#include <shapespace/solvers/correspondence/marker_distances.h>

#include <functional>
#include <limits>
#include <numeric>
#include <queue>
#include <utility>

#include <shapespace/base/parallel.h>

namespace shapespace::internal {
namespace {

// Finds the marker nearest to each vertex, and its distance.
void FindNearest(const Eigen::MatrixXf& distances, std::vector<int>* nearest,
                 std::vector<float>* least) {
  nearest->resize(distances.rows());
  least->resize(distances.rows());
  for (int v = 0; v < distances.rows(); ++v) {
    (*least)[v] = distances.row(v).minCoeff(&(*nearest)[v]);
  }
}

// Adjacency lists of a mesh's edges.
class Graph {
 public:
  Graph(const Connectivity& connectivity, const Shape& shape)
      : begin_(connectivity.NumVertices() + 1, 0) {
    const Eigen::Matrix2Xi& edges = connectivity.Edges();
    for (const int v : edges.reshaped()) ++begin_[v + 1];
    std::partial_sum(begin_.begin(), begin_.end(), begin_.begin());
    neighbours_.resize(begin_.back());
    std::vector<int> end(begin_.begin(), begin_.end() - 1);
    for (int e = 0; e < edges.cols(); ++e) {
      const int a = edges(0, e), b = edges(1, e);
      const auto length = static_cast<float>((shape.col(a) - shape.col(b)).norm());
      neighbours_[end[a]++] = {b, length};
      neighbours_[end[b]++] = {a, length};
    }
  }

  // The distance of each vertex from the nearest of `sources`; `nearest` becomes that source.
  Eigen::VectorXf Dijkstra(const std::vector<int>& sources, std::vector<int>* nearest) const {
    const auto num_vertices = static_cast<Eigen::Index>(begin_.size()) - 1;
    Eigen::VectorXf distance =
        Eigen::VectorXf::Constant(num_vertices, std::numeric_limits<float>::infinity());
    nearest->assign(num_vertices, -1);
    using Entry = std::pair<float, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    for (const int v : sources) {
      distance(v) = 0;
      (*nearest)[v] = v;
      queue.emplace(0.0F, v);
    }
    while (!queue.empty()) {
      const auto [so_far, v] = queue.top();
      queue.pop();
      if (so_far > distance(v)) continue;
      for (int i = begin_[v]; i < begin_[v + 1]; ++i) {
        const auto& [to, length] = neighbours_[i];
        if (so_far + length >= distance(to)) continue;
        distance(to) = so_far + length;
        (*nearest)[to] = (*nearest)[v];
        queue.emplace(distance(to), to);
      }
    }
    return distance;
  }

 private:
  std::vector<int> begin_;  // the neighbours of vertex v begin at begin_[v]
  std::vector<std::pair<int, float>> neighbours_;
};

}  // namespace

Eigen::MatrixXf DistancesFrom(const Connectivity& connectivity, const Shape& shape,
                              const std::vector<int>& vertices) {
  const Graph graph(connectivity, shape);
  Eigen::MatrixXf distances(connectivity.NumVertices(), vertices.size());
  ParallelFor(static_cast<int>(vertices.size()), [&](int k) {
    std::vector<int> nearest;
    distances.col(k) = graph.Dijkstra({vertices[k]}, &nearest);
  });
  return distances;
}

std::vector<int> NearestOf(const Connectivity& connectivity, const Shape& shape,
                           const std::vector<int>& vertices) {
  std::vector<int> nearest;
  Graph(connectivity, shape).Dijkstra(vertices, &nearest);
  return nearest;
}

MarkerDistances::MarkerDistances(Eigen::MatrixXf on_template, Eigen::MatrixXf on_target)
    : on_template_(std::move(on_template)), on_target_(std::move(on_target)) {
  FindNearest(on_template_, &nearest_template_, &least_template_);
  FindNearest(on_target_, &nearest_target_, &least_target_);
}

}  // namespace shapespace::internal
