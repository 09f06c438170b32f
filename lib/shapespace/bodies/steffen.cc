#include <shapespace/bodies/steffen.h>

#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include <shapespace/bodies/detail/bend.h>
#include <shapespace/bodies/detail/checks.h>
#include <shapespace/bodies/detail/grid.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace {
namespace {

/// The point at the given distances from a, b and c, on the side of their plane from which they
/// are seen counterclockwise.
Eigen::Vector3d Trilaterate(const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                            const Eigen::Vector3d& c, double to_a, double to_b, double to_c) {
  const Eigen::Vector3d u = (b - a).normalized();
  const double cu = u.dot(c - a);
  const Eigen::Vector3d v = (c - a - cu * u).normalized();
  const double bu = (b - a).norm(), cv = v.dot(c - a);
  const double x = (to_a * to_a - to_b * to_b + bu * bu) / (2 * bu);
  const double y = (to_a * to_a - to_c * to_c + cu * cu + cv * cv - 2 * cu * x) / (2 * cv);
  return a + x * u + y * v + std::sqrt(to_a * to_a - x * x - y * y) * u.cross(v);
}

// Vertices 2 and 3 are not connected by an edge, but their distance is 11 in every pose: each half
// of the polyhedron between them and vertex 8 is a flexible octahedron of Bricard's without two of
// its faces, whose common edge is 2-3. So 0 to 3 form a rigid tetrahedron, about which the rest
// moves. The condition for the octahedra to be flexible also implies that edges 4-6 and 5-7, which
// are not used here, have length 11.
Shape SteffenPose(double angle) {
  const double height = std::sqrt(12 * 12 - 8.5 * 8.5 - 5.5 * 5.5);
  const double radius = std::sqrt(10 * 10 - 5.5 * 5.5);
  const Eigen::Vector3d v0(-8.5, 0, 0), v1(8.5, 0, 0), v2(0, 5.5, height), v3(0, -5.5, height);
  const Eigen::Vector3d v8(radius * std::sin(angle), 0, height + radius * std::cos(angle));
  Shape shape(3, 9);
  shape << v0, v1, v2, v3, Trilaterate(v0, v3, v8, 10, 5, 12), Trilaterate(v1, v2, v8, 10, 5, 12),
      Trilaterate(v0, v2, v8, 10, 5, 12), Trilaterate(v1, v3, v8, 10, 5, 12), v8;
  return shape;
}

}  // namespace

ShapeFamily MakeSteffen() {
  const internal::TriangleList triangles = {{0, 1, 3}, {3, 4, 0}, {2, 8, 5}, {6, 0, 4}, {6, 2, 0},
                                            {6, 4, 8}, {7, 3, 1}, {7, 8, 3}, {7, 1, 5}, {8, 4, 3},
                                            {0, 2, 1}, {2, 5, 1}, {7, 5, 8}, {8, 2, 6}};
  ShapeFamily body;
  body.name = "steffen";
  body.connectivity = internal::ConnectivityOf(9, triangles);
  body.parameter = "angle of vertex 8 about the line from 2 to 3, degrees";
  body.isometric = true;
  body.begin = -12.5;
  body.end = 12.5;
  body.pose = [](double angle) { return SteffenPose(angle * internal::kRadians); };
  return internal::WithCheckedRange(std::move(body));
}

}  // namespace shapespace
