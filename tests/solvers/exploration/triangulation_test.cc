#include <shapespace/exploration/triangulation.h>

#include <cmath>
#include <limits>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <Eigen/LU>

#include <shapespace/base/error.h>

namespace shapespace {
namespace {

double Area(const Eigen::Matrix2Xd& points, const Eigen::Vector3i& t) {
  const Eigen::Vector2d a = points.col(t(0)), b = points.col(t(1)) - a, c = points.col(t(2)) - a;
  return (b.x() * c.y() - b.y() * c.x()) / 2;
}

// Positive if `p` lies inside the circle through a, b, c, which run counterclockwise.
double InCircle(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Eigen::Vector2d& c,
                const Eigen::Vector2d& p) {
  Eigen::Matrix3d m;
  int row = 0;
  for (const Eigen::Vector2d& v : {a, b, c}) {
    m.row(row++) << v.x() - p.x(), v.y() - p.y(), (v - p).squaredNorm();
  }
  return m.determinant();
}

Eigen::Matrix2Xd RandomPoints(int count) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(0, 1);
  return Eigen::Matrix2Xd::NullaryExpr(2, count, [&] { return uniform(random); });
}

TEST(TriangulationTest, NoPointLiesInsideACircleThroughATrianglesCorners) {
  Eigen::Matrix2Xd points = RandomPoints(40);
  points.leftCols<4>() << 0, 1, 1, 0, 0, 0, 1, 1;  // the hull is the unit square
  const Triangulation triangulation = DelaunayTriangulation(points);
  double area = 0;
  for (int t = 0; t < triangulation.triangles.cols(); ++t) {
    const Eigen::Vector3i v = triangulation.triangles.col(t);
    EXPECT_GT(Area(points, v), 0);
    area += Area(points, v);
    for (int p = 0; p < points.cols(); ++p) {
      EXPECT_LT(InCircle(points.col(v(0)), points.col(v(1)), points.col(v(2)), points.col(p)),
                1e-12);
    }
  }
  EXPECT_NEAR(area, 1, 1e-12);
  EXPECT_EQ(triangulation.segments.cols(), 0);
  EXPECT_TRUE(triangulation.left_out.empty());
}

TEST(TriangulationTest, FourPointsOfACircleAreTwoTriangles) {
  Eigen::Matrix2Xd square(2, 4);
  square << 0, 1, 1, 0, 0, 0, 1, 1;
  for (double scale : {1e-100, 1e-6, 1.0, 1e6, 1e100}) {
    const Triangulation triangulation = DelaunayTriangulation(scale * square);
    ASSERT_EQ(triangulation.triangles.cols(), 2);
    EXPECT_NEAR(Area(scale * square, triangulation.triangles.col(0)), scale * scale / 2,
                1e-9 * scale * scale);
  }
}

TEST(TriangulationTest, ThreePointsAreATriangle) {
  Eigen::Matrix2Xd points(2, 3);
  points << 0, 0, 1, 0, 1, 0;  // clockwise
  const Triangulation triangulation = DelaunayTriangulation(points);
  ASSERT_EQ(triangulation.triangles.cols(), 1);
  EXPECT_GT(Area(points, triangulation.triangles.col(0)), 0);
}

TEST(TriangulationTest, PointsOfALineAreJoinedInTheirOrder) {
  Eigen::Matrix2Xd points(2, 4);
  points << 0, 3, 1, 2, 0, 3.001, 1, 2;
  const Triangulation triangulation = DelaunayTriangulation(points);
  EXPECT_EQ(triangulation.triangles.cols(), 0);
  ASSERT_EQ(triangulation.segments.cols(), 3);
  std::vector<int> order = {triangulation.segments(0, 0)};
  for (int s = 0; s < 3; ++s) {
    EXPECT_EQ(triangulation.segments(0, s), order.back());
    order.push_back(triangulation.segments(1, s));
  }
  if (order.front() == 1) std::reverse(order.begin(), order.end());
  EXPECT_EQ(order, (std::vector<int>{0, 2, 3, 1}));
}

TEST(TriangulationTest, TwoPointsAreASegment) {
  EXPECT_EQ(DelaunayTriangulation(RandomPoints(2)).segments.cols(), 1);
}

TEST(TriangulationTest, ACopyOfAPointIsLeftOut) {
  Eigen::Matrix2Xd points = RandomPoints(6);
  points.col(4) = points.col(1);
  const Triangulation triangulation = DelaunayTriangulation(points);
  EXPECT_EQ(triangulation.left_out, std::vector<int>{4});
  std::set<int> corners(triangulation.triangles.data(),
                        triangulation.triangles.data() + triangulation.triangles.size());
  EXPECT_EQ(corners, (std::set<int>{0, 1, 2, 3, 5}));
}

TEST(TriangulationTest, PointsThatAreVeryNearAreBothKept) {
  for (const double scale : {1e-6, 1.0, 1e6}) {
    Eigen::Matrix2Xd points = scale * RandomPoints(6);
    points.col(4) = points.col(1) + Eigen::Vector2d(1e-7 * scale, 0);
    const Triangulation triangulation = DelaunayTriangulation(points);
    EXPECT_TRUE(triangulation.left_out.empty()) << scale;
    EXPECT_GT((triangulation.triangles.array() == 1).count(), 0);
    EXPECT_GT((triangulation.triangles.array() == 4).count(), 0);
    points(0, 4) = points(0, 1) + 1e-11 * scale;
    EXPECT_EQ(DelaunayTriangulation(points).left_out, std::vector<int>{4}) << scale;
  }
}

TEST(TriangulationTest, WhatHasNoExtentIsRefused) {
  EXPECT_THROW(DelaunayTriangulation(Eigen::Matrix2Xd::Zero(2, 3)), InvalidOptions);
  EXPECT_THROW(DelaunayTriangulation(Eigen::Matrix2Xd(2, 0)), InvalidOptions);
  Eigen::Matrix2Xd points = RandomPoints(3);
  points(0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_THROW(DelaunayTriangulation(points), InvalidOptions);
}

}  // namespace
}  // namespace shapespace
