#include <shapespace/hierarchy/detail/decimate.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <set>
#include <utility>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/hierarchy/detail/quadric.h>

#include "bodies/measure.h"
#include "hierarchy/meshes.h"
#include "support/listener.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

using internal::Collapse;
using internal::PlanCollapses;
using testing::After;
using testing::ExpectSameTopology;
using testing::PosedMesh;
using testing::TrianglesOf;

std::vector<Collapse> ToTheEnd(const PosedMesh& mesh, const std::vector<int>& pinned = {}) {
  return PlanCollapses(*mesh.connectivity, mesh.poses, 0, pinned);
}

void ExpectSameCollapses(const std::vector<Collapse>& first, const std::vector<Collapse>& second) {
  ASSERT_EQ(first.size(), second.size());
  for (size_t i = 0; i < first.size(); ++i) {
    ASSERT_EQ(first[i].from, second[i].from) << i;
    ASSERT_EQ(first[i].to, second[i].to) << i;
  }
}

class PlanCollapsesOfSurfaces : public ::testing::TestWithParam<testing::SurfaceCase> {};

TEST_P(PlanCollapsesOfSurfaces, KeepTheTopology) {
  const PosedMesh mesh = GetParam().make();
  const std::vector<Collapse> collapses = ToTheEnd(mesh);
  ASSERT_LT(collapses.back().triangles, mesh.connectivity->NumTriangles() / 5);
  for (int part = 1; part <= 8; ++part) {
    SCOPED_TRACE(part);
    const std::vector<Collapse> first(collapses.begin(),
                                      collapses.begin() + part * collapses.size() / 8);
    const std::shared_ptr<const Connectivity> left = After(*mesh.connectivity, first);
    EXPECT_EQ(left->NumTriangles(), first.back().triangles);
    ExpectSameTopology(*mesh.connectivity, *left);
  }
}

// For all triangles of a mesh that is regular in every pose; with the quality that the decimater
// accepts, the smallest angle is 6.6 degrees.
TEST_P(PlanCollapsesOfSurfaces, MakeNoSliverInAnyPose) {
  const PosedMesh mesh = GetParam().make();
  const std::shared_ptr<const Connectivity> left = After(*mesh.connectivity, ToTheEnd(mesh));
  for (const Shape& pose : mesh.poses) {
    ASSERT_GT(SmallestAngle(*mesh.connectivity, pose), 6.5);
    EXPECT_GT(SmallestAngle(*left, pose), 6.5);
  }
}

TEST_P(PlanCollapsesOfSurfaces, TurnNoTriangleFarInAnyPose) {
  const PosedMesh mesh = GetParam().make();
  Eigen::Matrix3Xi triangles = mesh.connectivity->Triangles();
  for (const Collapse& collapse : ToTheEnd(mesh)) {
    for (auto t : triangles.colwise()) {
      if ((t.array() != collapse.from).all()) continue;
      const Eigen::Vector3i before = t;
      t = (t.array() == collapse.from).select(collapse.to, t);
      if (t(0) == t(1) || t(1) == t(2) || t(2) == t(0)) {
        t.setConstant(collapse.to);
        continue;
      }
      for (const Shape& pose : mesh.poses) {
        const auto normal = [&](const Eigen::Vector3i& f) {
          const Eigen::Vector3d u = pose.col(f(1)) - pose.col(f(0));
          const Eigen::Vector3d v = pose.col(f(2)) - pose.col(f(0));
          return u.cross(v).normalized();
        };
        ASSERT_GT(normal(before).dot(normal(t)), 0.49);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, PlanCollapsesOfSurfaces, ::testing::ValuesIn(testing::kSurfaces),
                         [](const auto& info) { return info.param.name; });

TEST(PlanCollapses, DependsNeitherOnUnitNorOnPlace) {
  PosedMesh mesh = testing::Animal(2000, {"stand", "sit"});
  for (int p = 0; p < 2; ++p) {
    // Noise removes symmetry, and thereby equal costs, whose order would depend on rounding.
    mesh.poses[p] += testing::Noise(mesh.connectivity->NumVertices(), 1e-3, p);
  }
  const std::vector<Collapse> collapses = ToTheEnd(mesh);
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  for (double scale : {1e-4, 1.0, 1e4}) {
    SCOPED_TRACE(scale);
    PosedMesh moved = mesh;
    moved.poses[0] = scale * ((turn * mesh.poses[0]).colwise() + Eigen::Vector3d(4, -5, 6));
    moved.poses[1] *= 3 * scale;
    ExpectSameCollapses(collapses, ToTheEnd(moved));
  }
}

TEST(PlanCollapses, TellsHowFarItIsAndCanBeStopped) {
  const PosedMesh mesh = testing::Animal(4000, {"stand"});
  testing::Listener all;
  std::vector<int> done;
  all.on_report = [&](const std::string&, int so_far) { done.push_back(so_far); };
  const std::vector<Collapse> plan = PlanCollapses(*mesh.connectivity, mesh.poses, 100, {}, &all);
  EXPECT_TRUE(std::is_sorted(done.begin(), done.end()));
  EXPECT_EQ(done.front(), 0);
  EXPECT_GT(done.back(), 1000);
  ExpectSameCollapses(plan, PlanCollapses(*mesh.connectivity, mesh.poses, 100));
  for (const int last : {1, all.reports}) {
    testing::Listener stops(last);
    EXPECT_THROW(PlanCollapses(*mesh.connectivity, mesh.poses, 100, {}, &stops), Cancelled);
  }
}

// A large mesh takes a while before anything collapses.
TEST(PlanCollapses, CanBeStoppedBeforeTheFirstCollapse) {
  const PosedMesh mesh = testing::Animal(80000, {"stand"});
  testing::Listener listener(2);
  std::vector<int> done;
  listener.on_report = [&](const std::string&, int so_far) { done.push_back(so_far); };
  EXPECT_THROW(PlanCollapses(*mesh.connectivity, mesh.poses, 100, {}, &listener), Cancelled);
  EXPECT_EQ(done, std::vector<int>(2, 0));
}

TEST(PlanCollapses, GoesOnWhereAShorterPlanEnds) {
  const PosedMesh mesh = testing::BentTube(2000);
  std::vector<Collapse> whole = ToTheEnd(mesh);
  const std::vector<Collapse> part = PlanCollapses(*mesh.connectivity, mesh.poses, 700);
  EXPECT_LE(part.back().triangles, 700);
  EXPECT_GT(part[part.size() - 2].triangles, 700);
  whole.resize(part.size());
  ExpectSameCollapses(part, whole);
}

// Flat faces need no vertices except their corners, which the quadrics and the boundary planes
// preserve.
TEST(PlanCollapses, KeepsWhatIsFlat) {
  const Soup grid = testing::Grid(12, 9);
  const PosedMesh flat = {"grid", testing::ConnectivityOf(grid), {grid.vertices}};
  const std::vector<Collapse> collapses = PlanCollapses(*flat.connectivity, flat.poses, 12);
  EXPECT_LE(collapses.back().triangles, 12);
  EXPECT_NEAR(Area(*After(*flat.connectivity, collapses), grid.vertices), 108, 1e-10);

  const ShapeFamily bar = MakeBar(3, 2, 1, 18, 12, 6);
  const Shape box = bar.pose(0);
  const std::vector<Collapse> plan = PlanCollapses(*bar.connectivity, {box}, 60);
  EXPECT_LE(plan.back().triangles, 60);
  EXPECT_NEAR(VolumeOf(*After(*bar.connectivity, plan), box), 6, 1e-10);
}

TEST(PlanCollapses, KeepsACreaseThatOnlyOnePoseHas) {
  const Soup grid = testing::Grid(12, 12);
  Shape creased = grid.vertices;
  creased.row(2) = (creased.row(0).array() - 6).abs();
  const auto connectivity = testing::ConnectivityOf(grid);
  const std::vector<Collapse> plan = PlanCollapses(*connectivity, {grid.vertices, creased}, 40);
  EXPECT_LE(plan.back().triangles, 40);
  const auto left = After(*connectivity, plan);
  EXPECT_NEAR(Area(*left, creased), 144 * std::sqrt(2.0), 1e-9);
}

// There the planes of the triangles on both sides of the fold are the same.
TEST(PlanCollapses, KeepsAFoldThatLiesFlat) {
  const Soup grid = testing::Grid(12, 12);
  Shape folded = grid.vertices;
  folded.row(0) = (folded.row(0).array() - 6).abs();
  const auto connectivity = testing::ConnectivityOf(grid);
  for (const Eigen::Vector3d& axis : {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(1, -2, 0.5)}) {
    const Shape turned = Eigen::AngleAxisd(1, axis.normalized()).toRotationMatrix() * folded;
    const std::vector<Collapse> plan = PlanCollapses(*connectivity, {grid.vertices, turned}, 40);
    EXPECT_LE(plan.back().triangles, 40);
    EXPECT_NEAR(Area(*After(*connectivity, plan), turned), 144, 1e-9);
  }
}

TEST(PlanCollapses, KeepsPinnedVertices) {
  const PosedMesh mesh = testing::BentTube(2000);
  std::vector<int> pinned;
  for (int v = 3; v < mesh.connectivity->NumVertices(); v += 17) pinned.push_back(v);
  const std::vector<Collapse> collapses = ToTheEnd(mesh, pinned);
  EXPECT_LT(collapses.back().triangles, 500);
  for (const Collapse& collapse : collapses) EXPECT_NE(collapse.from % 17, 3);

  std::vector<int> all(mesh.connectivity->NumVertices());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_TRUE(ToTheEnd(mesh, all).empty());
}

TEST(PlanCollapses, LeavesTheLeastSurfaces) {
  Shape corners(3, 4);
  corners << 0, 1, 0, 0,  //
      0, 0, 1, 0,         //
      0, 0, 0, 1;
  const PosedMesh triangle = {"triangle", TrianglesOf(3, {{0, 1, 2}}), {corners.leftCols(3)}};
  EXPECT_TRUE(ToTheEnd(triangle).empty());
  const PosedMesh tetrahedron = {
      "tetrahedron", TrianglesOf(4, {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}}), {corners}};
  EXPECT_TRUE(ToTheEnd(tetrahedron).empty());
  EXPECT_TRUE(ToTheEnd(testing::Pair(tetrahedron, tetrahedron)).empty());
  const PosedMesh pillow = {"pillow", TrianglesOf(3, {{0, 1, 2}, {0, 2, 1}}), {triangle.poses}};
  EXPECT_TRUE(ToTheEnd(pillow).empty());
  // Two adjacent triangles are a disc, and so is one.
  const PosedMesh square = {"square", TrianglesOf(4, {{0, 1, 2}, {2, 1, 3}}), {corners}};
  const std::vector<Collapse> one = ToTheEnd(square);
  ASSERT_EQ(one.size(), 1u);
  EXPECT_EQ(one[0].triangles, 1);
}

TEST(PlanCollapses, TakesABallToATetrahedron) {
  const ShapeFamily cube = MakeBar(1, 1, 1, 8, 8, 8);
  Shape ball = cube.pose(0);
  ball.colwise().normalize();
  const std::vector<Collapse> collapses = PlanCollapses(*cube.connectivity, {ball}, 0);
  EXPECT_EQ(collapses.back().triangles, 4);
}

// Three pages of a book, each a grid, at one spine.
TEST(PlanCollapses, KeepsTheSpineOfABook) {
  constexpr int kHigh = 6, kWide = 5;
  const Soup page = testing::Grid(kWide, kHigh);  // vertices 0 .. kHigh are the spine
  const int apart = kWide * (kHigh + 1);
  std::vector<Eigen::Vector3i> triangles;
  Shape vertices(3, kHigh + 1 + 3 * apart);
  for (int p = 0; p < 3; ++p) {
    const auto number = [&](int v) { return v <= kHigh ? v : v + p * apart; };
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(2.0 * p, Eigen::Vector3d::UnitY()).toRotationMatrix();
    for (int v = 0; v < page.NumVertices(); ++v) {
      vertices.col(number(v)) = turn * page.vertices.col(v);
    }
    for (size_t c = 0; c < page.corners.size(); c += 3) {
      triangles.emplace_back(number(page.corners[c]), number(page.corners[c + 1]),
                             number(page.corners[c + 2]));
    }
  }
  const PosedMesh book = {
      "book", TrianglesOf(static_cast<int>(vertices.cols()), triangles), {vertices}};
  std::vector<Collapse> collapses = ToTheEnd(book);
  for (const Collapse& collapse : collapses) EXPECT_GT(collapse.from, kHigh);
  // At the very end a corner of a page may collapse, where nothing else can.
  while (collapses.back().triangles < book.connectivity->NumTriangles() / 3) collapses.pop_back();
  const auto left = After(*book.connectivity, collapses);
  EXPECT_LT(left->NumTriangles(), book.connectivity->NumTriangles() / 2);
  EXPECT_NEAR(Area(*left, vertices), Area(*book.connectivity, vertices), 1e-10);
  for (int v = 0; v < kHigh; ++v) {
    int pages = 0;
    for (const auto& t : left->Triangles().colwise()) {
      pages += (t.array() == v).any() && (t.array() == v + 1).any();
    }
    EXPECT_EQ(pages, 3) << v;
  }
}

// A triangle between corners of two sheets connects them; a triangle on an edge in the interior of
// a sheet is a fin. Their free corners could be removed without a flip, but must not.
TEST(PlanCollapses, KeepsBridgesAndFins) {
  const Soup grid = testing::Grid(6, 6);
  const int n = grid.NumVertices();
  std::vector<Eigen::Vector3i> triangles;
  for (size_t c = 0; c < grid.corners.size(); c += 3) {
    const Eigen::Vector3i t(grid.corners[c], grid.corners[c + 1], grid.corners[c + 2]);
    triangles.push_back(t);
    triangles.push_back(t.array() + n);
  }
  triangles.emplace_back(n - 1, n, 2 * n);  // far corner of the first, near corner of the second
  const int middle = 3 * 7 + 3;
  triangles.emplace_back(middle, middle + 1, 2 * n + 1);
  Shape vertices(3, 2 * n + 2);
  vertices << grid.vertices, grid.vertices.colwise() + Eigen::Vector3d(7, 7, 0),
      Eigen::Vector3d(6.1, 6.9, 0), Eigen::Vector3d(3, 3.5, 1);
  const PosedMesh mesh = {"sheets", TrianglesOf(2 * n + 2, triangles), {vertices}};
  const std::vector<Collapse> collapses = ToTheEnd(mesh);
  EXPECT_LT(collapses.back().triangles, 60);
  std::set<int> gone;
  for (const Collapse& collapse : collapses) gone.insert(collapse.from);
  for (int v : {n - 1, n, 2 * n, middle, middle + 1, 2 * n + 1}) EXPECT_EQ(gone.count(v), 0u) << v;
  EXPECT_EQ(ComputeTopology(*After(*mesh.connectivity, collapses)).components, 1);
}

// If such a vertex, and its neighbours, were tried at every collapse, time would be cubic in the
// number of its triangles, and this test would run for days.
TEST(PlanCollapses, CopesWithVerticesOfManyTriangles) {
  constexpr int kAround = 30000;
  std::vector<Eigen::Vector3i> triangles;
  Shape vertices(3, kAround + 2);
  for (int i = 0; i < kAround; ++i) {
    const double angle = 2 * M_PI * i / kAround;
    vertices.col(i) << std::cos(angle), std::sin(angle), 0;
    const int next = (i + 1) % kAround;
    triangles.emplace_back(i, next, kAround);
    triangles.emplace_back(next, i, kAround + 1);
  }
  vertices.col(kAround) << 0, 0, 1;
  vertices.col(kAround + 1) << 0, 0, -1;
  const auto connectivity = TrianglesOf(kAround + 2, triangles);
  const std::vector<Collapse> collapses = PlanCollapses(*connectivity, {vertices}, 40);
  EXPECT_EQ(collapses.back().triangles, 40);
  EXPECT_NEAR(VolumeOf(*After(*connectivity, collapses), vertices), 2 * M_PI / 3, 0.2);
}

TEST(Quadric, IsTheSameFunctionFromAnotherOrigin) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  const auto any = [&] { return Eigen::Vector3d(normal(random), normal(random), normal(random)); };
  internal::Quadric quadric;
  std::vector<std::pair<Eigen::Vector3d, Eigen::Vector3d>> planes;
  for (int i = 0; i < 5; ++i) {
    planes.emplace_back(any().normalized(), any());
    quadric.AddPlane(planes.back().first, planes.back().second, i + 1);
  }
  const Eigen::Vector3d origin = any();
  const internal::Quadric moved = quadric.From(origin);
  for (int k = 0; k < 10; ++k) {
    const Eigen::Vector3d point = any();
    double expected = 0;
    for (int i = 0; i < 5; ++i) {
      expected += (i + 1) * std::pow(planes[i].first.dot(point - planes[i].second), 2);
    }
    EXPECT_NEAR(quadric(point), expected, 1e-12 * expected);
    EXPECT_NEAR(moved(point - origin), expected, 1e-12 * expected);
  }
  EXPECT_EQ(moved.AtOrigin(), moved(Eigen::Vector3d::Zero()));
}

TEST(PlanCollapses, TakesAnyTriangles) {
  for (int seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(seed);
    const PosedMesh mesh = testing::AnyMesh(seed);
    const std::vector<Collapse> collapses = ToTheEnd(mesh);
    std::set<int> gone;
    for (const Collapse& collapse : collapses) {
      EXPECT_TRUE(gone.insert(collapse.from).second);
      EXPECT_EQ(gone.count(collapse.to), 0u);
    }
    ExpectSameTopology(*After(*mesh.connectivity, {}), *After(*mesh.connectivity, collapses));
  }
}

TEST(PlanCollapses, RefusesWhatDoesNotFit) {
  const PosedMesh mesh = testing::BentTube(100);
  const Shape more = Shape::Zero(3, mesh.connectivity->NumVertices() + 1);
  EXPECT_THROW(PlanCollapses(*mesh.connectivity, {mesh.poses[0], more}, 10), MeshError);
  for (int v : {-1, mesh.connectivity->NumVertices()}) {
    EXPECT_TRUE(testing::Refuses<InvalidOptions>(
        [&] { PlanCollapses(*mesh.connectivity, mesh.poses, 10, {v}); },
        {"pinned:", std::to_string(v)}));
  }
}

}  // namespace
}  // namespace shapespace
