#include <shapespace/mesh/surface.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/embree.h>
#include <shapespace/base/internal/fork_join.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/mesh/internal/nearest_on_triangle.h>

namespace shapespace {
namespace {

constexpr float kRounding = std::numeric_limits<float>::epsilon();

}  // namespace

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

struct MeshSurface::Scene {
  const std::shared_ptr<const Connectivity> connectivity;
  const Shape shape, normals;
  // Boxes are in single precision, relative to the centre, in units of half the extent.
  const Eigen::Vector3d low, high, centre;
  const double unit;
  const internal::ForkJoin callbacks{};  // constructed after the data that they read
  RTCDevice device = nullptr;
  RTCScene scene = nullptr;

  Scene(std::shared_ptr<const Connectivity> the_connectivity, const Shape& the_shape)
      : connectivity(std::move(the_connectivity)),
        shape(the_shape),
        normals(TriangleNormals(*connectivity, shape)),
        low(shape.rowwise().minCoeff()),
        high(shape.rowwise().maxCoeff()),
        centre(low + 0.5 * (high - low)),
        unit(0.5 * (high - low).maxCoeff()) {}
  Scene(const Scene&) = delete;
  ~Scene() {
    if (scene != nullptr) rtcReleaseScene(scene);
    if (device != nullptr) rtcReleaseDevice(device);
  }

  Eigen::Vector3d Corner(unsigned f, int k) const {
    return shape.col(connectivity->Triangles()(k, f));
  }

  static void Bounds(const RTCBoundsFunctionArguments* arguments) {
    const auto* self = static_cast<const Scene*>(arguments->geometryUserPtr);
    const internal::ForkJoin::Piece piece(self->callbacks);
    std::array<Eigen::Vector3d, 3> corners;
    for (int k = 0; k < 3; ++k) {
      corners[k] = (self->Corner(arguments->primID, k) - self->centre) / self->unit;
    }
    const Eigen::Vector3f low =
        corners[0].cwiseMin(corners[1]).cwiseMin(corners[2]).cast<float>().array() - kRounding;
    const Eigen::Vector3f high =
        corners[0].cwiseMax(corners[1]).cwiseMax(corners[2]).cast<float>().array() + kRounding;
    RTCBounds* bounds = arguments->bounds_o;
    bounds->lower_x = low.x(), bounds->lower_y = low.y(), bounds->lower_z = low.z();
    bounds->upper_x = high.x(), bounds->upper_y = high.y(), bounds->upper_z = high.z();
  }

  struct Query {
    const Scene* scene;
    const std::function<bool(int)>* admits;
    Eigen::Vector3d point;
    double within;
    ClosestPoint closest;
  };

  // The point query's radius, in these units, that includes everything within `distance`. Near the
  // body, points are rounded by less than the boxes are widened; farther away, by a share of their
  // distance.
  static float Radius(double distance) {
    return static_cast<float>(distance * (1 + 4.0 * kRounding));
  }

  static bool OnTriangle(RTCPointQueryFunctionArguments* arguments) {
    auto* query = static_cast<Query*>(arguments->userPtr);
    const Scene& self = *query->scene;
    const unsigned f = arguments->primID;
    const int number = static_cast<int>(f);
    if (self.normals.col(f).isZero(0)) return false;
    const Eigen::Vector3d a = self.Corner(f, 0), b = self.Corner(f, 1), c = self.Corner(f, 2);
    const Eigen::Vector3d& from = query->point;
    const Eigen::Vector3d barycentric = internal::NearestOnTriangle(a - from, b - from, c - from);
    const Eigen::Vector3d point = barycentric(0) * a + barycentric(1) * b + barycentric(2) * c;
    const double distance = (point - query->point).norm();
    ClosestPoint& closest = query->closest;
    if (!(distance <= query->within)) return false;
    if (closest.triangle >= 0 && (distance > closest.distance ||
                                  (distance == closest.distance && number > closest.triangle))) {
      return false;
    }
    if (*query->admits && !(*query->admits)(number)) return false;
    closest = {number, barycentric, point, distance};
    arguments->query->radius = Radius(distance / self.unit);
    return true;
  }
};

MeshSurface::MeshSurface(std::shared_ptr<const Connectivity> connectivity, const Shape& shape)
    : scene_(std::make_unique<Scene>(std::move(connectivity), shape)) {
  Scene& self = *scene_;
  self.device = rtcNewDevice(nullptr);
  if (self.device == nullptr) throw Error("Embree cannot start");
  self.scene = rtcNewScene(self.device);
  RTCGeometry geometry = rtcNewGeometry(self.device, RTC_GEOMETRY_TYPE_USER);
  rtcSetGeometryUserPrimitiveCount(geometry,
                                   static_cast<unsigned>(self.connectivity->NumTriangles()));
  rtcSetGeometryUserData(geometry, &self);
  rtcSetGeometryBoundsFunction(geometry, &Scene::Bounds, nullptr);
  rtcSetGeometryPointQueryFunction(geometry, &Scene::OnTriangle);
  rtcCommitGeometry(geometry);
  rtcAttachGeometry(self.scene, geometry);
  rtcReleaseGeometry(geometry);
  rtcCommitScene(self.scene);
  if (rtcGetDeviceError(self.device) != RTC_ERROR_NONE) throw Error("Embree ran out of memory");
}

MeshSurface::MeshSurface(MeshSurface&&) noexcept = default;
MeshSurface::~MeshSurface() = default;

ClosestPoint MeshSurface::Nearest(const Eigen::Vector3d& point,
                                  const std::function<bool(int triangle)>& admits,
                                  double within) const {
  const Scene& self = *scene_;
  const Eigen::Vector3d local = (point - self.centre) / self.unit;
  Scene::Query query = {&self, &admits, point, within, {}};
  RTCPointQuery at;
  at.x = static_cast<float>(local.x());
  at.y = static_cast<float>(local.y());
  at.z = static_cast<float>(local.z());
  at.time = 0;
  at.radius = Scene::Radius(within / self.unit);
  RTCPointQueryContext context;
  rtcInitPointQueryContext(&context);
  rtcPointQuery(self.scene, &at, &context, nullptr, &query);
  return query.closest;
}

const Connectivity& MeshSurface::GetConnectivity() const { return *scene_->connectivity; }
const Shape& MeshSurface::GetShape() const { return scene_->shape; }
const Shape& MeshSurface::GetTriangleNormals() const { return scene_->normals; }

}  // namespace shapespace
