#include <shapespace/bodies/bricard.h>

#include <cmath>
#include <utility>

#include <shapespace/bodies/detail/bend.h>
#include <shapespace/bodies/detail/checks.h>
#include <shapespace/bodies/detail/grid.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace {
namespace {

// Edge lengths, chosen such that no vertex of the plane of symmetry comes near the axis within the
// range of the angle (this would happen at -42 and 58 degrees), and that every hinge moves by more
// than 30 degrees.
constexpr double kEdge02 = 2, kEdge03 = 3;
constexpr double kEdge04 = 2.5, kEdge24 = 2.2;
constexpr double kEdge05 = 3, kEdge25 = 2.6;

// Vertices 0 .. 3 lie in the plane z = 0, at (0, a), (0, -a), (d, b), (d, -b); with the edge from 0
// to 2 at the angle `angle` to the x axis,
//   a - b = kEdge02 sin(angle),  d = kEdge02 cos(angle),  (a + b)^2 + d^2 = kEdge03^2.
// A vertex in the plane of symmetry is the intersection of two circles, about (0, 0) and (d, 0).
Shape BricardPose(double angle) {
  const double d = kEdge02 * std::cos(angle);
  const double difference = kEdge02 * std::sin(angle);
  const double sum = std::sqrt(kEdge03 * kEdge03 - d * d);
  const double a = (sum + difference) / 2;
  const double b = (sum - difference) / 2;
  const auto in_plane = [=](double to_0, double to_2, double sign) {
    const double squared_0 = to_0 * to_0 - a * a;
    const double squared_2 = to_2 * to_2 - b * b;
    const double x = (d * d + squared_0 - squared_2) / (2 * d);
    return Eigen::Vector3d(x, 0, sign * std::sqrt(squared_0 - x * x));
  };
  Shape shape(3, 6);
  shape << Eigen::Vector3d(0, a, 0), Eigen::Vector3d(0, -a, 0), Eigen::Vector3d(d, b, 0),
      Eigen::Vector3d(d, -b, 0), in_plane(kEdge04, kEdge24, 1), in_plane(kEdge05, kEdge25, -1);
  return shape;
}

}  // namespace

ShapeFamily MakeBricard() {
  const internal::TriangleList triangles = {{0, 4, 2}, {2, 4, 1}, {1, 4, 3}, {3, 4, 0},
                                            {2, 5, 0}, {1, 5, 2}, {3, 5, 1}, {0, 5, 3}};
  ShapeFamily body;
  body.name = "bricard";
  body.connectivity = internal::ConnectivityOf(6, triangles);
  body.parameter = "angle of edge 0-2 to the plane of symmetry, degrees";
  body.isometric = true;
  body.begin = -35;
  body.end = 50;
  body.pose = [](double angle) { return BricardPose(angle * internal::kRadians); };
  return internal::WithCheckedRange(std::move(body));
}

}  // namespace shapespace
