#include <shapespace/skinning/detail/moving_points.h>

#include <algorithm>
#include <cmath>

#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>
#include <shapespace/mesh/internal/sides.h>

namespace shapespace::internal {
namespace {

IndexLists NeighboursOfPoints(const Connectivity& connectivity, const std::vector<int>& vertices) {
  std::vector<int> point_of(connectivity.NumVertices(), -1);
  for (size_t i = 0; i < vertices.size(); ++i) point_of[vertices[i]] = static_cast<int>(i);
  std::vector<int> begin = {0}, items;
  for (const int vertex : vertices) {
    for (const int edge : connectivity.EdgesOfVertices()[vertex]) {
      items.push_back(point_of[connectivity.OtherEnd(edge, vertex)]);
    }
    begin.push_back(static_cast<int>(items.size()));
  }
  return {std::move(begin), std::move(items)};
}

// Numbers the components of points that edges connect.
void FindComponents(MovingPoints* points) {
  const auto count = static_cast<int>(points->vertices.size());
  UnionFind joined(count);
  for (int p = 0; p < count; ++p) {
    for (const int q : points->neighbours[p]) joined.Join(p, q);
  }
  for (int p = 0; p < count; ++p) {
    const int first = joined.Find(p);  // the smallest of the component
    points->component_of.push_back(first == p ? points->num_components++
                                              : points->component_of[first]);
  }
}

}  // namespace

MovingPoints MakeMovingPoints(const Path& path, int rest) {
  const Connectivity& connectivity = *path.metric->connectivity;
  MovingPoints points;
  points.rest = rest;
  for (int v = 0; v < connectivity.NumVertices(); ++v) {
    if (connectivity.Representative(v) == v) points.vertices.push_back(v);
  }
  points.neighbours = NeighboursOfPoints(connectivity, points.vertices);
  FindComponents(&points);
  const int shapes = path.NumShapes();
  points.moved.resize(3 * shapes, points.vertices.size());
  points.centroids.resize(3, shapes);
  for (int i = 0; i < shapes; ++i) {
    auto rows = points.moved.middleRows<3>(3 * i);
    rows = path.shapes[i](Eigen::all, points.vertices);
    points.centroids.col(i) = rows.rowwise().mean();
    rows.colwise() -= points.centroids.col(i);
  }
  const auto at_rest = points.moved.middleRows<3>(3 * rest);
  points.size = std::sqrt(at_rest.squaredNorm() / points.NumPoints());
  if (!(points.size > 0)) {
    throw MeshError("all vertices of the rest pose are at one point: it has no bones");
  }
  points.moved /= points.size;
  return points;
}

double RootMeanSquare(const MovingPoints& points, const Eigen::VectorXd& squared_errors) {
  return std::sqrt(squared_errors.sum() /
                   (points.NumPoints() * static_cast<double>(points.NumShapes())));
}

void ForRunsOfPoints(int num_points, const std::function<void(int begin, int end)>& body) {
  constexpr int kRun = 128;
  ParallelFor((num_points + kRun - 1) / kRun,
              [&](int run) { body(run * kRun, std::min(num_points, (run + 1) * kRun)); });
}

}  // namespace shapespace::internal
