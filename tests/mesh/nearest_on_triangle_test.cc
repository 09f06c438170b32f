#include <shapespace/mesh/internal/nearest_on_triangle.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

namespace shapespace::internal {
namespace {

using Eigen::Vector3d;
using Corners = Eigen::Matrix3d;
using Long = Eigen::Matrix<long double, 3, 1>;

constexpr double kRelativeHeights[] = {1, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 0};

Vector3d Normal(std::mt19937* random) {
  std::normal_distribution<double> normal;
  const double x = normal(*random), y = normal(*random);
  return {x, y, normal(*random)};
}

// Seen from the origin: a triangle whose third corner is off the line of the others by the height,
// in any order. In every second one it is near one of the others (a needle), else between them, and
// in two of three the origin is near a point of the triangle, by any share of its size.
Corners Sliver(double height, int i, std::mt19937* random) {
  std::uniform_real_distribution<double> uniform(0, 1);
  const Vector3d a = Normal(random), b = Normal(random);
  const double share = i % 2 == 0 ? uniform(*random) : i % 4 / 2;
  const Vector3d c = a + share * (b - a) + height * Normal(random);
  Corners corners;
  corners.col(i % 3) = a;
  corners.col((i + 1) % 3) = b;
  corners.col((i + 2) % 3) = c;
  if (i % 5 > 1) {
    Vector3d weights(uniform(*random), uniform(*random), uniform(*random));
    weights /= weights.sum();
    const double off = std::pow(10., -14 * uniform(*random));
    corners.colwise() -= corners * weights + off * Normal(random);
  }
  return corners;
}

// The least distance of a segment to the origin, in greater precision.
long double ToSegment(const Long& a, const Long& b) {
  const Long side = b - a;
  const long double squared = side.squaredNorm();
  const long double t = squared > 0 ? -a.dot(side) / squared : 0;
  return (a + std::clamp(t, 0.0L, 1.0L) * side).norm();
}

// Of segments from the third corner to points of the side that is opposite: the least distance by
// nested intervals, because it is a convex function of the point.
long double ToTriangle(const Corners& corners) {
  const Eigen::Matrix<long double, 3, 3> exact = corners.cast<long double>();
  const auto to_fan = [&](long double t) {
    return ToSegment(exact.col(2), (1 - t) * exact.col(0) + t * exact.col(1));
  };
  long double low = 0, high = 1;
  for (int i = 0; i < 200; ++i) {
    const long double third = (high - low) / 3;
    if (to_fan(low + third) < to_fan(high - third)) {
      high -= third;
    } else {
      low += third;
    }
  }
  return std::min({to_fan(low), ToSegment(exact.col(0), exact.col(1)), to_fan(0), to_fan(1)});
}

Vector3d Nearest(const Corners& corners) {
  return NearestOnTriangle(corners.col(0), corners.col(1), corners.col(2));
}

TEST(NearestOnTriangleTest, IsExactForSliversNeedlesAndSegments) {
  std::mt19937 random(1);
  for (const double height : kRelativeHeights) {
    for (int i = 0; i < 2000; ++i) {
      const Corners corners = Sliver(height, i, &random);
      const Vector3d nearest = Nearest(corners);
      EXPECT_GE(nearest.minCoeff(), 0);
      EXPECT_LE(nearest.maxCoeff(), 1);
      EXPECT_NEAR(nearest.sum(), 1, 1e-15);
      const double size = corners.colwise().norm().maxCoeff();
      EXPECT_NEAR((corners * nearest).norm(), static_cast<double>(ToTriangle(corners)),
                  1e-14 * size)
          << "height " << height << ", triangle\n"
          << corners;
    }
  }
}

TEST(NearestOnTriangleTest, CornersThatCoincideAreSegmentsAndPoints) {
  const Vector3d a(1, -1, 2), b(1, 3, 2), far(0, 0, 7);
  EXPECT_EQ(NearestOnTriangle(a, a, a).sum(), 1);
  for (const Vector3d& other : {a, b}) {
    const Vector3d nearest = NearestOnTriangle(a, b, other);
    EXPECT_NEAR((nearest(0) * a + nearest(1) * b + nearest(2) * other).norm(), std::sqrt(5.), 1e-15);
  }
  EXPECT_EQ(NearestOnTriangle(far, far, a), Vector3d(0, 0, 1));
}

TEST(NearestOnTriangleTest, SizesOfTrianglesDoNotMatter) {
  std::mt19937 random(2);
  for (int i = 0; i < 200; ++i) {
    const Corners corners = Sliver(kRelativeHeights[i % 10], i, &random);
    const Vector3d nearest = Nearest(corners);
    for (const int power : {-400, -60, 60, 400}) {
      EXPECT_EQ(Nearest(std::ldexp(1., power) * corners), nearest) << power;
    }
  }
}

}  // namespace
}  // namespace shapespace::internal
