#ifndef SHAPESPACE_MESH_INTERNAL_NEAREST_ON_TRIANGLE_H_
#define SHAPESPACE_MESH_INTERNAL_NEAREST_ON_TRIANGLE_H_

#include <algorithm>

#include <Eigen/Core>

namespace shapespace::internal {

/// The part of the way from a to b at which their segment is nearest to the origin; 0 if the
/// segment has no length.
inline double NearestOnSegment(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  const Eigen::Vector3d side = b - a;
  const double squared = side.squaredNorm();
  return squared > 0 ? std::clamp(-a.dot(side) / squared, 0.0, 1.0) : 0;
}

/// The point of the triangle (a, b, c) that is nearest to the origin, by its barycentric
/// coordinates, which are in [0, 1]. To rounding of the corners' coordinates for triangles of any
/// form, those without area included.
///
/// The foot of the perpendicular is found by its parts along the longest side and across it, each
/// of which is as exact as the corners are. (Differences of products of four coordinates, by which
/// Ericson, Real-Time Collision Detection, 2005, section 5.1.5, decides where the point is, are
/// rounding in slivers.) It counts only if no point of the sides is nearer.
inline Eigen::Vector3d NearestOnTriangle(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                         const Eigen::Vector3d& c) {
  const Eigen::Vector3d* const corners[] = {&a, &b, &c};
  double least = -1;
  int longest = 0;  // the side from this corner to the next
  double most = 0;
  Eigen::Vector3d nearest;
  for (int k = 0; k < 3; ++k) {
    const int next = (k + 1) % 3;
    const Eigen::Vector3d &from = *corners[k], side = *corners[next] - from;
    const double squared = side.squaredNorm(), s = NearestOnSegment(from, *corners[next]);
    const double distance = (from + s * side).squaredNorm();
    if (least < 0 || distance < least) {
      least = distance;
      nearest.setZero();
      nearest(k) = 1 - s;
      nearest(next) = s;
    }
    if (squared > most) {
      most = squared;
      longest = k;
    }
  }
  if (!(most > 0)) return nearest;
  const int second = (longest + 1) % 3, third = (longest + 2) % 3;
  const Eigen::Vector3d& base = *corners[longest];
  const Eigen::Vector3d along = *corners[second] - base, rise = *corners[third] - base;
  const auto off_base = [&](const Eigen::Vector3d& x) -> Eigen::Vector3d {
    return x - x.dot(along) / most * along;
  };
  const Eigen::Vector3d across = off_base(rise);
  const double height = across.squaredNorm();
  if (!(height > 0)) return nearest;
  // What rounding leaves of the base in `across` would count for as much as the rest does.
  const double by_third = -off_base(base).dot(across) / height;
  const Eigen::Vector3d rest = base + by_third * rise;
  const double by_second = -rest.dot(along) / most, by_first = 1 - by_second - by_third;
  if (!(by_first > 0 && by_second > 0 && by_third > 0)) return nearest;
  if (!((rest + by_second * along).squaredNorm() < least)) return nearest;
  nearest(longest) = by_first;
  nearest(second) = by_second;
  nearest(third) = by_third;
  return nearest;
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MESH_INTERNAL_NEAREST_ON_TRIANGLE_H_
