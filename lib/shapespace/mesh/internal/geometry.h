#ifndef SHAPESPACE_MESH_INTERNAL_GEOMETRY_H_
#define SHAPESPACE_MESH_INTERNAL_GEOMETRY_H_

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <shapespace/mesh/shape.h>

// Angles, lengths of edges, and areas and normals of triangles.

namespace shapespace::internal {

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double kRadians = kPi / 180;  ///< radians in a degree
inline constexpr double kDegrees = 180 / kPi;  ///< degrees in a radian

/// The normal of the triangle (a, b, c), with twice the area as length; seen from the side to which
/// it points, the corners are counterclockwise.
inline Eigen::Vector3d AreaNormal(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                  const Eigen::Vector3d& c) {
  return (b - a).cross(c - a);
}

/// The same for a triangle of a mesh: three indices of columns of `shape`.
template <typename Triangle>
Eigen::Vector3d AreaNormal(const Shape& shape, const Triangle& triangle) {
  return AreaNormal(shape.col(triangle[0]), shape.col(triangle[1]), shape.col(triangle[2]));
}

inline double TriangleArea(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                           const Eigen::Vector3d& c) {
  return 0.5 * AreaNormal(a, b, c).norm();
}

template <typename Triangle>
double TriangleArea(const Shape& shape, const Triangle& triangle) {
  return 0.5 * AreaNormal(shape, triangle).norm();
}

/// The unit normal for triangles of any size; zero for triangles without area.
inline Eigen::Vector3d UnitNormal(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                                  const Eigen::Vector3d& c) {
  return AreaNormal(a, b, c).stableNormalized();
}

template <typename Triangle>
Eigen::Vector3d UnitNormal(const Shape& shape, const Triangle& triangle) {
  return AreaNormal(shape, triangle).stableNormalized();
}

/// The square of the length below which an edge is too short for its relative change to mean
/// anything: a thousandth of the root mean square length. `squared_lengths` are those of all edges.
inline double SquaredShortest(const Eigen::VectorXd& squared_lengths) {
  constexpr double kShare = 1e-3;
  return kShare * kShare * squared_lengths.mean();
}

/// A smooth step: 0 for x <= 0, 1 for x >= 1, and between them the polynomial of degree 5 whose
/// first two derivatives vanish at both ends. Its steepest slope is `kSteepestStep`.
inline double SmoothStep(double x) {
  x = std::clamp(x, 0.0, 1.0);
  return x * x * x * (10 + x * (6 * x - 15));
}
inline constexpr double kSteepestStep = 15.0 / 8;

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MESH_INTERNAL_GEOMETRY_H_
