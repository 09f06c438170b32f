#include <shapespace/mesh/surface.h>

#include <utility>

#include <shapespace/mesh/internal/box_tree.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/mesh/internal/nearest_on_triangle.h>

namespace shapespace {
Shape TriangleNormals(const Connectivity& connectivity, const Shape& shape) {
  const Eigen::Matrix3Xi& triangles = connectivity.Triangles();
  Shape normals(3, triangles.cols());
  for (int f = 0; f < triangles.cols(); ++f) {
    normals.col(f) = internal::UnitNormal(shape, triangles.col(f));
  }
  return normals;
}

Shape VertexNormals(const Connectivity& connectivity, const Shape& shape) {
  const Eigen::Matrix3Xi& triangles = connectivity.Triangles();
  Shape normals = Shape::Zero(3, shape.cols());
  for (int f = 0; f < triangles.cols(); ++f) {
    const Eigen::Vector3d normal = internal::AreaNormal(shape, triangles.col(f));
    for (int k = 0; k < 3; ++k) normals.col(triangles(k, f)) += normal;
  }
  for (int v = 0; v < shape.cols(); ++v) normals.col(v).stableNormalize();
  connectivity.CopyToTwins(&normals);
  return normals;
}

namespace {

internal::BoxTree BoxesOf(const Eigen::Matrix3Xi& triangles, const Shape& shape) {
  const Shape a = shape(Eigen::all, triangles.row(0)), b = shape(Eigen::all, triangles.row(1)),
              c = shape(Eigen::all, triangles.row(2));
  return {a.cwiseMin(b).cwiseMin(c), a.cwiseMax(b).cwiseMax(c)};
}

}  // namespace

struct MeshSurface::Scene {
  Scene(std::shared_ptr<const Connectivity> the_connectivity, const Shape& the_shape)
      : connectivity(std::move(the_connectivity)),
        shape(the_shape),
        normals(TriangleNormals(*connectivity, shape)),
        boxes(BoxesOf(connectivity->Triangles(), shape)) {}

  Eigen::Vector3d Corner(int f, int k) const { return shape.col(connectivity->Triangles()(k, f)); }

  const std::shared_ptr<const Connectivity> connectivity;
  const Shape shape, normals;
  const internal::BoxTree boxes;
};

MeshSurface::MeshSurface(std::shared_ptr<const Connectivity> connectivity, const Shape& shape)
    : scene_(std::make_unique<Scene>(std::move(connectivity), shape)) {}

MeshSurface::MeshSurface(MeshSurface&&) noexcept = default;
MeshSurface::~MeshSurface() = default;

ClosestPoint MeshSurface::Nearest(const Eigen::Vector3d& from,
                                  const std::function<bool(int triangle)>& admits,
                                  double within) const {
  ClosestPoint closest;
  closest.distance = within;
  scene_->boxes.VisitNear(from, within, [&](int f) {
    if (scene_->normals.col(f).isZero(0)) return closest.distance;
    const Eigen::Vector3d a = scene_->Corner(f, 0), b = scene_->Corner(f, 1),
                          c = scene_->Corner(f, 2);
    const Eigen::Vector3d barycentric = internal::NearestOnTriangle(a - from, b - from, c - from);
    const Eigen::Vector3d point = barycentric(0) * a + barycentric(1) * b + barycentric(2) * c;
    const double distance = (point - from).norm();
    const bool nearer =
        distance < closest.distance ||
        (distance == closest.distance && (closest.triangle < 0 || f < closest.triangle));
    if (nearer && (!admits || admits(f))) closest = {f, barycentric, point, distance};
    return closest.distance;
  });
  if (closest.triangle < 0) closest.distance = 0;
  return closest;
}

const Connectivity& MeshSurface::GetConnectivity() const { return *scene_->connectivity; }
const Shape& MeshSurface::GetShape() const { return scene_->shape; }
const Shape& MeshSurface::GetTriangleNormals() const { return scene_->normals; }

}  // namespace shapespace
