#include <shapespace/correspondence/detail/marker_distances.h>

#include <functional>
#include <limits>
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
      : connectivity_(connectivity), lengths_(connectivity.NumEdges()) {
    const Eigen::Matrix2Xi& edges = connectivity.Edges();
    for (int e = 0; e < edges.cols(); ++e) {
      lengths_[e] = static_cast<float>((shape.col(edges(0, e)) - shape.col(edges(1, e))).norm());
    }
  }

  // The distance of each vertex from the nearest of `sources`; `nearest` becomes that source.
  Eigen::VectorXf Dijkstra(const std::vector<int>& sources, std::vector<int>* nearest) const {
    const auto num_vertices = connectivity_.NumVertices();
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
      for (const int e : connectivity_.EdgesOfVertices()[v]) {
        const int to = connectivity_.OtherEnd(e, v);
        if (so_far + lengths_[e] >= distance(to)) continue;
        distance(to) = so_far + lengths_[e];
        (*nearest)[to] = (*nearest)[v];
        queue.emplace(distance(to), to);
      }
    }
    return distance;
  }

 private:
  const Connectivity& connectivity_;
  std::vector<float> lengths_;
};

}  // namespace

Eigen::MatrixXf DistancesFrom(const Connectivity& connectivity, const Shape& shape,
                              const std::vector<int>& vertices) {
  const Graph graph(connectivity, shape);
  Eigen::MatrixXf distances(connectivity.NumVertices(), vertices.size());
  ParallelFor(static_cast<int>(vertices.size()), [&](int k) {
    std::vector<int> nearest;
    Eigen::VectorXf distance = graph.Dijkstra({vertices[k]}, &nearest);
    connectivity.CopyToTwins(&distance);
    distances.col(k) = distance;
  });
  return distances;
}

std::vector<int> NearestOf(const Connectivity& connectivity, const Shape& shape,
                           const std::vector<int>& vertices) {
  std::vector<int> nearest;
  Graph(connectivity, shape).Dijkstra(vertices, &nearest);
  connectivity.CopyToTwins(&nearest);
  return nearest;
}

MarkerDistances::MarkerDistances(Eigen::MatrixXf on_template, Eigen::MatrixXf on_target)
    : on_template_(std::move(on_template)), on_target_(std::move(on_target)) {
  FindNearest(on_template_, &nearest_template_, &least_template_);
  FindNearest(on_target_, &nearest_target_, &least_target_);
}

}  // namespace shapespace::internal
