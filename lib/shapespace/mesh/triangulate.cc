#include <shapespace/mesh/triangulate.h>

#include <algorithm>
#include <cmath>
#include <complex>

#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/mesh/internal/polygons.h>

namespace shapespace {
namespace {

using Point = std::complex<double>;

/// Twice the signed area of a triangle; positive if it is counterclockwise.
double Cross(Point a, Point b, Point c) { return std::imag(std::conj(b - a) * (c - a)); }

/// 1 for an equilateral triangle, 0 for one without area, negative for a clockwise one.
double Quality(Point a, Point b, Point c) {
  const double lengths = std::norm(b - a) + std::norm(c - b) + std::norm(a - c);
  return lengths > 0 ? 2 * std::sqrt(3.0) * Cross(a, b, c) / lengths : 0;
}

/// The corners of a polygon, projected onto the plane perpendicular to its vector area, centred and
/// scaled such that their squared norms have sum 1; counterclockwise. Empty if the polygon has no
/// area.
std::vector<Point> Flatten(const std::vector<int>& polygon, const Shape& pose) {
  Eigen::Matrix3Xd corners(3, polygon.size());
  for (size_t k = 0; k < polygon.size(); ++k) corners.col(k) = pose.col(polygon[k]);
  const Eigen::Vector3d mean = corners.rowwise().mean();
  corners.colwise() -= mean;
  const double size = corners.norm();
  if (!(size > 0)) return {};
  corners /= size;
  Eigen::Vector3d area = Eigen::Vector3d::Zero();
  for (Eigen::Index k = 0; k < corners.cols(); ++k) {
    const Eigen::Vector3d next = corners.col((k + 1) % corners.cols());
    area += corners.col(k).cross(next);
  }
  // Rounding errors of the coordinates do not count as area.
  constexpr double kNoArea = 1e-12;
  if (area.norm() <= kNoArea) return {};
  const Eigen::Vector3d right = area.unitOrthogonal(), up = area.normalized().cross(right);
  std::vector<Point> flat;
  for (const auto& corner : corners.colwise()) flat.emplace_back(right.dot(corner), up.dot(corner));
  return flat;
}

/// The mean over the poses of the projected polygon, each aligned with the first. Empty if it has
/// no area in any pose.
std::vector<Point> MeanPolygon(const std::vector<int>& polygon, const std::vector<Shape>& poses) {
  std::vector<Point> first, mean;
  for (const Shape& pose : poses) {
    const std::vector<Point> flat = Flatten(polygon, pose);
    if (flat.empty()) continue;
    if (first.empty()) {
      first = mean = flat;
      continue;
    }
    Point turn = 0;
    for (size_t k = 0; k < flat.size(); ++k) turn += std::conj(flat[k]) * first[k];
    turn = std::abs(turn) > 0 ? turn / std::abs(turn) : 1;
    for (size_t k = 0; k < flat.size(); ++k) mean[k] += turn * flat[k];
  }
  return mean;
}

/// Cuts ears off a planar polygon until a triangle is left.
class EarClipper {
 public:
  explicit EarClipper(std::vector<Point> points) : points_(std::move(points)) {
    for (size_t k = 0; k < points_.size(); ++k) left_.push_back(static_cast<int>(k));
  }

  /// Three corners each.
  std::vector<Eigen::Vector3i> Run() {
    std::vector<Eigen::Vector3i> triangles;
    while (left_.size() > 3) {
      const int ear = BestEar();
      triangles.push_back(TriangleAt(ear));
      left_.erase(left_.begin() + ear);
    }
    triangles.push_back(TriangleAt(1));
    return triangles;
  }

 private:
  /// The triangle of the i-th remaining corner and its two neighbours.
  Eigen::Vector3i TriangleAt(int i) const {
    const int count = static_cast<int>(left_.size());
    return {left_[(i + count - 1) % count], left_[i], left_[(i + 1) % count]};
  }

  /// The corner with the best triangle among those that can be cut off. A polygon that intersects
  /// itself may have none; then the corner with the best triangle of all.
  int BestEar() {
    const int count = static_cast<int>(left_.size());
    quality_.resize(count);
    order_.resize(count);
    for (int i = 0; i < count; ++i) {
      const Eigen::Vector3i t = TriangleAt(i);
      quality_[i] = Quality(points_[t[0]], points_[t[1]], points_[t[2]]);
      order_[i] = i;
    }
    std::stable_sort(order_.begin(), order_.end(),
                     [this](int i, int j) { return quality_[i] > quality_[j]; });
    for (const int i : order_) {
      if (quality_[i] > 0 && IsFree(TriangleAt(i))) return i;
    }
    return order_.front();
  }

  /// Whether no other corner is in the triangle or on its sides. Only corners at which the polygon
  /// turns right or is straight need to be tested.
  bool IsFree(const Eigen::Vector3i& t) const {
    const Point a = points_[t[0]], b = points_[t[1]], c = points_[t[2]];
    for (size_t i = 0; i < left_.size(); ++i) {
      if (quality_[i] > 0) continue;
      const Point p = points_[left_[i]];
      if (p == a || p == b || p == c) continue;
      if (Cross(a, b, p) >= 0 && Cross(b, c, p) >= 0 && Cross(c, a, p) >= 0) return false;
    }
    return true;
  }

  const std::vector<Point> points_;
  std::vector<int> left_;  // remaining corners, in order
  std::vector<double> quality_;
  std::vector<int> order_;
};

}  // namespace

Eigen::Matrix3Xi Triangulate(const std::vector<int>& polygon_begin, const std::vector<int>& corners,
                             const std::vector<Shape>& poses) {
  if (poses.empty()) throw MeshError("triangulation needs at least one pose");
  for (const Shape& pose : poses) {
    internal::CheckPolygons(static_cast<int>(pose.cols()), polygon_begin, corners);
  }
  std::vector<Eigen::Vector3i> triangles;
  triangles.reserve(corners.size());
  for (size_t p = 0; p + 1 < polygon_begin.size(); ++p) {
    std::vector<int> polygon(corners.begin() + polygon_begin[p],
                             corners.begin() + polygon_begin[p + 1]);
    if (polygon.size() == 3) {
      triangles.emplace_back(polygon[0], polygon[1], polygon[2]);
      continue;
    }
    // From here on the first vertex is the smallest one, whatever the list's first.
    std::rotate(polygon.begin(), std::min_element(polygon.begin(), polygon.end()), polygon.end());
    std::vector<Point> flat = MeanPolygon(polygon, poses);
    if (flat.empty()) flat.resize(polygon.size());  // all ears are equally good
    for (const Eigen::Vector3i& t : EarClipper(std::move(flat)).Run()) {
      triangles.emplace_back(polygon[t[0]], polygon[t[1]], polygon[t[2]]);
    }
  }
  Eigen::Matrix3Xi result(3, triangles.size());
  for (size_t f = 0; f < triangles.size(); ++f) result.col(f) = triangles[f];
  return result;
}

}  // namespace shapespace
