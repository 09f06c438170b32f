#include <shapespace/analysis/intersections.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>
#include <Eigen/LU>

#include <shapespace/base/error.h>
#include <shapespace/bodies/quadruped.h>
#include <shapespace/bodies/steffen.h>
#include <shapespace/bodies/tube.h>

namespace shapespace {
namespace {

struct Mesh {
  std::shared_ptr<const Connectivity> connectivity;
  Shape shape;

  std::int64_t Count() const { return CountIntersections(*connectivity, shape); }
};

// Triangles without common corners, in a cube of side 1, with sides of up to `size`.
Mesh RandomTriangles(int count, double size, int seed) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-0.5, 0.5);
  const auto point = [&] {
    const double x = uniform(generator), y = uniform(generator), z = uniform(generator);
    return Eigen::Vector3d(x, y, z);
  };
  Mesh mesh;
  mesh.shape.resize(3, 3 * count);
  Eigen::Matrix3Xi triangles(3, count);
  for (int f = 0; f < count; ++f) {
    const Eigen::Vector3d centre = point();
    for (int k = 0; k < 3; ++k) {
      triangles(k, f) = 3 * f + k;
      mesh.shape.col(3 * f + k) = centre + size * point();
    }
  }
  mesh.connectivity = Connectivity::FromTriangles(3 * count, triangles);
  return mesh;
}

// The same with a cone of `count` triangles through the cube; its tip is one vertex, or one for
// every `most` triangles.
Mesh WithCone(const Mesh& mesh, int count, int most) {
  const int first = mesh.connectivity->NumVertices(), tips = (count + most - 1) / most;
  Mesh with;
  with.shape.resize(3, first + count + tips);
  with.shape.leftCols(first) = mesh.shape;
  Eigen::Matrix3Xi triangles(3, mesh.connectivity->NumTriangles() + count);
  triangles.leftCols(mesh.connectivity->NumTriangles()) = mesh.connectivity->Triangles();
  for (int i = 0; i < count; ++i) {
    const double angle = 2 * M_PI * i / count;
    with.shape.col(first + i) << 0.5 * std::cos(angle), 0.4 * std::sin(angle), -0.4;
    with.shape.col(first + count + i / most) << 0.1, 0, 0.4;
    triangles.col(mesh.connectivity->NumTriangles() + i) << first + i, first + (i + 1) % count,
        first + count + i / most;
  }
  with.connectivity = Connectivity::FromTriangles(first + count + tips, triangles);
  return with;
}

// Whether the segment pq passes through the inside of abc: p + s (q - p) = a + u (b - a) + v (c -
// a).
bool Pierces(const Shape& shape, int p, int q, const Eigen::Vector3i& abc) {
  Eigen::Matrix3d matrix;
  matrix << shape.col(abc(1)) - shape.col(abc(0)), shape.col(abc(2)) - shape.col(abc(0)),
      shape.col(p) - shape.col(q);
  if (matrix.determinant() == 0) return false;
  const Eigen::Vector3d uvs = matrix.inverse() * (shape.col(p) - shape.col(abc(0)));
  return uvs(0) > 0 && uvs(1) > 0 && uvs(0) + uvs(1) < 1 && uvs(2) > 0 && uvs(2) < 1;
}

// Tests all pairs, one edge against one triangle after the other.
std::int64_t BruteForce(const Mesh& mesh) {
  const Eigen::Matrix3Xi& triangles = mesh.connectivity->Triangles();
  std::int64_t count = 0;
  for (int f = 0; f < triangles.cols(); ++f) {
    for (int g = f + 1; g < triangles.cols(); ++g) {
      const Eigen::Vector3i a = triangles.col(f), b = triangles.col(g);
      bool shared = false, pierces = false;
      for (int k = 0; k < 3; ++k) {
        shared = shared || (b.array() == a(k)).any();
        pierces = pierces || Pierces(mesh.shape, a(k), a((k + 1) % 3), b) ||
                  Pierces(mesh.shape, b(k), b((k + 1) % 3), a);
      }
      count += !shared && pierces;
    }
  }
  return count;
}

// A tube wound up to `turns` of a helix with the given rise a turn.
Mesh WoundTube(double turns, double rise) {
  TubeForm form;
  form.base_radius = form.tip_radius = 0.3;
  form.knuckle = 0;
  const ShapeFamily tube = MakeTube(1500, form);
  Mesh mesh{tube.connectivity, tube.pose(0)};
  const double radius = form.length / (2 * M_PI * turns);
  for (auto p : mesh.shape.colwise()) {
    const double angle = p.x() / radius;
    p = Eigen::Vector3d((radius + p.y()) * std::cos(angle), (radius + p.y()) * std::sin(angle),
                        p.z() + rise * angle / (2 * M_PI));
  }
  return mesh;
}

TEST(CountIntersections, FindsNoneOnBodiesThatHaveNone) {
  const ShapeFamily steffen = MakeSteffen();
  for (const double angle : {steffen.begin, 0.0, steffen.end}) {
    EXPECT_EQ(CountIntersections(*steffen.connectivity, steffen.pose(angle)), 0) << angle;
  }
  const SkinnedBody quadruped = MakeQuadruped(3000);
  EXPECT_EQ(CountIntersections(*quadruped.connectivity, quadruped.pose("stand")), 0);
}

TEST(CountIntersections, CountsBothTrianglesOfEachSquareThatASheetCuts) {
  constexpr int kSquares = 7;
  Mesh mesh;
  mesh.shape.resize(3, 2 * (kSquares + 1) + 3);
  std::vector<int> begin = {0}, corners;
  for (int i = 0; i <= kSquares; ++i) {
    mesh.shape.col(2 * i) << i, 0, 0;
    mesh.shape.col(2 * i + 1) << i, 1, 0;
    if (i == kSquares) continue;
    for (const int v : {2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1}) corners.push_back(v);
    begin.push_back(static_cast<int>(corners.size()));
  }
  // One triangle in the plane y = 0.4, far larger than the strip.
  mesh.shape.rightCols<3>() << -50, 50, 0,  //
      0.4, 0.4, 0.4,                        //
      -20, -20, 80;
  for (int k = 0; k < 3; ++k) corners.push_back(2 * (kSquares + 1) + k);
  begin.push_back(static_cast<int>(corners.size()));
  mesh.connectivity = Connectivity::Make(static_cast<int>(mesh.shape.cols()), begin, corners);
  EXPECT_EQ(mesh.Count(), 2 * kSquares);
  mesh.shape.rightCols<3>().row(1).setConstant(1.1);  // beside the strip
  EXPECT_EQ(mesh.Count(), 0);
}

TEST(CountIntersections, EndsWhereItIsTold) {
  const ShapeFamily tube = MakeTube(1000);
  const Shape flat = Eigen::DiagonalMatrix<double, 3>(1, 1, 1e-2) * tube.pose(110);
  Shape tangled = flat;
  for (Eigen::Index v = 0; v < tangled.cols(); ++v) tangled.col(v) = flat.col(v * 7 % flat.cols());
  const std::int64_t all = CountIntersections(*tube.connectivity, tangled);
  ASSERT_GT(all, 100);
  for (const std::int64_t most : {std::int64_t{0}, std::int64_t{7}, all - 1}) {
    EXPECT_EQ(CountIntersections(*tube.connectivity, tangled, most), most);
  }
  EXPECT_EQ(CountIntersections(*tube.connectivity, tangled, all + 1), all);
}

TEST(CountIntersections, SeesATubeThatPassesThroughItself) {
  EXPECT_EQ(WoundTube(0.8, 0).Count(), 0);
  EXPECT_GT(WoundTube(1.3, 0).Count(), 100);
  EXPECT_GT(WoundTube(1.3, 0.3).Count(), 20);  // half a thickness apart
  EXPECT_EQ(WoundTube(1.3, 1).Count(), 0);     // past each other
}

TEST(CountIntersections, AgreesWithBruteForce) {
  for (const int seed : {1, 2, 3}) {
    const Mesh few = RandomTriangles(60, 1, seed), many = RandomTriangles(400, 0.3, seed);
    EXPECT_GT(few.Count(), 50);
    EXPECT_EQ(few.Count(), BruteForce(few));
    EXPECT_EQ(many.Count(), BruteForce(many));
  }
  const Mesh tube = WoundTube(1.3, 0.1);  // connected: neighbours do not count
  EXPECT_EQ(tube.Count(), BruteForce(tube));
}

TEST(CountIntersections, DoesNotDependOnScalePlaceOrNumbering) {
  const Mesh mesh = RandomTriangles(300, 0.4, 5);
  const std::int64_t count = mesh.Count();
  ASSERT_GT(count, 100);
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(1.1, Eigen::Vector3d(1, 2, 3).normalized()));
  for (const double scale : {1e-20, 1e-4, 1e4, 1e20}) {
    const Shape moved =
        (scale * turn * mesh.shape).colwise() + scale * Eigen::Vector3d(1e3, -2e3, 5e2);
    EXPECT_EQ(CountIntersections(*mesh.connectivity, moved), count) << scale;
  }
  std::vector<int> order(mesh.shape.cols());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.end(), std::mt19937(7));
  Mesh renumbered{nullptr, mesh.shape};
  Eigen::Matrix3Xi triangles = mesh.connectivity->Triangles().rowwise().reverse();
  for (int& v : triangles.reshaped()) v = order[v];
  for (size_t v = 0; v < order.size(); ++v) renumbered.shape.col(order[v]) = mesh.shape.col(v);
  renumbered.connectivity = Connectivity::FromTriangles(static_cast<int>(order.size()), triangles);
  EXPECT_EQ(renumbered.Count(), count);
}

TEST(CountIntersections, TouchingIsNone) {
  Mesh mesh;
  mesh.connectivity =
      Connectivity::FromTriangles(6, (Eigen::Matrix3Xi(3, 2) << 0, 3, 1, 4, 2, 5).finished());
  const auto count = [&](const Eigen::Vector3d& a, const Eigen::Vector3d& b,
                         const Eigen::Vector3d& c) {
    mesh.shape.resize(3, 6);
    mesh.shape << Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), a,
        b, c;
    return mesh.Count();
  };
  EXPECT_EQ(count({0.2, 0.2, -1}, {0.3, 0.2, 1}, {0.2, 0.4, 1}), 1);
  EXPECT_EQ(count({0.2, 0.2, 0}, {0.3, 0.2, 1}, {0.2, 0.4, 1}), 0);   // a corner on the face
  EXPECT_EQ(count({0, 0, 0}, {1, 0, 0}, {0, 0.3, 1}), 0);             // a doubled edge
  EXPECT_EQ(count({0, 0, 0}, {1, 0, 0}, {0, 1, 0}), 0);               // doubled
  EXPECT_EQ(count({0.1, 0.1, 0}, {2, 0, 0}, {0, 2, 0}), 0);           // in one plane
  EXPECT_EQ(count({0.2, 0.2, -1}, {0.2, 0.2, 1}, {0.2, 0.2, 2}), 0);  // of no area
}

TEST(CountIntersections, OfAGraphOrAPointAreNone) {
  const auto graph = Connectivity::Make(2, {0}, {}, {{0, 1}});
  EXPECT_EQ(CountIntersections(*graph, Shape::Random(3, 2)), 0);
  EXPECT_EQ(CountIntersections(*MakeSteffen().connectivity, Shape::Ones(3, 9)), 0);
}

TEST(CountIntersections, RefusesWhatIsNoShapeOfTheMesh) {
  const ShapeFamily steffen = MakeSteffen();
  EXPECT_THROW(CountIntersections(*steffen.connectivity, Shape::Zero(3, 8)), MeshError);
  Shape broken = steffen.pose(0);
  broken(1, 4) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(CountIntersections(*steffen.connectivity, broken), MeshError);
}

// Triangles of a vertex with many are tested in groups.
TEST(Intersections, OfAFanOfManyTrianglesAreThoseOfManySmallFans) {
  const Mesh others = RandomTriangles(200, 0.3, 7);
  const std::int64_t expected = WithCone(others, 500, 20).Count();
  EXPECT_GT(expected, others.Count() + 100);
  EXPECT_EQ(WithCone(others, 500, 500).Count(), expected);
}

}  // namespace
}  // namespace shapespace
