#include <shapespace/solvers/correspondence/marker_distances.h>

#include <functional>
#include <limits>
#include <queue>
#include <utility>

#include <shapespace/base/parallel.h>

namespace shapespace::internal {
namespace {

// The marker nearest to each vertex, and how far it is.
void FindNearest(const Eigen::MatrixXf& distances, std::vector<int>* nearest,
                 std::vector<float>* least) {
  nearest->resize(distances.rows());
  least->resize(distances.rows());
  for (int v = 0; v < distances.rows(); ++v) {
    (*least)[v] = distances.row(v).minCoeff(&(*nearest)[v]);
  }
}

}  // namespace

Eigen::MatrixXf DistancesFrom(const Connectivity& connectivity, const Shape& shape,
                              const std::vector<int>& vertices) {
  const int num_vertices = connectivity.NumVertices();
  const Eigen::Matrix2Xi& edges = connectivity.Edges();
  // The neighbours of vertex v are those from begin[v] on.
  std::vector<int> begin(num_vertices + 1, 0);
  for (const int v : edges.reshaped()) ++begin[v + 1];
  for (int v = 0; v < num_vertices; ++v) begin[v + 1] += begin[v];
  std::vector<std::pair<int, float>> neighbours(begin.back());
  std::vector<int> end(begin.begin(), begin.end() - 1);
  for (int e = 0; e < edges.cols(); ++e) {
    const int a = edges(0, e), b = edges(1, e);
    const auto length = static_cast<float>((shape.col(a) - shape.col(b)).norm());
    neighbours[end[a]++] = {b, length};
    neighbours[end[b]++] = {a, length};
  }
  Eigen::MatrixXf distances = Eigen::MatrixXf::Constant(num_vertices, vertices.size(),
                                                        std::numeric_limits<float>::infinity());
  ParallelFor(static_cast<int>(vertices.size()), [&](int k) {
    auto distance = distances.col(k);
    using Entry = std::pair<float, int>;
    std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
    distance(vertices[k]) = 0;
    queue.emplace(0.0F, vertices[k]);
    while (!queue.empty()) {
      const auto [so_far, v] = queue.top();
      queue.pop();
      if (so_far > distance(v)) continue;
      for (int i = begin[v]; i < begin[v + 1]; ++i) {
        const auto& [to, length] = neighbours[i];
        if (so_far + length < distance(to)) {
          distance(to) = so_far + length;
          queue.emplace(distance(to), to);
        }
      }
    }
  });
  return distances;
}

MarkerDistances::MarkerDistances(Eigen::MatrixXf on_template, Eigen::MatrixXf on_target)
    : on_template_(std::move(on_template)), on_target_(std::move(on_target)) {
  FindNearest(on_template_, &nearest_template_, &least_template_);
  FindNearest(on_target_, &nearest_target_, &least_target_);
}

}  // namespace shapespace::internal
