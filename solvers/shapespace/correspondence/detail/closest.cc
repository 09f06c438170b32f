#include <shapespace/correspondence/detail/closest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <shapespace/base/parallel.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace::internal {
namespace {

// Least cosine of the angle between corresponding normals.
constexpr double kMinCosine = 0.3;
// Points farther apart than this share of the square root of the area are not matched.
constexpr double kFar = 0.05;

}  // namespace

SurfacePoints PointsOf(const std::vector<ClosestPoint>& closest) {
  SurfacePoints points;
  points.triangle.resize(static_cast<Eigen::Index>(closest.size()));
  points.barycentric.resize(3, static_cast<Eigen::Index>(closest.size()));
  for (Eigen::Index i = 0; i < points.triangle.size(); ++i) {
    points.triangle(i) = closest[i].triangle;
    points.barycentric.col(i) = closest[i].barycentric;
  }
  return points;
}

Eigen::VectorXd VertexAreas(const Connectivity& connectivity, const Shape& shape) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(shape.cols());
  for (int f = 0; f < connectivity.NumTriangles(); ++f) {
    const auto triangle = connectivity.Triangles().col(f);
    const double area = TriangleArea(shape, triangle);
    for (int k = 0; k < 3; ++k) areas(triangle(k)) += area;
  }
  return areas / areas.sum();
}

Border BorderOf(const Connectivity& connectivity) {
  const Eigen::Matrix3Xi& triangles = connectivity.Triangles();
  Border border;
  border.sides.assign(triangles.cols(), {false, false, false});
  border.vertices.assign(connectivity.NumVertices(), false);
  for (int e = 0; e < connectivity.NumTriangleEdges(); ++e) {
    const IndexLists::Row around = connectivity.TrianglesOfEdges()[e];
    if (around.size() > 1) continue;
    const int a = connectivity.Edges()(0, e), b = connectivity.Edges()(1, e), f = around[0];
    for (int k = 0; k < 3; ++k) {
      if (triangles(k, f) != a && triangles(k, f) != b) border.sides[f][k] = true;
    }
    border.vertices[a] = border.vertices[b] = true;
  }
  return border;
}

namespace {

// A point on a corner lies on the border if a side of any triangle there does.
bool IsOnBorder(const ClosestPoint& closest, const Eigen::Matrix3Xi& triangles,
                const Border& border) {
  for (int k = 0; k < 3; ++k) {
    if (closest.barycentric(k) == 0 && border.sides[closest.triangle][k]) return true;
    if (closest.barycentric(k) == 1 && border.vertices[triangles(k, closest.triangle)]) return true;
  }
  return false;
}

}  // namespace

Target::Target(std::shared_ptr<const Connectivity> connectivity, const Shape& shape,
               const MarkerDistances& distances)
    : connectivity_(std::move(connectivity)),
      surface_(connectivity_, shape),
      normals_(shapespace::VertexNormals(*connectivity_, shape)),
      areas_(internal::VertexAreas(*connectivity_, shape)),
      border_(BorderOf(*connectivity_)),
      distances_(distances) {}

Eigen::Vector3d Target::NormalAt(const ClosestPoint& closest) const {
  const auto triangle = connectivity_->Triangles().col(closest.triangle);
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();
  for (int k = 0; k < 3; ++k) normal += closest.barycentric(k) * normals_.col(triangle(k));
  return normal.stableNormalized();
}

ClosestPoint Target::Nearest(const Eigen::Vector3d& point, const Eigen::Vector3d& normal,
                             int template_vertex, double within) const {
  return surface_.Nearest(
      point,
      [&](int f) {
        return surface_.GetTriangleNormals().col(f).dot(normal) > kMinCosine &&
               distances_.MayMatch(template_vertex, connectivity_->Triangles()(0, f));
      },
      within);
}

bool Target::IsOnBorder(const ClosestPoint& closest) const {
  return internal::IsOnBorder(closest, connectivity_->Triangles(), border_);
}

ClosestPoint NearestOnTemplate(const MeshSurface& fitted, const Level& level, const Target& target,
                               int target_vertex) {
  const auto normal = target.GetVertexNormals().col(target_vertex);
  return fitted.Nearest(
      target.GetShape().col(target_vertex),
      [&](int f) {
        const int vertex = level.vertices[level.connectivity->Triangles()(0, f)];
        return fitted.GetTriangleNormals().col(f).dot(normal) > kMinCosine &&
               target.Distances().MayMatch(vertex, target_vertex);
      },
      kFar);
}

TargetSamples SampleTarget(const Target& target, int count) {
  const int num_vertices = target.GetConnectivity().NumVertices();
  const int stride = std::max(1, num_vertices / count);
  TargetSamples samples;
  for (int y = 0; y < num_vertices; y += stride) samples.vertices.push_back(y);
  samples.area = target.VertexAreas()(samples.vertices).sum();
  return samples;
}

std::vector<PointToPlaneTerm> FindTerms(const Level& level, const Shape& shape,
                                        const Eigen::VectorXd& areas, const Target& target,
                                        const TargetSamples& samples, double weight,
                                        double* distance) {
  const auto num_vertices = static_cast<int>(shape.cols());
  const Shape normals = VertexNormals(*level.connectivity, shape);
  std::vector<ClosestPoint> closest(num_vertices);
  ParallelFor(num_vertices, [&](int v) {
    closest[v] = target.Nearest(shape.col(v), normals.col(v), level.vertices[v], kFar);
  });
  std::vector<PointToPlaneTerm> terms;
  double squares = 0, sum = 0;
  for (int v = 0; v < num_vertices; ++v) {
    if (closest[v].triangle < 0) continue;
    squares += areas(v) * closest[v].distance * closest[v].distance;
    sum += areas(v);
    if (target.IsOnBorder(closest[v])) continue;
    terms.push_back(
        {{v, v, v}, {1, 0, 0}, closest[v].point, target.NormalAt(closest[v]), weight * areas(v)});
  }
  *distance = sum > 0 ? std::sqrt(squares / sum) : 0;

  const MeshSurface fitted(level.connectivity, shape);
  const auto num_others = static_cast<int>(samples.vertices.size());
  std::vector<ClosestPoint> others(num_others);
  ParallelFor(num_others, [&](int i) {
    others[i] = NearestOnTemplate(fitted, level, target, samples.vertices[i]);
  });
  for (int i = 0; i < num_others; ++i) {
    if (others[i].triangle < 0 ||
        IsOnBorder(others[i], level.connectivity->Triangles(), level.border)) {
      continue;
    }
    const int y = samples.vertices[i];
    terms.push_back({level.connectivity->Triangles().col(others[i].triangle), others[i].barycentric,
                     target.GetShape().col(y), target.GetVertexNormals().col(y),
                     weight * target.VertexAreas()(y) / samples.area});
  }
  return terms;
}

}  // namespace shapespace::internal
