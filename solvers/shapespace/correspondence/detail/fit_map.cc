#include <shapespace/correspondence/detail/fit_map.h>

#include <algorithm>
#include <cmath>

#include <shapespace/base/parallel.h>
#include <shapespace/correspondence/detail/marker_distances.h>
#include <shapespace/correspondence/detail/unfold.h>
#include <shapespace/mesh/surface.h>

namespace shapespace::internal {
namespace {

// The template's vertices on the target, and how near the fitted template is to them.
void MapToTarget(const Level& level, const Shape& fitted, const Target& target, SurfaceMap* map,
                 CorrespondenceSummary* summary) {
  const std::vector<ClosestPoint> closest = MapVertices(level, fitted, target);
  map->to_target = PointsOf(closest);
  const Eigen::VectorXd areas = VertexAreas(*level.connectivity, fitted);
  double squares = 0;
  for (int v = 0; v < fitted.cols(); ++v) {
    squares += areas(v) * closest[v].distance * closest[v].distance;
    summary->distance_max = std::fmax(summary->distance_max, closest[v].distance);
  }
  summary->distance_rms = std::sqrt(squares);
  const std::vector<bool> turned = TurnedTriangles(level, fitted, target, closest);
  summary->turned = static_cast<double>(std::count(turned.begin(), turned.end(), true)) /
                    static_cast<double>(turned.size());
}

// The target's vertices on the template; those that it does not cover take the image of the nearest
// covered one along the surface.
void MapToTemplate(const Level& level, const Shape& fitted, const Target& target, SurfaceMap* map,
                   CorrespondenceSummary* summary) {
  const MeshSurface surface(level.connectivity, fitted);
  const int num_others = target.GetConnectivity().NumVertices();
  std::vector<ClosestPoint> others(num_others);
  map->gap.resize(num_others);
  ParallelFor(num_others, [&](int y) {
    others[y] = NearestOnTemplate(surface, level, target, y);
    map->gap(y) = others[y].triangle >= 0 ? std::min(1.0, others[y].distance) : 1;
  });
  std::vector<int> covered;
  summary->uncovered = 0;
  for (int y = 0; y < num_others; ++y) {
    if (map->gap(y) < kCovered) {
      covered.push_back(y);
    } else {
      summary->uncovered += target.VertexAreas()(y);
    }
  }
  const std::vector<int> nearest = NearestOf(target.GetConnectivity(), target.GetShape(), covered);
  for (int y = 0; y < num_others; ++y) {
    if (map->gap(y) < kCovered) continue;
    map->gap(y) = 1;
    others[y] = nearest[y] >= 0 ? others[nearest[y]] : surface.Nearest(target.GetShape().col(y));
  }
  map->to_template = PointsOf(others);
}

// Point `from` becomes the vertex `to`. A vertex lies in several triangles, so the nearest point
// may differ from it by rounding.
void Snap(const Eigen::Matrix3Xi& triangles, int from, int to, SurfacePoints* points) {
  for (int f = 0; f < triangles.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      if (triangles(k, f) != to) continue;
      points->triangle(from) = f;
      points->barycentric.col(from) = Eigen::Vector3d::Unit(k);
      return;
    }
  }
}

void CopyToTwins(const Connectivity& connectivity, SurfacePoints* points) {
  connectivity.CopyToTwins(&points->triangle);
  connectivity.CopyToTwins(&points->barycentric);
}

}  // namespace

SurfaceMap MakeMap(const Level& level, const Shape& fitted, const Shape& rest, const Target& target,
                   const std::vector<CorrespondenceMarker>& held, CorrespondenceSummary* summary) {
  SurfaceMap map;
  MapToTarget(level, fitted, target, &map, summary);
  MapToTemplate(level, fitted, target, &map, summary);
  for (const CorrespondenceMarker& marker : held) {
    Snap(target.GetConnectivity().Triangles(), marker.template_vertex, marker.target_vertex,
         &map.to_target);
    Snap(level.connectivity->Triangles(), marker.target_vertex, marker.template_vertex,
         &map.to_template);
  }
  CopyToTwins(*level.connectivity, &map.to_target);
  CopyToTwins(target.GetConnectivity(), &map.to_template);
  const Shape back = PullBack(map.to_template, level.connectivity->Triangles(), rest);
  const Shape there_and_back = PullBack(map.to_target, target.GetConnectivity().Triangles(), back);
  map.round_trip = (there_and_back - rest).colwise().norm();
  Eigen::VectorXd sorted = map.round_trip;
  std::sort(sorted.begin(), sorted.end());
  summary->round_trip_mean = sorted.mean();
  summary->round_trip_p95 = sorted(static_cast<Eigen::Index>(0.95 * (sorted.size() - 1)));
  return map;
}

}  // namespace shapespace::internal
