#include <shapespace/bodies/catenoid.h>

#include <cmath>
#include <utility>

#include <shapespace/bodies/detail/bend.h>
#include <shapespace/bodies/detail/checks.h>
#include <shapespace/bodies/detail/grid.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace {

ShapeFamily MakeCatenoid(double half_height, int around, int along) {
  internal::CheckLength("half_height", half_height);
  // The rim's radius is cosh(half_height).
  if (half_height > 20)
    throw InvalidOptions("half_height", "above 20, in units of the waist radius");
  internal::CheckCount("around", around, 3);
  internal::CheckCount("along", along, 1);
  internal::CheckTriangles(2 * std::int64_t{around} * along);

  const auto node = [along](int i, int j) { return i * (along + 1) + j; };
  internal::TriangleList triangles;
  internal::AddGrid(around, along, node, &triangles);
  const int num_vertices = node(around, along) + 1;

  ShapeFamily body;
  body.name = "catenoid";
  body.connectivity = internal::ConnectivityOf(num_vertices, triangles);
  body.parameter = "angle of association, degrees";
  body.end = 90;
  // With w = u + i v the catenoid is the real part of (cos w, sin w, -i w), the helicoid its
  // imaginary part; the associated surfaces interpolate between them.
  body.pose = [=](double angle) {
    const double real = std::cos(angle * internal::kRadians),
                 imaginary = std::sin(angle * internal::kRadians);
    Shape shape(3, num_vertices);
    for (int i = 0; i <= around; ++i) {
      const double u = internal::kPi * (2.0 * i / around - 1);
      for (int j = 0; j <= along; ++j) {
        const double v = half_height * (2.0 * j / along - 1);
        const Eigen::Vector3d catenoid(std::cosh(v) * std::cos(u), std::cosh(v) * std::sin(u), v);
        const Eigen::Vector3d helicoid(-std::sinh(v) * std::sin(u), std::sinh(v) * std::cos(u), -u);
        shape.col(node(i, j)) = real * catenoid + imaginary * helicoid;
      }
    }
    return shape;
  };
  return internal::WithCheckedRange(std::move(body));
}

}  // namespace shapespace
