#include <shapespace/skinning/detail/moving_points.h>

#include <algorithm>
#include <cmath>

#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>

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
  points->component_of.assign(points->vertices.size(), -1);
  std::vector<int> open;
  const auto enter = [&](int p) {
    if (points->component_of[p] >= 0) return false;
    points->component_of[p] = points->num_components;
    open.push_back(p);
    return true;
  };
  for (size_t first = 0; first < points->vertices.size(); ++first) {
    if (!enter(static_cast<int>(first))) continue;
    while (!open.empty()) {
      const int p = open.back();
      open.pop_back();
      for (const int q : points->neighbours[p]) enter(q);
    }
    ++points->num_components;
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
