#include <shapespace/bodies/miura.h>

#include <cmath>
#include <utility>
#include <vector>

#include <shapespace/bodies/detail/bend.h>
#include <shapespace/bodies/detail/checks.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace {

ShapeFamily MakeMiura(double a, double b, double corner, int nx, int ny) {
  internal::CheckLength("a", a);
  internal::CheckLength("b", b);
  if (!(corner >= 10 && corner <= 80))
    throw InvalidOptions("corner", "must be in [10, 80] degrees");
  internal::CheckCount("nx", nx, 1);
  internal::CheckCount("ny", ny, 1);
  internal::CheckTriangles(2 * std::int64_t{nx} * ny);

  std::vector<int> begin = {0}, corners;
  for (int i = 0; i < nx; ++i) {
    for (int j = 0; j < ny; ++j) {
      const int first = i * (ny + 1) + j, next = first + ny + 1;
      corners.insert(corners.end(), {first, next, next + 1, first + 1});
      begin.push_back(static_cast<int>(corners.size()));
    }
  }
  ShapeFamily body;
  body.name = "miura";
  body.connectivity = Connectivity::Make((nx + 1) * (ny + 1), begin, corners);
  body.parameter = "fold angle, degrees";
  body.isometric = true;
  body.end = 85;
  body.pose = [=](double angle) {
    const double cosine = std::cos(angle * internal::kRadians),
                 sine = std::sin(angle * internal::kRadians);
    const double tangent = cosine * std::tan(corner * internal::kRadians);
    const double lift = sine * std::sin(corner * internal::kRadians);
    const double zigzag = b / std::sqrt(1 + tangent * tangent);
    const double along_x = zigzag * tangent;
    const double along_y = a * std::sqrt(1 - lift * lift);
    Shape shape(3, (nx + 1) * (ny + 1));
    for (int i = 0; i <= nx; ++i) {
      for (int j = 0; j <= ny; ++j) {
        shape.col(i * (ny + 1) + j) << i * along_x, j * along_y + i % 2 * zigzag, j % 2 * a * lift;
      }
    }
    return shape;
  };
  return internal::WithCheckedRange(std::move(body));
}

}  // namespace shapespace
