#include <shapespace/mesh/triangulate.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <set>
#include <utility>

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

/// Cuts ears off a planar polygon until a triangle is left. What a cut does not change is
/// remembered, so that polygons of many thousand corners take seconds.
class EarClipper {
 public:
  explicit EarClipper(std::vector<Point> points)
      : points_(std::move(points)),
        before_(points_.size()),
        after_(points_.size()),
        quality_(points_.size()),
        blocker_(points_.size(), kNone),
        place_(points_.size(), kNone),
        waiting_(points_.size()) {
    const int count = static_cast<int>(points_.size());
    for (int k = 0; k < count; ++k) {
      before_[k] = (k + count - 1) % count;
      after_[k] = (k + 1) % count;
    }
    for (int k = 0; k < count; ++k) Enter(k);
  }

  /// Three corners each.
  std::vector<Eigen::Vector3i> Run() {
    std::vector<Eigen::Vector3i> triangles;
    while (left_.size() > 3) {
      const int ear = BestEar();
      triangles.push_back(TriangleAt(ear));
      CutOff(ear);
    }
    int first = static_cast<int>(points_.size());
    for (const Rank& rank : left_) first = std::min(first, rank.second);
    triangles.push_back(TriangleAt(after_[first]));
    return triangles;
  }

 private:
  static constexpr int kNone = -1;
  using Rank =
      std::pair<double, int>;  // of a corner: the best triangle first, then the first corner

  Rank RankOf(int corner) const { return {-quality_[corner], corner}; }

  /// The triangle of a remaining corner and its two neighbours.
  Eigen::Vector3i TriangleAt(int corner) const { return {before_[corner], corner, after_[corner]}; }

  /// The corner with the best triangle among those that can be cut off. A polygon that intersects
  /// itself may have none; then the corner with the best triangle of all.
  int BestEar() {
    while (!candidates_.empty()) {
      const int corner = candidates_.begin()->second;
      const int blocker = Blocker(TriangleAt(corner));
      if (blocker == kNone) return corner;
      candidates_.erase(candidates_.begin());
      blocker_[corner] = blocker;
      waiting_[blocker].push_back(corner);
    }
    return left_.begin()->second;
  }

  /// Another corner in the triangle or on its sides, if there is one. Only corners at which the
  /// polygon turns right or is straight need to be tested.
  int Blocker(const Eigen::Vector3i& t) const {
    const Point a = points_[t[0]], b = points_[t[1]], c = points_[t[2]];
    for (const int corner : not_left_turns_) {
      const Point p = points_[corner];
      if (p == a || p == b || p == c) continue;
      if (Cross(a, b, p) >= 0 && Cross(b, c, p) >= 0 && Cross(c, a, p) >= 0) return corner;
    }
    return kNone;
  }

  void CutOff(int ear) {
    const int before = before_[ear], after = after_[ear];
    for (const int corner : {before, ear, after}) Leave(corner);
    after_[before] = after;
    before_[after] = before;
    for (const int corner : {before, after}) Enter(corner);
    for (const int corner : {before, ear, after}) Release(corner);
  }

  /// Enters a corner with its present neighbours into all lists.
  void Enter(int corner) {
    const Eigen::Vector3i t = TriangleAt(corner);
    quality_[corner] = Quality(points_[t[0]], points_[t[1]], points_[t[2]]);
    left_.insert(RankOf(corner));
    if (quality_[corner] > 0) {
      candidates_.insert(RankOf(corner));
    } else {
      place_[corner] = static_cast<int>(not_left_turns_.size());
      not_left_turns_.push_back(corner);
    }
  }

  void Leave(int corner) {
    left_.erase(RankOf(corner));
    candidates_.erase(RankOf(corner));
    blocker_[corner] = kNone;
    if (place_[corner] == kNone) return;
    const int last = not_left_turns_.back();
    not_left_turns_[place_[corner]] = last;
    place_[last] = place_[corner];
    not_left_turns_.pop_back();
    place_[corner] = kNone;
  }

  /// Makes candidates again of the corners that only this one blocked, if it does not any more.
  void Release(int corner) {
    if (place_[corner] != kNone) return;
    for (const int waiting : waiting_[corner]) {
      if (blocker_[waiting] != corner) continue;
      blocker_[waiting] = kNone;
      candidates_.insert(RankOf(waiting));
    }
    waiting_[corner].clear();
  }

  const std::vector<Point> points_;
  std::vector<int> before_, after_;        // the neighbours of each corner that is left
  std::vector<double> quality_;            // of the triangle at each corner
  std::set<Rank> left_, candidates_;       // those whose triangle may be free
  std::vector<int> blocker_;               // a corner in the triangle of each that is no candidate
  std::vector<int> not_left_turns_;        // corners that may block
  std::vector<int> place_;                 // of each corner there; kNone: not in it
  std::vector<std::vector<int>> waiting_;  // the corners that each blocks
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
