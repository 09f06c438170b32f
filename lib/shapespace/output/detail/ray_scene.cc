#include <shapespace/output/detail/ray_scene.h>

#include <algorithm>
#include <limits>
#include <set>
#include <utility>
#include <vector>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/embree.h>
#include <shapespace/output/detail/normals.h>

namespace shapespace::internal {
namespace {

// Order in which AddTubes attaches its two geometries.
constexpr unsigned kTubes = 0;

void CheckTracer(RTCDevice device) {
  CheckEmbree(device, "picture: not enough memory for the ray tracer; draw a coarser mesh",
              "picture: the ray tracer (Embree) failed");
}

// A new buffer of `geometry`, owned by Embree, which pads it for vector loads.
template <class T>
T* NewBuffer(RTCDevice device, RTCGeometry geometry, RTCBufferType type, RTCFormat format,
             size_t stride, size_t count) {
  void* buffer = rtcSetNewGeometryBuffer(geometry, type, 0, format, stride, count);
  if (buffer == nullptr) {
    CheckTracer(device);
    throw Error("picture: the ray tracer (Embree) gave no buffer");
  }
  return static_cast<T*>(buffer);
}

using Geometry = std::unique_ptr<RTCGeometryTy, void (*)(RTCGeometry)>;

Geometry NewGeometry(RTCDevice device, RTCGeometryType type) {
  Geometry geometry(rtcNewGeometry(device, type), rtcReleaseGeometry);
  if (!geometry) CheckTracer(device);
  return geometry;
}

void Attach(RTCScene scene, const Geometry& geometry) {
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene, geometry.get());
}

void SetRay(RTCRay* ray, const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
            float distance) {
  ray->org_x = origin.x();
  ray->org_y = origin.y();
  ray->org_z = origin.z();
  ray->dir_x = direction.x();
  ray->dir_y = direction.y();
  ray->dir_z = direction.z();
  ray->tnear = 0;
  ray->tfar = distance;
  ray->time = 0;
  ray->mask = -1;
  ray->id = 0;
  ray->flags = 0;
}

}  // namespace

Eigen::Matrix2Xi SegmentsOfGraph(const Connectivity& connectivity) {
  std::set<std::pair<int, int>> segments;
  for (const auto& [a, b] : connectivity.Segments()) segments.insert(std::minmax(a, b));
  std::vector<int> shown;
  for (int e = 0; e < connectivity.NumEdges(); ++e) {
    const auto edge = connectivity.Edges().col(e);
    if (segments.count({edge(0), edge(1)}) > 0) shown.push_back(e);
  }
  return connectivity.Edges()(Eigen::all, shown);
}

// The device uses Embree's default number of threads, which matters only for building scenes: a
// limit of one would limit all users of TBB in the process.
RayTracer::RayTracer(const Connectivity& connectivity, float tube_radius)
    : connectivity_(connectivity),
      tubes_(connectivity.IsGraph() ? SegmentsOfGraph(connectivity) : Eigen::Matrix2Xi()),
      tube_radius_(tube_radius),
      device_(rtcNewDevice(nullptr), [](RTCDevice device) {
        if (device != nullptr) rtcReleaseDevice(device);
      }) {
  if (!device_) throw Error("picture: the ray tracer (Embree) cannot start on this machine");
}

RayScene::RayScene(const RayTracer& tracer, const Shape& shape, Eigen::VectorXf values)
    : tracer_(tracer), values_(std::move(values)) {
  RTCDevice device = tracer.device_.get();
  scene_.reset(rtcNewScene(device), [](RTCScene scene) {
    if (scene != nullptr) rtcReleaseScene(scene);
  });
  if (!scene_) CheckTracer(device);
  // Robust mode: no ray passes between two adjacent triangles, which would show specks of the
  // inside.
  rtcSetSceneFlags(scene_.get(), RTC_SCENE_FLAG_ROBUST);
  if (tracer.connectivity_.IsGraph()) {
    AddTubes(shape);
  } else {
    AddTriangles(shape);
  }
  rtcCommitScene(scene_.get());
  CheckTracer(device);
}

void RayScene::AddTriangles(const Shape& shape) {
  corner_normals_ = CornerNormals(tracer_.connectivity_, shape);
  RTCDevice device = tracer_.device_.get();
  const Eigen::Matrix3Xi& triangles = tracer_.connectivity_.Triangles();
  const Geometry geometry = NewGeometry(device, RTC_GEOMETRY_TYPE_TRIANGLE);
  auto* vertices = NewBuffer<float>(device, geometry.get(), RTC_BUFFER_TYPE_VERTEX,
                                    RTC_FORMAT_FLOAT3, 3 * sizeof(float), shape.cols());
  Eigen::Map<Eigen::Matrix3Xf>(vertices, 3, shape.cols()) = shape.cast<float>();
  auto* indices = NewBuffer<unsigned>(device, geometry.get(), RTC_BUFFER_TYPE_INDEX,
                                      RTC_FORMAT_UINT3, 3 * sizeof(unsigned), triangles.cols());
  std::copy(triangles.data(), triangles.data() + triangles.size(), indices);
  Attach(scene_.get(), geometry);
}

void RayScene::AddTubes(const Shape& shape) {
  RTCDevice device = tracer_.device_.get();
  const Eigen::Matrix2Xi& edges = tracer_.tubes_;
  const auto point = [&](int v) {
    Eigen::Vector4f result;
    result << shape.col(v).cast<float>(), tracer_.tube_radius_;
    return result;
  };
  const Geometry tubes = NewGeometry(device, RTC_GEOMETRY_TYPE_ROUND_LINEAR_CURVE);
  if (edges.cols() > 0) {
    auto* ends = NewBuffer<float>(device, tubes.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4,
                                  4 * sizeof(float), edges.size());
    auto* first = NewBuffer<unsigned>(device, tubes.get(), RTC_BUFFER_TYPE_INDEX, RTC_FORMAT_UINT,
                                      sizeof(unsigned), edges.cols());
    Eigen::Map<Eigen::Matrix4Xf> columns(ends, 4, edges.size());
    for (Eigen::Index i = 0; i < edges.size(); ++i) columns.col(i) = point(edges.data()[i]);
    for (Eigen::Index e = 0; e < edges.cols(); ++e) first[e] = static_cast<unsigned>(2 * e);
  }
  Attach(scene_.get(), tubes);

  std::vector<bool> loose(shape.cols(), true);
  for (Eigen::Index i = 0; i < edges.size(); ++i) loose[edges.data()[i]] = false;
  std::vector<int> chosen;
  for (int v = 0; v < shape.cols(); ++v) {
    if (loose[v]) chosen.push_back(v);
  }
  if (chosen.empty()) return;
  loose_vertices_ = Eigen::Map<Eigen::VectorXi>(chosen.data(), chosen.size());
  const Geometry balls = NewGeometry(device, RTC_GEOMETRY_TYPE_SPHERE_POINT);
  auto* centres = NewBuffer<float>(device, balls.get(), RTC_BUFFER_TYPE_VERTEX, RTC_FORMAT_FLOAT4,
                                   4 * sizeof(float), chosen.size());
  Eigen::Map<Eigen::Matrix4Xf> columns(centres, 4, chosen.size());
  for (size_t i = 0; i < chosen.size(); ++i) columns.col(i) = point(chosen[i]);
  Attach(scene_.get(), balls);
}

bool RayScene::Trace(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                     Hit* hit) const {
  RTCRayHit ray;
  SetRay(&ray.ray, origin, direction, std::numeric_limits<float>::infinity());
  ray.hit.geomID = RTC_INVALID_GEOMETRY_ID;
  ray.hit.instID[0] = RTC_INVALID_GEOMETRY_ID;
  EmbreeIntersect(scene_.get(), &ray);
  if (ray.hit.geomID == RTC_INVALID_GEOMETRY_ID) return false;

  const unsigned element = ray.hit.primID;
  const float u = ray.hit.u, v = ray.hit.v;
  hit->distance = ray.ray.tfar;
  hit->face_normal = Eigen::Vector3f(ray.hit.Ng_x, ray.hit.Ng_y, ray.hit.Ng_z).stableNormalized();
  hit->back = hit->face_normal.dot(direction) > 0;
  if (hit->back) hit->face_normal = -hit->face_normal;
  hit->normal = hit->face_normal;
  hit->value = 0;
  const auto value = [&](int vertex) { return values_.size() == 0 ? 0.0f : values_[vertex]; };
  if (!tracer_.connectivity_.IsGraph()) {
    const Eigen::Vector3f weights(1 - u - v, u, v);
    const Eigen::Vector3f smooth = corner_normals_.middleCols<3>(3 * element) * weights;
    const float length = smooth.norm();
    if (length > 0) hit->normal = (hit->back ? -smooth : smooth) / length;
    // Near the outline an interpolated normal may point away from the eye; make it perpendicular.
    const float away = hit->normal.dot(direction);
    if (away > 0) hit->normal = (hit->normal - away * direction).stableNormalized();
    const auto corners = tracer_.connectivity_.Triangles().col(element);
    for (int k = 0; k < 3; ++k) hit->value += weights[k] * value(corners[k]);
    int nearest;
    weights.maxCoeff(&nearest);
    hit->vertex = corners[nearest];
  } else if (ray.hit.geomID == kTubes) {
    const auto ends = tracer_.tubes_.col(element);
    hit->value = (1 - u) * value(ends[0]) + u * value(ends[1]);
    hit->vertex = ends[u < 0.5f ? 0 : 1];
  } else {
    hit->vertex = loose_vertices_[element];
    hit->value = value(hit->vertex);
  }
  return true;
}

bool RayScene::Blocked(const Eigen::Vector3f& origin, const Eigen::Vector3f& direction,
                       float distance) const {
  RTCRay ray;
  SetRay(&ray, origin, direction, distance);
  EmbreeOccluded(scene_.get(), &ray);
  return ray.tfar < 0;
}

}  // namespace shapespace::internal
