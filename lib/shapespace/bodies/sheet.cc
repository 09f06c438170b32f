#include <shapespace/bodies/sheet.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <shapespace/bodies/detail/bend.h>
#include <shapespace/bodies/detail/checks.h>
#include <shapespace/bodies/detail/grid.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace {

ShapeFamily MakeSheet(double length, double width, int nx, int ny) {
  internal::CheckLength("length", length);
  internal::CheckLength("width", width);
  internal::CheckCount("nx", nx, 1);
  internal::CheckCount("ny", ny, 1);
  internal::CheckTriangles(2 * std::int64_t{nx} * ny);

  const auto node = [ny](int i, int j) { return i * (ny + 1) + j; };
  internal::TriangleList triangles;
  internal::AddGrid(nx, ny, node, &triangles);
  Shape rest(3, node(nx, ny) + 1);
  for (int i = 0; i <= nx; ++i) {
    for (int j = 0; j <= ny; ++j) {
      rest.col(node(i, j)) << length * (double(i) / nx - 0.5), width * (double(j) / ny - 0.5), 0;
    }
  }

  ShapeFamily body;
  body.name = "sheet";
  body.connectivity = internal::ConnectivityOf(static_cast<int>(rest.cols()), triangles);
  body.parameter = "roll angle, degrees";
  body.end = std::min(360.0, 90.0 * nx);
  body.pose = [rest = std::move(rest), length](double angle) {
    Shape shape(3, rest.cols());
    const double curvature = angle * internal::kRadians / length;
    for (int v = 0; v < rest.cols(); ++v) shape.col(v) = internal::Bend(rest.col(v), curvature);
    return shape;
  };
  return internal::WithCheckedRange(std::move(body));
}

// Let the vertices be numbered along the zigzag. In an evenly folded strip, each vertex results
// from the one before by a rotation by `step` about one axis, parallel to y, and a change of sides.
// A triangle's base, two steps long, subtends 2 step at that axis; its height leans inwards by
// (side / 2) tan(step / 2). With t = tan(step / 2) and k = (side / (2 width))^2 the normals of
// neighbours give
//   cos(hinge) = (1 - (1 + 2 k) t^2) / (1 + t^2),  so  sin(hinge / 2)^2 = (1 + k) t^2 / (1 + t^2).
// Both directions of this equation are used below.
ShapeFamily MakeStrip(double side, double width, int triangles) {
  internal::CheckLength("side", side);
  internal::CheckLength("width", width);
  if (side > 1e4 * width) throw InvalidOptions("side", "must be at most 10000 times the width");
  internal::CheckCount("triangles", triangles, 2);
  internal::CheckTriangles(triangles);

  internal::TriangleList list;
  for (int f = 0; f < triangles; ++f) {
    list.push_back(f % 2 == 0 ? Eigen::Vector3i(f, f + 1, f + 2)
                              : Eigen::Vector3i(f + 1, f, f + 2));
  }
  const int num_vertices = triangles + 2;
  const double k = std::pow(side / (2 * width), 2);

  // Two or three triangles cannot form a ring; their range ends as for four. Narrow strips, whose
  // hinges are nearly along x, stop before a hinge is closed, which happens at k t^2 = 1.
  const double t_end =
      std::min(std::tan(internal::kPi / std::max(4, triangles)), std::sqrt(0.9 / k));
  const double sin_half_end = std::sqrt((1 + k) / (1 + t_end * t_end)) * t_end;

  ShapeFamily body;
  body.name = "strip";
  body.connectivity = internal::ConnectivityOf(num_vertices, list);
  body.parameter = "hinge angle, degrees";
  body.isometric = true;
  body.end = 2 * std::asin(sin_half_end) / internal::kRadians;
  body.pose = [=](double angle) {
    const double hinge = angle * internal::kRadians;
    const double sin_half = std::sin(hinge / 2);
    const double t = sin_half / std::sqrt(1 + k - sin_half * sin_half);
    const double step = 2 * std::atan(t);
    const double curvature = 2 * std::sin(step) / side;
    const double spacing = side / (2 * internal::Sinc(step));  // of the vertices, along the arc
    const double height = width * std::sqrt(1 - k * t * t);
    Shape shape(3, num_vertices);
    for (int v = 0; v < num_vertices; ++v) {
      const double along = (v - (num_vertices - 1) / 2.0) * spacing;
      shape.col(v) = internal::Bend({along, v % 2 == 0 ? height / 2 : -height / 2, 0}, curvature);
    }
    return shape;
  };
  return internal::WithCheckedRange(std::move(body));
}

}  // namespace shapespace
