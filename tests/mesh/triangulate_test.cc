#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/triangulate.h>

#include "mesh/files.h"

namespace shapespace {
namespace {

/// A polygon in the plane z = 0 whose corners are in cyclic order around the origin, at random
/// distances; with this number of corners it is concave in many places.
Shape RandomPolygon(int corners, unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> radius(0.2, 1.0);
  Shape polygon(3, corners);
  for (int k = 0; k < corners; ++k) {
    const double angle = 2 * M_PI * k / corners, r = radius(random);
    polygon.col(k) << r * std::cos(angle), r * std::sin(angle), 0;
  }
  return polygon;
}

std::vector<int> Counting(int count, int first = 0) {
  std::vector<int> numbers(count);
  std::iota(numbers.begin(), numbers.end(), 0);
  std::rotate(numbers.begin(), numbers.begin() + first, numbers.end());
  return numbers;
}

double SignedArea(const Shape& flat, const Eigen::Vector3i& t) {
  const Eigen::Vector3d a = flat.col(t(0)), b = flat.col(t(1)), c = flat.col(t(2));
  return 0.5 * (b - a).cross(c - a).z();
}

/// Signed area of a polygon in the plane z = 0.
double Area(const Shape& flat) {
  double area = 0;
  for (int k = 0; k < flat.cols(); ++k) {
    const Eigen::Vector3d a = flat.col(k), b = flat.col((k + 1) % flat.cols());
    area += 0.5 * (a.x() * b.y() - a.y() * b.x());
  }
  return area;
}

/// Each triangle by its sorted vertices.
std::set<std::vector<int>> AsSet(const Eigen::Matrix3Xi& triangles) {
  std::set<std::vector<int>> result;
  for (int f = 0; f < triangles.cols(); ++f) {
    std::vector<int> t = {triangles(0, f), triangles(1, f), triangles(2, f)};
    std::sort(t.begin(), t.end());
    result.insert(t);
  }
  return result;
}

TEST(TriangulateTest, ConcavePolygonsAreCoveredOnceAndOnTheRightSide) {
  for (const int corners : {4, 5, 8, 13, 60}) {
    for (unsigned seed = 0; seed < 20; ++seed) {
      const Shape flat = RandomPolygon(corners, seed);
      const Eigen::Matrix3Xi triangles = Triangulate({0, corners}, Counting(corners), {flat});
      ASSERT_EQ(triangles.cols(), corners - 2);
      double sum = 0;
      for (int f = 0; f < triangles.cols(); ++f) {
        const double area = SignedArea(flat, triangles.col(f));
        EXPECT_GT(area, 0) << corners << " corners, seed " << seed;
        sum += area;
      }
      // Areas of the same sign with the polygon's area as their sum cannot overlap.
      EXPECT_NEAR(sum, Area(flat), 1e-12) << corners << " corners, seed " << seed;
    }
  }
}

TEST(TriangulateTest, ThePlaceOrientationAndSizeOfPosesAndTheFirstCornerDoNotMatter) {
  constexpr int kCorners = 11;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Shape flat = RandomPolygon(kCorners, seed);
    const auto wanted = AsSet(Triangulate({0, kCorners}, Counting(kCorners), {flat}));
    const Eigen::Matrix3d turn(
        Eigen::AngleAxisd(0.7 + seed, Eigen::Vector3d(1, 2, 3).normalized()));
    const Shape moved = (1000 * (turn * flat)).colwise() + Eigen::Vector3d(1e6, -2e6, 3e5);
    for (int first = 0; first < kCorners; ++first) {
      const std::vector<int> polygon = Counting(kCorners, first);
      EXPECT_EQ(AsSet(Triangulate({0, kCorners}, polygon, {flat})), wanted) << first;
      EXPECT_EQ(AsSet(Triangulate({0, kCorners}, polygon, {moved})), wanted) << first;
      EXPECT_EQ(AsSet(Triangulate({0, kCorners}, polygon, {flat, moved})), wanted) << first;
    }
  }
}

// Two poses that differ, each turned by itself: the mean is that of polygons that lie alike.
TEST(TriangulateTest, EachOfSeveralPosesMayBeTurned) {
  constexpr int kCorners = 9;
  for (unsigned seed = 0; seed < 20; ++seed) {
    const Shape first = RandomPolygon(kCorners, seed), second = RandomPolygon(kCorners, seed + 100);
    const auto wanted = AsSet(Triangulate({0, kCorners}, Counting(kCorners), {first, second}));
    for (const double angle : {0.5, 1.6, 2.7}) {
      const Eigen::Matrix3d in_plane(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
      const Eigen::Matrix3d in_space(
          Eigen::AngleAxisd(angle, Eigen::Vector3d(1, 2, 3).normalized()));
      for (const Eigen::Matrix3d& turn : {in_plane, in_space}) {
        const Shape turned = turn * second;
        EXPECT_EQ(AsSet(Triangulate({0, kCorners}, Counting(kCorners), {first, turned})), wanted)
            << seed << ", " << angle;
      }
    }
  }
}

TEST(TriangulateTest, ThePosesMeanDecides) {
  // A square whose corner 0 is pushed inwards far in one pose and outwards slightly in the other:
  // in the mean, as in the first pose, only the diagonal 0-2 is inside. The opposite case likewise.
  Shape dented(3, 4), kite(3, 4);
  dented << 0.9, 1, 1, 0, 0.9, 0, 1, 1, 0, 0, 0, 0;
  kite << -0.1, 1, 1, 0, -0.1, 0, 1, 1, 0, 0, 0, 0;
  const std::set<std::vector<int>> inside = {{0, 1, 2}, {0, 2, 3}};
  const std::set<std::vector<int>> across = {{0, 1, 3}, {1, 2, 3}};
  EXPECT_EQ(AsSet(Triangulate({0, 4}, {0, 1, 2, 3}, {dented})), inside);
  EXPECT_EQ(AsSet(Triangulate({0, 4}, {0, 1, 2, 3}, {dented, kite})), inside);
  EXPECT_EQ(AsSet(Triangulate({0, 4}, {0, 1, 2, 3}, {kite, kite, kite})), across);
}

TEST(TriangulateTest, CornersOnStraightSidesMakeNoTriangleWithoutArea) {
  // A square with two more corners on each of its sides.
  Shape square(3, 12);
  square << 0, 1, 2, 3, 3, 3, 3, 2, 1, 0, 0, 0, 0, 0, 0, 0, 1, 2, 3, 3, 3, 3, 2, 1, 0, 0, 0, 0, 0,
      0, 0, 0, 0, 0, 0, 0;
  const Eigen::Matrix3Xi triangles = Triangulate({0, 12}, Counting(12), {square});
  double sum = 0;
  for (int f = 0; f < triangles.cols(); ++f) {
    EXPECT_GT(SignedArea(square, triangles.col(f)), 0.4);  // half of the smallest possible: 1/2
    sum += SignedArea(square, triangles.col(f));
  }
  EXPECT_NEAR(sum, 9, 1e-12);
}

TEST(TriangulateTest, PolygonsThatCannotBeCutWellAreCutAllTheSame) {
  const Shape point = Shape::Zero(3, 5);
  EXPECT_EQ(AsSet(Triangulate({0, 5}, Counting(5), {point})).size(), 3u);
  Shape bow_tie(3, 4);  // its sides cross, so that its area is none
  bow_tie << 0, 1, 0, 1, 0, 1, 1, 0, 0, 0, 0, 0;
  EXPECT_EQ(AsSet(Triangulate({0, 4}, Counting(4), {bow_tie})).size(), 2u);
  Shape star(3, 5);  // drawn in one stroke: every second corner of a pentagon
  for (int k = 0; k < 5; ++k) {
    star.col(k) << std::cos(0.8 * M_PI * k), std::sin(0.8 * M_PI * k), 0;
  }
  EXPECT_EQ(AsSet(Triangulate({0, 5}, Counting(5), {star})).size(), 3u);
  // A repeated corner, as where two holes were connected to the outline.
  EXPECT_EQ(Triangulate({0, 5}, {0, 1, 2, 1, 3}, {RandomPolygon(4, 1)}).cols(), 3);
}

// Such polygons are made up, but files may have them. When every cut looked at all corners again,
// this one took minutes.
TEST(TriangulateTest, PolygonsOfManyCornersDoNotTakeForEver) {
  constexpr int kCorners = 10000;
  std::mt19937 random(1);
  Shape tangle(3, kCorners);
  for (double& coordinate : tangle.reshaped()) coordinate = static_cast<double>(random() % 10007);
  const Eigen::Matrix3Xi triangles = Triangulate({0, kCorners}, Counting(kCorners), {tangle});
  EXPECT_EQ(AsSet(triangles).size(), static_cast<size_t>(kCorners - 2));
}

TEST(TriangulateTest, RefusesWhatIsNoPolygon) {
  const Shape flat = RandomPolygon(4, 1);
  testing::ExpectError<MeshError>(
      [&] {
        Triangulate({0, 2}, {0, 1}, {flat});
      },
      {"polygon 0 has 2 corners"});
  testing::ExpectError<MeshError>(
      [&] {
        Triangulate({0, 3}, {0, 1, 4}, {flat});
      },
      {"vertex index 4 outside 0 .. 3"});
  testing::ExpectError<MeshError>([&] { Triangulate({0, 3}, {0, 1, 2}, {}); }, {"at least one"});
}

TEST(TriangulateTest, ConnectivityTakesTheTrianglesAndHoldsAllPolygonsAlike) {
  constexpr int kCorners = 7;
  const Shape flat = RandomPolygon(kCorners, 3);
  std::set<std::pair<int, int>> wanted;
  for (int first = 0; first < kCorners; ++first) {
    const std::vector<int> polygon = Counting(kCorners, first);
    const auto connectivity = Connectivity::Make(kCorners, {0, kCorners}, polygon, {}, {},
                                                 Triangulate({0, kCorners}, polygon, {flat}));
    std::set<std::pair<int, int>> edges;
    for (int e = 0; e < connectivity->NumEdges(); ++e) {
      edges.emplace(connectivity->Edges()(0, e), connectivity->Edges()(1, e));
    }
    // Sides, and all diagonals that cut off one corner.
    for (int k = 0; k < kCorners; ++k) {
      for (const int step : {1, 2}) {
        const int a = k, b = (k + step) % kCorners;
        EXPECT_EQ(edges.count(std::minmax(a, b)), 1u) << a << "-" << b;
      }
    }
    if (first == 0) wanted = edges;
    EXPECT_EQ(edges, wanted) << "beginning at corner " << first;
  }
}

TEST(TriangulateTest, TrianglesStandInTheOrderOfTheirPolygonsAndKeepTheirCorners) {
  // The angle at corner 2 is the one nearest to those of an equilateral triangle.
  Shape kite(3, 9);
  kite.setRandom();
  kite.col(1) << 0, -1, 0.25;
  kite.col(2) << 1.7, 0, 0.25;
  kite.col(4) << 0, 1, 0.25;
  kite.col(3) << -1.2, 0, 0.25;
  Eigen::Matrix3Xi expected(3, 4);
  expected << 8, 1, 1, 0,  //
      5, 2, 4, 7,          //
      6, 4, 3, 5;
  EXPECT_EQ(Triangulate({0, 3, 7, 10}, {8, 5, 6, 4, 3, 1, 2, 0, 7, 5}, {kite}), expected);
  // Without any area, corners are cut off in order.
  Eigen::Matrix3Xi in_order(3, 3);
  in_order << 4, 4, 2,  //
      0, 1, 3,          //
      1, 2, 4;
  EXPECT_EQ(Triangulate({0, 5}, {2, 3, 4, 0, 1}, {Shape::Constant(3, 5, 7)}), in_order);
}

TEST(TriangulateTest, APoseInWhichThePolygonHasNoAreaDoesNotCount) {
  Shape dented(3, 4), line(3, 4);
  dented << 0.9, 1, 1, 0, 0.9, 0, 1, 1, 0, 0, 0, 0;
  line << 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3;
  const std::set<std::vector<int>> inside = {{0, 1, 2}, {0, 2, 3}};
  for (const std::vector<Shape>& poses : {std::vector<Shape>{line, dented},
                                          {dented, line},
                                          {line, dented, line, dented},
                                          {Shape::Zero(3, 4), dented, Shape::Zero(3, 4)}}) {
    EXPECT_EQ(AsSet(Triangulate({0, 4}, {0, 1, 2, 3}, poses)), inside);
  }
  testing::ExpectError<MeshError>(
      [&] {
        Triangulate({0, 4}, {0, 1, 2, 3}, {dented, dented.leftCols(3)});
      },
      {"vertex index 3 outside 0 .. 2"});
}

}  // namespace
}  // namespace shapespace
