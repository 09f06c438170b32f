#include <shapespace/mesh/surface.h>

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/bodies/quadruped.h>
#include <shapespace/bodies/sheet.h>

namespace shapespace {
namespace {

using Eigen::Vector3d;

// Points in and around the body's box.
Shape PointsAround(const Shape& shape, int count) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(-0.3, 1.3);
  const Vector3d low = shape.rowwise().minCoeff();
  const Vector3d size = shape.rowwise().maxCoeff() - low;
  Shape points(3, count);
  for (int i = 0; i < count; ++i) {
    points.col(i) = low + size.cwiseProduct(Vector3d(share(random), share(random), share(random)));
  }
  return points;
}

// An upper bound of the least distance by brute force: a fine grid of points of every triangle. It
// is accurate to the grid's width.
double LeastOnGrids(const Connectivity& connectivity, const Shape& shape, const Vector3d& point) {
  constexpr int kGrid = 12;
  double least = std::numeric_limits<double>::infinity();
  for (const auto& t : connectivity.Triangles().colwise()) {
    for (int i = 0; i <= kGrid; ++i) {
      for (int j = 0; i + j <= kGrid; ++j) {
        const Vector3d on =
            (i * shape.col(t(0)) + j * shape.col(t(1)) + (kGrid - i - j) * shape.col(t(2))) / kGrid;
        least = std::min(least, (on - point).norm());
      }
    }
  }
  return least;
}

TEST(MeshSurface, FindsTheNearestPoint) {
  const SkinnedBody body = MakeQuadruped(600);
  const Shape shape = body.pose("stand");
  const MeshSurface surface(body.connectivity, shape);
  const Shape points = PointsAround(shape, 60);
  for (const auto& point : points.colwise()) {
    const ClosestPoint foot = surface.Nearest(point);
    ASSERT_GE(foot.triangle, 0);
    EXPECT_GE(foot.barycentric.minCoeff(), 0);
    EXPECT_NEAR(foot.barycentric.sum(), 1, 1e-12);
    Vector3d on = Vector3d::Zero();
    for (int k = 0; k < 3; ++k) {
      on += foot.barycentric(k) * shape.col(body.connectivity->Triangles()(k, foot.triangle));
    }
    EXPECT_LT((on - foot.point).norm(), 1e-12);
    EXPECT_NEAR(foot.distance, (foot.point - point).norm(), 1e-12);
    const double least = LeastOnGrids(*body.connectivity, shape, point);
    EXPECT_LE(foot.distance, least + 1e-12);
    EXPECT_GT(foot.distance, least - 0.03);
  }
}

// Embree's single precision alone would have errors of a hundred times the body's size here.
TEST(MeshSurface, FindsTheSamePointsFarFromTheOrigin) {
  const SkinnedBody body = MakeQuadruped(600);
  const Shape shape = body.pose("stand");
  const Vector3d far(1e8, -2e8, 3e8);
  const MeshSurface surface(body.connectivity, shape),
      moved(body.connectivity, shape.colwise() + far);
  const Shape points = PointsAround(shape, 60);
  for (const auto& point : points.colwise()) {
    const ClosestPoint here = surface.Nearest(point), there = moved.Nearest(point + far);
    EXPECT_LT((here.point + far - there.point).norm(), 1e-6);
    EXPECT_NEAR(here.distance, there.distance, 1e-6);
  }
}

TEST(MeshSurface, LooksNoFartherThanAsked) {
  const SkinnedBody body = MakeQuadruped(600);
  const Shape shape = body.pose("stand");
  const MeshSurface surface(body.connectivity, shape);
  const Shape points = PointsAround(shape, 60);
  for (const auto& point : points.colwise()) {
    const ClosestPoint foot = surface.Nearest(point);
    const ClosestPoint same = surface.Nearest(point, nullptr, 1.0001 * foot.distance);
    EXPECT_EQ(same.triangle, foot.triangle);
    EXPECT_EQ(same.distance, foot.distance);
    EXPECT_EQ(surface.Nearest(point, nullptr, 0.9999 * foot.distance).triangle, -1);
  }
}

// A query that admits one triangle only passes over no other. The nearest of these results is what
// a query of all finds, also if it looks exactly so far: of points that are close to corners, by
// any share of the body's size, and of points that are far away. Embree alone would round
// coordinates.
TEST(MeshSurface, FindsWhatQueriesOfSingleTrianglesFindNearAndFar) {
  const ShapeFamily sheet = MakeSheet(2, 1, 6, 4);
  std::mt19937 random(7);
  std::uniform_real_distribution<double> exponent(-12, 8), coordinate(-1, 1);
  for (const double angle : {0, 20, 60, 140}) {
    const Shape shape = sheet.pose(angle);
    const MeshSurface surface(sheet.connectivity, shape);
    for (int i = 0; i < 200; ++i) {
      const Vector3d way(coordinate(random), coordinate(random), coordinate(random));
      const Vector3d point = shape.col(i % shape.cols()) + std::pow(10, exponent(random)) * way;
      ClosestPoint nearest;
      for (int f = 0; f < sheet.connectivity->NumTriangles(); ++f) {
        const ClosestPoint one = surface.Nearest(point, [&](int other) { return other == f; });
        ASSERT_EQ(one.triangle, f);
        if (f == 0 || one.distance < nearest.distance) nearest = one;
      }
      for (const double within : {std::numeric_limits<double>::infinity(), nearest.distance}) {
        const ClosestPoint foot = surface.Nearest(point, nullptr, within);
        EXPECT_EQ(foot.triangle, nearest.triangle) << i << " within " << within;
        EXPECT_EQ(foot.distance, nearest.distance) << i << " within " << within;
      }
      EXPECT_EQ(surface.Nearest(point, nullptr, std::nextafter(nearest.distance, 0)).triangle, -1);
    }
  }
}

TEST(MeshSurface, AsksOnlyTrianglesThatAreAdmitted) {
  const SkinnedBody body = MakeQuadruped(600);
  const Shape shape = body.pose("stand");
  const MeshSurface surface(body.connectivity, shape);
  const auto upwards = [&](int f) { return surface.GetTriangleNormals()(1, f) > 0.5; };
  const Shape points = PointsAround(shape, 60);
  for (const auto& point : points.colwise()) {
    const ClosestPoint any = surface.Nearest(point), up = surface.Nearest(point, upwards);
    ASSERT_GE(up.triangle, 0);
    EXPECT_TRUE(upwards(up.triangle));
    EXPECT_GE(up.distance, any.distance);
  }
  EXPECT_EQ(surface.Nearest(shape.col(0), [](int) { return false; }).triangle, -1);
}

TEST(MeshSurface, PointsOfCornersSidesAndTheInsideAreFoundExactly) {
  // The first triangle is none and would be nearer; the third one has the side between vertices 1
  // and 2 in common with the second.
  Shape shape(3, 5);
  shape << 0, 4, 0, 4, 9,  //
      0, 0, 3, 3, 9,       //
      1, 1, 1, 1, 9;
  Eigen::Matrix3Xi triangles(3, 3);
  triangles << 4, 0, 1,  //
      4, 1, 3,           //
      3, 2, 2;
  const auto connectivity = Connectivity::FromTriangles(5, triangles);
  const MeshSurface surface(connectivity, shape);
  EXPECT_EQ(&surface.GetConnectivity(), connectivity.get());
  EXPECT_EQ(surface.GetShape(), shape);
  Shape normals(3, 3);
  normals << 0, 0, 0, 0, 0, 0, 0, 1, 1;
  EXPECT_EQ(surface.GetTriangleNormals(), normals);
  const auto expect = [&](const Vector3d& point, int triangle, const Vector3d& barycentric,
                          const Vector3d& foot, double distance) {
    const ClosestPoint found =
        surface.Nearest(point, [&](int f) { return triangle == 2 || f < 2; });
    EXPECT_EQ(found.triangle, triangle) << point.transpose();
    EXPECT_LT((found.barycentric - barycentric).norm(), 1e-12) << point.transpose();
    EXPECT_LT((found.point - foot).norm(), 1e-12) << point.transpose();
    EXPECT_NEAR(found.distance, distance, 1e-12) << point.transpose();
  };
  expect({-2, -1, 3}, 1, {1, 0, 0}, {0, 0, 1}, 3);
  expect({6, -1, 3}, 1, {0, 1, 0}, {4, 0, 1}, 3);
  expect({-2, 4, -1}, 1, {0, 0, 1}, {0, 3, 1}, 3);
  expect({1, -3, 5}, 1, {0.75, 0.25, 0}, {1, 0, 1}, 5);
  expect({-3, 2, 5}, 1, {1 / 3.0, 0, 2 / 3.0}, {0, 2, 1}, 5);
  // From the point a quarter of the side's way, perpendicular to it by 5, and by 12 upwards.
  expect({3 + 3, 0.75 + 4, 13}, 1, {0, 0.75, 0.25}, {3, 0.75, 1}, 13);
  expect({1, 0.75, -6}, 1, {0.5, 0.25, 0.25}, {1, 0.75, 1}, 7);
  expect({5, 5, 1}, 2, {0, 1, 0}, {4, 3, 1}, std::sqrt(5));
  // The first of two triangles that are equally far.
  EXPECT_EQ(surface.Nearest({2, 1.5, 8}).triangle, 1);
  EXPECT_EQ(surface.Nearest({9, 9, 9}).triangle, 2);
}

// Distances to a triangle whose height is rounding are at most those to its corners and to points
// of its sides.
TEST(MeshSurface, PointsOfSliversAreInThemAndNoPointOfASideIsNearer) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto point = [&] {
    const double x = uniform(random), y = uniform(random);
    return Vector3d(x, y, uniform(random));
  };
  const auto connectivity = Connectivity::FromTriangles(3, Eigen::Vector3i(0, 1, 2));
  for (const double height : {1e-4, 1e-6, 1e-8, 1e-10, 1e-14, 0.}) {
    for (int i = 0; i < 100; ++i) {
      Shape shape(3, 3);
      shape.col(0) = point();
      shape.col(1) = point();
      const Vector3d way = shape.col(1) - shape.col(0);
      shape.col(2) = shape.col(0) + std::abs(uniform(random)) * way + height * point();
      const MeshSurface surface(connectivity, shape);
      if (surface.GetTriangleNormals().isZero(0)) continue;
      for (int k = 0; k < 50; ++k) {
        const double share = 0.5 + 0.5 * uniform(random);
        const Vector3d on_side = shape.col(0) + share * way;
        const Vector3d from = on_side + std::pow(10., 4 * uniform(random) - 4) * point();
        const ClosestPoint foot = surface.Nearest(from);
        ASSERT_EQ(foot.triangle, 0);
        EXPECT_GE(foot.barycentric.minCoeff(), 0);
        EXPECT_NEAR(foot.barycentric.sum(), 1, 1e-15);
        EXPECT_LE(foot.distance, (on_side - from).norm() + 1e-14);
      }
    }
  }
}

TEST(MeshSurface, NormalsOfVerticesWeighTrianglesByArea) {
  Shape shape(3, 5);
  shape << 0, 2, 0, 0, 7,  //
      0, 0, 4, 0, 7,       //
      0, 0, 0, 6, 7;
  Eigen::Matrix3Xi triangles(3, 3);
  triangles << 0, 0, 0,  //
      2, 3, 1,           //
      1, 2, 3;
  const auto connectivity = Connectivity::FromTriangles(5, triangles);
  Shape each(3, 3);  // of areas 4, 12 and 6
  each << 0, -1, 0,  //
      0, 0, -1,      //
      -1, 0, 0;
  EXPECT_LT((TriangleNormals(*connectivity, shape) - each).norm(), 1e-12);
  Shape vertices(3, 5);
  vertices << -6 / 7.0, 0, -3 / std::sqrt(10), -2 / std::sqrt(5), 0,  //
      -3 / 7.0, -3 / std::sqrt(13), 0, -1 / std::sqrt(5), 0,          //
      -2 / 7.0, -2 / std::sqrt(13), -1 / std::sqrt(10), 0, 0;
  EXPECT_LT((VertexNormals(*connectivity, shape) - vertices).norm(), 1e-12);
}

}  // namespace
}  // namespace shapespace
