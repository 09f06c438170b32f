#include <shapespace/analysis/intersections.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/embree.h>
#include <shapespace/base/internal/fork_join.h>
#include <shapespace/base/parallel.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace {
namespace {

// Lengths below this, as a share of the shape's extent, are rounding; this is sufficient for
// coordinates up to a million extents away from the origin.
constexpr double kTouching = 1e-9;

using Corners = std::array<Eigen::Vector3d, 3>;

// The intersection of a triangle with the common line of its plane and another triangle's.
struct Span {
  double begin, end;
};

// The heights of `triangle`'s corners above the plane of `other`; returns false unless it has
// corners on both sides.
bool Heights(const Corners& triangle, const Corners& other, const Eigen::Vector3d& unit_normal,
             double touching, std::array<double, 3>* heights) {
  for (int k = 0; k < 3; ++k) (*heights)[k] = unit_normal.dot(triangle[k] - other[0]);
  const auto [low, high] = std::minmax_element(heights->begin(), heights->end());
  return -*low > touching && *high > touching;
}

// The interval, along `direction` from `origin`, in which a triangle with corners on both sides of
// a plane intersects it.
Span Cut(const Corners& triangle, const std::array<double, 3>& heights,
         const Eigen::Vector3d& origin, const Eigen::Vector3d& direction) {
  Span span = {std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    if ((heights[k] < 0) == (heights[next] < 0)) continue;
    const double part = heights[k] / (heights[k] - heights[next]);
    const Eigen::Vector3d point = triangle[k] + part * (triangle[next] - triangle[k]);
    const double at = direction.dot(point - origin);
    span.begin = std::min(span.begin, at);
    span.end = std::max(span.end, at);
  }
  return span;
}

// T. Moeller, "A fast triangle-triangle intersection test", Journal of Graphics Tools 1997: both
// triangles intersect the common line of their planes, and the intervals overlap.
bool Cross(const Corners& a, const Corners& b, double touching) {
  const Eigen::Vector3d normal_a = internal::UnitNormal(a[0], a[1], a[2]);
  const Eigen::Vector3d normal_b = internal::UnitNormal(b[0], b[1], b[2]);
  std::array<double, 3> heights_a, heights_b;
  if (!Heights(a, b, normal_b, touching, &heights_a) ||
      !Heights(b, a, normal_a, touching, &heights_b)) {
    return false;
  }
  const Eigen::Vector3d direction = normal_a.cross(normal_b).stableNormalized();
  const Span span_a = Cut(a, heights_a, a[0], direction);
  const Span span_b = Cut(b, heights_b, a[0], direction);
  return std::min(span_a.end, span_b.end) - std::max(span_a.begin, span_b.begin) > touching;
}

// Triangles of a vertex with more of them than kLargestFan are handled in groups. Each two of them
// share the vertex, so that they never count, but the boxes of all contain it: one by one, the
// poles of a globe would take time quadratic in their number.
constexpr int kLargestFan = 64, kGroup = 64;

// Triangles order[begin[g]] ... order[begin[g + 1] - 1] are group g; `fan` is the vertex that they
// have in common, and -1 for a triangle that is alone.
struct Groups {
  std::vector<int> order, begin = {0}, fan;
};

Groups MakeGroups(const Connectivity& connectivity) {
  Groups groups;
  std::vector<char> is_grouped(connectivity.NumTriangles(), 0);
  const auto close = [&](int fan) {
    groups.begin.push_back(static_cast<int>(groups.order.size()));
    groups.fan.push_back(fan);
  };
  for (int v = 0; v < connectivity.NumVertices(); ++v) {
    const auto around = connectivity.TrianglesOfVertices()[v];
    if (around.size() <= kLargestFan) continue;
    for (const int f : around) {
      if (is_grouped[f]) continue;
      is_grouped[f] = 1;
      groups.order.push_back(f);
      if (static_cast<int>(groups.order.size()) - groups.begin.back() == kGroup) close(v);
    }
    if (static_cast<int>(groups.order.size()) > groups.begin.back()) close(v);
  }
  for (int f = 0; f < connectivity.NumTriangles(); ++f) {
    if (is_grouped[f]) continue;
    groups.order.push_back(f);
    close(-1);
  }
  return groups;
}

// One shape, for Embree's callbacks.
struct Triangles {
  const Eigen::Matrix3Xi* indices;
  const Groups* groups;
  Shape vertices;  // within the unit cube about the origin, where float boxes are accurate
  size_t most;     // pairs that are looked for
  std::mutex mutex;
  std::vector<std::pair<int, int>>* pairs;  // guarded by mutex, read after callbacks' destruction
  internal::ForkJoin callbacks;

  Corners At(unsigned f) const {
    const auto corner = indices->col(f);
    return {vertices.col(corner(0)), vertices.col(corner(1)), vertices.col(corner(2))};
  }
};

bool BoxesApart(const Corners& a, const Corners& b) {
  for (int axis = 0; axis < 3; ++axis) {
    const auto [low_a, high_a] = std::minmax({a[0](axis), a[1](axis), a[2](axis)});
    const auto [low_b, high_b] = std::minmax({b[0](axis), b[1](axis), b[2](axis)});
    if (high_a < low_b || high_b < low_a) return true;
  }
  return false;
}

void Bounds(const RTCBoundsFunctionArguments* arguments) {
  const auto* triangles = static_cast<const Triangles*>(arguments->geometryUserPtr);
  const internal::ForkJoin::Piece piece(triangles->callbacks);
  const Groups& groups = *triangles->groups;
  const int group = static_cast<int>(arguments->primID);
  Eigen::Vector3d low = triangles->At(groups.order[groups.begin[group]])[0], high = low;
  for (int i = groups.begin[group]; i < groups.begin[group + 1]; ++i) {
    for (const Eigen::Vector3d& corner : triangles->At(groups.order[i])) {
      low = low.cwiseMin(corner);
      high = high.cwiseMax(corner);
    }
  }
  // The boxes are enlarged by more than the rounding to float of coordinates in the unit cube.
  constexpr float kRounding = std::numeric_limits<float>::epsilon();
  RTCBounds* bounds = arguments->bounds_o;
  bounds->lower_x = static_cast<float>(low.x()) - kRounding;
  bounds->lower_y = static_cast<float>(low.y()) - kRounding;
  bounds->lower_z = static_cast<float>(low.z()) - kRounding;
  bounds->upper_x = static_cast<float>(high.x()) + kRounding;
  bounds->upper_y = static_cast<float>(high.y()) + kRounding;
  bounds->upper_z = static_cast<float>(high.z()) + kRounding;
}

// Appends the two triangles if they intersect and have no vertex in common.
void AddIfCrossing(const Triangles& triangles, int first, int second,
                   std::vector<std::pair<int, int>>* found) {
  const auto u = triangles.indices->col(first), v = triangles.indices->col(second);
  if (u(0) == v(0) || u(0) == v(1) || u(0) == v(2) || u(1) == v(0) || u(1) == v(1) ||
      u(1) == v(2) || u(2) == v(0) || u(2) == v(1) || u(2) == v(2)) {
    return;
  }
  const Corners a = triangles.At(first), b = triangles.At(second);
  if (!BoxesApart(a, b) && Cross(a, b, kTouching)) {
    found->emplace_back(std::min(first, second), std::max(first, second));
  }
}

// Called on several threads. For a scene with itself Embree finds every pair twice.
void OnPairs(void* user, RTCCollision* pairs, unsigned num_pairs) {
  auto* triangles = static_cast<Triangles*>(user);
  const internal::ForkJoin::Piece piece(triangles->callbacks);
  {
    const std::lock_guard<std::mutex> lock(triangles->mutex);
    if (triangles->pairs->size() >= triangles->most) return;
  }
  const Groups& groups = *triangles->groups;
  std::vector<std::pair<int, int>> found;
  for (unsigned i = 0; i < num_pairs; ++i) {
    const unsigned first = pairs[i].primID0, second = pairs[i].primID1;
    if (first >= second) continue;
    if (groups.fan[first] >= 0 && groups.fan[first] == groups.fan[second]) continue;
    for (int k = groups.begin[first]; k < groups.begin[first + 1]; ++k) {
      for (int l = groups.begin[second]; l < groups.begin[second + 1]; ++l) {
        AddIfCrossing(*triangles, groups.order[k], groups.order[l], &found);
      }
    }
  }
  if (found.empty()) return;
  const std::lock_guard<std::mutex> lock(triangles->mutex);
  triangles->pairs->insert(triangles->pairs->end(), found.begin(), found.end());
}

void Check(RTCDevice device) {
  switch (rtcGetDeviceError(device)) {
    case RTC_ERROR_NONE:
      return;
    case RTC_ERROR_OUT_OF_MEMORY:
      throw Error("intersections: not enough memory for Embree");
    default:
      throw Error("intersections: Embree failed");
  }
}

// All intersections, in any order; of more than `most`, at least that many.
void Collide(RTCDevice device, Triangles* triangles) {
  const std::unique_ptr<RTCSceneTy, void (*)(RTCScene)> scene(rtcNewScene(device), rtcReleaseScene);
  const std::unique_ptr<RTCGeometryTy, void (*)(RTCGeometry)> geometry(
      rtcNewGeometry(device, RTC_GEOMETRY_TYPE_USER), rtcReleaseGeometry);
  Check(device);
  rtcSetGeometryUserPrimitiveCount(geometry.get(),
                                   static_cast<unsigned>(triangles->groups->fan.size()));
  rtcSetGeometryUserData(geometry.get(), triangles);
  rtcSetGeometryBoundsFunction(geometry.get(), Bounds, nullptr);
  rtcCommitGeometry(geometry.get());
  rtcAttachGeometry(scene.get(), geometry.get());
  rtcCommitScene(scene.get());
  rtcCollide(scene.get(), scene.get(), OnPairs, triangles);
  Check(device);
}

std::vector<std::pair<int, int>> FindOnDevice(RTCDevice device, const Connectivity& connectivity,
                                              const Groups& groups, const Shape& shape,
                                              size_t most = std::numeric_limits<size_t>::max()) {
  if (shape.cols() != connectivity.NumVertices()) {
    throw MeshError("intersections: the shape has " + std::to_string(shape.cols()) +
                    " vertices, its connectivity " + std::to_string(connectivity.NumVertices()));
  }
  if (!shape.allFinite()) throw MeshError("intersections: the shape is not finite");
  if (connectivity.NumTriangles() == 0) return {};
  const Eigen::Vector3d low = shape.rowwise().minCoeff(), high = shape.rowwise().maxCoeff();
  const double extent = (high - low).maxCoeff();
  if (!(extent > 0)) return {};
  std::vector<std::pair<int, int>> pairs;
  {
    Triangles triangles{&connectivity.Triangles(),
                        &groups,
                        (shape.colwise() - (low + high) / 2) / extent,
                        most,
                        {},
                        &pairs,
                        {}};
    Collide(device, &triangles);
  }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

using Device = std::unique_ptr<RTCDeviceTy, void (*)(RTCDevice)>;

Device StartDevice() {
  Device device(rtcNewDevice(nullptr), rtcReleaseDevice);
  if (!device) throw Error("intersections: Embree cannot start on this machine");
  return device;
}

}  // namespace

std::vector<std::pair<int, int>> FindIntersections(const Connectivity& connectivity,
                                                   const Shape& shape) {
  return FindOnDevice(StartDevice().get(), connectivity, MakeGroups(connectivity), shape);
}

std::int64_t CountIntersections(const Connectivity& connectivity, const Shape& shape) {
  return CountIntersections(connectivity, std::vector<Shape>{shape}).front();
}

std::int64_t CountIntersections(const Connectivity& connectivity, const Shape& shape,
                                std::int64_t most) {
  const auto found = FindOnDevice(StartDevice().get(), connectivity, MakeGroups(connectivity),
                                  shape, static_cast<size_t>(most));
  return std::min(most, static_cast<std::int64_t>(found.size()));
}

std::vector<std::int64_t> CountIntersections(const Connectivity& connectivity,
                                             const std::vector<Shape>& shapes) {
  const Device device = StartDevice();
  const Groups groups = MakeGroups(connectivity);
  std::vector<std::int64_t> counts(shapes.size());
  ParallelFor(static_cast<int>(shapes.size()), [&](int i) {
    counts[i] = static_cast<std::int64_t>(
        FindOnDevice(device.get(), connectivity, groups, shapes[i]).size());
  });
  return counts;
}

}  // namespace shapespace
