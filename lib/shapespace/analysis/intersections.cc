#include <shapespace/analysis/intersections.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cmath>
#include <limits>
#include <mutex>
#include <string>
#include <utility>

#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>
#include <shapespace/mesh/internal/box_tree.h>
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

// One shape.
struct Triangles {
  const Eigen::Matrix3Xi& indices;
  const Groups& groups;
  Shape vertices;  // within the unit cube about the origin

  Corners At(int f) const {
    const auto corner = indices.col(f);
    return {vertices.col(corner(0)), vertices.col(corner(1)), vertices.col(corner(2))};
  }

  // Of the groups.
  internal::BoxTree Boxes() const {
    const int count = static_cast<int>(groups.fan.size());
    Eigen::Matrix3Xd low(3, count), high(3, count);
    for (int group = 0; group < count; ++group) {
      low.col(group) = high.col(group) = At(groups.order[groups.begin[group]])[0];
      for (int i = groups.begin[group]; i < groups.begin[group + 1]; ++i) {
        for (const Eigen::Vector3d& corner : At(groups.order[i])) {
          low.col(group) = low.col(group).cwiseMin(corner);
          high.col(group) = high.col(group).cwiseMax(corner);
        }
      }
    }
    return {low, high};
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

// Appends the two triangles if they intersect and have no vertex in common.
void AddIfCrossing(const Triangles& triangles, int first, int second,
                   std::vector<std::pair<int, int>>* found) {
  const auto u = triangles.indices.col(first), v = triangles.indices.col(second);
  if (u(0) == v(0) || u(0) == v(1) || u(0) == v(2) || u(1) == v(0) || u(1) == v(1) ||
      u(1) == v(2) || u(2) == v(0) || u(2) == v(1) || u(2) == v(2)) {
    return;
  }
  const Corners a = triangles.At(first), b = triangles.At(second);
  if (!BoxesApart(a, b) && Cross(a, b, kTouching)) {
    found->emplace_back(std::min(first, second), std::max(first, second));
  }
}

// All intersections, in any order; of more than `most`, at least that many.
std::vector<std::pair<int, int>> Collide(const Triangles& triangles, size_t most) {
  const Groups& groups = triangles.groups;
  std::vector<std::pair<int, int>> pairs;
  std::mutex mutex;
  std::atomic<bool> complete{false};
  triangles.Boxes().VisitPairs([&](int first, int second) {
    if (complete) return;
    if (groups.fan[first] >= 0 && groups.fan[first] == groups.fan[second]) return;
    std::vector<std::pair<int, int>> found;
    for (int k = groups.begin[first]; k < groups.begin[first + 1]; ++k) {
      for (int l = groups.begin[second]; l < groups.begin[second + 1]; ++l) {
        AddIfCrossing(triangles, groups.order[k], groups.order[l], &found);
      }
    }
    if (found.empty()) return;
    const std::lock_guard<std::mutex> lock(mutex);
    pairs.insert(pairs.end(), found.begin(), found.end());
    if (pairs.size() >= most) complete = true;
  });
  return pairs;
}

std::vector<std::pair<int, int>> Find(const Connectivity& connectivity, const Groups& groups,
                                      const Shape& shape,
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
  std::vector<std::pair<int, int>> pairs = Collide(
      {connectivity.Triangles(), groups, (shape.colwise() - (low + high) / 2) / extent}, most);
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

}  // namespace

std::vector<std::pair<int, int>> FindIntersections(const Connectivity& connectivity,
                                                   const Shape& shape) {
  return Find(connectivity, MakeGroups(connectivity), shape);
}

std::int64_t CountIntersections(const Connectivity& connectivity, const Shape& shape) {
  return CountIntersections(connectivity, std::vector<Shape>{shape}).front();
}

std::int64_t CountIntersections(const Connectivity& connectivity, const Shape& shape,
                                std::int64_t most) {
  const auto found = Find(connectivity, MakeGroups(connectivity), shape, static_cast<size_t>(most));
  return std::min(most, static_cast<std::int64_t>(found.size()));
}

std::vector<std::int64_t> CountIntersections(const Connectivity& connectivity,
                                             const std::vector<Shape>& shapes) {
  const Groups groups = MakeGroups(connectivity);
  std::vector<std::int64_t> counts(shapes.size());
  ParallelFor(static_cast<int>(shapes.size()), [&](int i) {
    counts[i] = static_cast<std::int64_t>(Find(connectivity, groups, shapes[i]).size());
  });
  return counts;
}

}  // namespace shapespace
