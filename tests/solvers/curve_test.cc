// Curves of segments: straight-line graphs, and hairs on a surface.
#include <cmath>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/geodesic/geodesic.h>

namespace shapespace {
namespace {

std::shared_ptr<const Connectivity> CurveOf(int n) {
  std::vector<std::pair<int, int>> segments;
  for (int v = 0; v + 1 < n; ++v) segments.emplace_back(v, v + 1);
  return Connectivity::Make(n, {0}, {}, segments);
}

/// Of length 1, curved by `angle` and rising by `rise`; straight for angle 0.
Shape Helix(int n, double angle, double rise) {
  Shape shape = Shape::Zero(3, n);
  for (int v = 0; v < n; ++v) {
    const double at = static_cast<double>(v) / (n - 1);
    if (angle == 0) {
      shape(0, v) = at;
    } else {
      const double radius = std::sqrt(1 - rise * rise) / angle;
      shape.col(v) << radius * std::sin(angle * at), radius * (1 - std::cos(angle * at)), rise * at;
    }
  }
  return shape;
}

double TurnAt(const Shape& shape, int v) {
  const Eigen::Vector3d to = shape.col(v) - shape.col(v - 1), on = shape.col(v + 1) - shape.col(v);
  return std::atan2(to.cross(on).norm(), to.dot(on));
}

// An even curve stays even, and bends at a constant rate.
TEST(Curves, BendEvenlyAndDoNotCrumple) {
  const int n = 31;
  for (const auto& [from, to, rise] :
       {std::make_tuple(0., 2., 0.), {0., 4.5, 0.}, {1., 4., 0.3}, {0., 5., 0.2}}) {
    SCOPED_TRACE(std::to_string(from) + " to " + std::to_string(to));
    const Shape straight = Helix(n, from, from > 0 ? rise : 0), bent = Helix(n, to, rise);
    const GeodesicResult result = Interpolate(CurveOf(n), {straight, bent});
    EXPECT_TRUE(result.path.converged);
    EXPECT_LT(result.summary.Ratio(), 1.05);
    const Path& path = result.path;
    for (int i = 1; i + 1 < path.NumShapes(); ++i) {
      const Shape shape = path.Placed(i);
      const double t = path.parameters[i];
      for (int v = 1; v + 1 < n; ++v) {
        const double expected = (1 - t) * TurnAt(straight, v) + t * TurnAt(bent, v);
        EXPECT_NEAR(TurnAt(shape, v), expected, 0.1 * TurnAt(bent, v)) << i << ", " << v;
      }
    }
  }
}

}  // namespace
}  // namespace shapespace
