#include <shapespace/hierarchy/hierarchy.h>

#include <algorithm>
#include <filesystem>
#include <numeric>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/files/read.h>

#include "bodies/measure.h"
#include "hierarchy/meshes.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

using testing::ExpectSameTopology;
using testing::PosedMesh;

HierarchyOptions Coarsest(int triangles) {
  HierarchyOptions options;
  options.coarsest = triangles;
  return options;
}

// The largest distance between vertices of two shapes, relative to the first one's extent.
double Apart(const Shape& a, const Shape& b) {
  const double extent = (a.rowwise().maxCoeff() - a.rowwise().minCoeff()).norm();
  return (a - b).colwise().norm().maxCoeff() / extent;
}

// For any mesh: levels become coarser, are nested, restrict to each other, and lift to the poses
// again.
void ExpectSoundLevels(const PosedMesh& mesh, const Hierarchy& hierarchy, double exact = 1e-12) {
  const int finest = hierarchy.NumLevels() - 1;
  EXPECT_EQ(hierarchy.LevelConnectivity(finest), mesh.connectivity);
  for (const Shape& pose : mesh.poses) EXPECT_TRUE(hierarchy.Restrict(pose, finest) == pose);
  for (int level = 0; level < finest; ++level) {
    SCOPED_TRACE(level);
    const Connectivity& here = *hierarchy.LevelConnectivity(level);
    const std::vector<int>& vertices = hierarchy.Vertices(level);
    ASSERT_EQ(static_cast<int>(vertices.size()), here.NumVertices());
    EXPECT_TRUE(std::is_sorted(vertices.begin(), vertices.end()));
    EXPECT_TRUE(std::includes(hierarchy.Vertices(level + 1).begin(),
                              hierarchy.Vertices(level + 1).end(), vertices.begin(),
                              vertices.end()));
    for (size_t p = 0; p < mesh.poses.size(); ++p) {
      const Shape fine = hierarchy.Restrict(mesh.poses[p], level + 1);
      const Shape coarse = hierarchy.RestrictOnce(fine, level + 1);
      EXPECT_TRUE(coarse == hierarchy.Restrict(mesh.poses[p], level));
      const Shape& next = mesh.poses[(p + 1) % mesh.poses.size()];
      const Shape other = hierarchy.Restrict(next, level + 1);
      EXPECT_LT(Apart(fine, hierarchy.Lift(coarse, level, fine, other, 0)), exact);
      EXPECT_LT(Apart(fine, hierarchy.Lift(coarse, level, other, fine, 1)), exact);
      EXPECT_LT(Apart(fine, hierarchy.Lift(coarse, level, fine, fine, 0.3)), exact);
    }
  }
}

class HierarchyOfSurfaces : public ::testing::TestWithParam<testing::SurfaceCase> {};

TEST_P(HierarchyOfSurfaces, HasSoundLevels) {
  const PosedMesh mesh = GetParam().make();
  const Hierarchy hierarchy(mesh.connectivity, mesh.poses, Coarsest(150));
  EXPECT_FALSE(hierarchy.StoppedEarly());
  ASSERT_GE(hierarchy.NumLevels(), 3);
  ExpectSoundLevels(mesh, hierarchy);
  EXPECT_NEAR(hierarchy.LevelConnectivity(0)->NumTriangles(), 150, 1);
  for (int level = 0; level + 1 < hierarchy.NumLevels(); ++level) {
    SCOPED_TRACE(level);
    const Connectivity& here = *hierarchy.LevelConnectivity(level);
    const Connectivity& finer = *hierarchy.LevelConnectivity(level + 1);
    EXPECT_LE(2 * here.NumTriangles(), finer.NumTriangles() + 2);
    EXPECT_GT(10 * here.NumTriangles(), finer.NumTriangles());
    ExpectSameTopology(*mesh.connectivity, here);
  }
}

TEST_P(HierarchyOfSurfaces, KeepsAreaInEveryPose) {
  const PosedMesh mesh = GetParam().make();
  const Hierarchy hierarchy(mesh.connectivity, mesh.poses, Coarsest(400));
  for (const Shape& pose : mesh.poses) {
    const double area = Area(*mesh.connectivity, pose);
    const Connectivity& coarsest = *hierarchy.LevelConnectivity(0);
    EXPECT_NEAR(Area(coarsest, hierarchy.Restrict(pose, 0)), area, 0.06 * area);
  }
}

TEST_P(HierarchyOfSurfaces, LiftsRigidMotionsRigidly) {
  const PosedMesh mesh = GetParam().make();
  const Hierarchy hierarchy(mesh.connectivity, mesh.poses, Coarsest(150));
  const Eigen::Vector3d shift(3, -1, 2);
  for (double angle : {0.5, M_PI}) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(angle, Eigen::Vector3d(2, -1, 1).normalized()).toRotationMatrix();
    for (int level = 0; level + 1 < hierarchy.NumLevels(); ++level) {
      const Shape from = hierarchy.Restrict(mesh.poses.front(), level + 1);
      const Shape to = hierarchy.Restrict(mesh.poses.back(), level + 1);
      // A rigidly moved pose, and a shape that is not a pose.
      Shape between = 0.7 * hierarchy.RestrictOnce(from, level + 1) +
                      0.3 * hierarchy.RestrictOnce(to, level + 1);
      const Shape lifted = hierarchy.Lift(between, level, from, to, 0.3);
      const Shape moved = hierarchy.Lift((turn * between).colwise() + shift, level, from, to, 0.3);
      EXPECT_LT(Apart((turn * lifted).colwise() + shift, moved), 1e-8);
      const Shape base = hierarchy.RestrictOnce(to, level + 1);
      EXPECT_LT(Apart((turn * to).colwise() + shift,
                      hierarchy.Lift((turn * base).colwise() + shift, level, to, to, 0.5)),
                1e-8);
      const auto gradients = hierarchy.LiftGradients(turn * base, level, base);
      ASSERT_EQ(gradients.size(), hierarchy.Vertices(level + 1).size());
      for (const Eigen::Matrix3d& gradient : gradients) EXPECT_LT((gradient - turn).norm(), 1e-6);
    }
  }
}

INSTANTIATE_TEST_SUITE_P(, HierarchyOfSurfaces, ::testing::ValuesIn(testing::kSurfaces),
                         [](const auto& info) { return info.param.name; });

TEST(Hierarchy, KeepsTheVolumeInEveryPose) {
  const PosedMesh animal = testing::Animal(8000);
  const Hierarchy hierarchy(animal.connectivity, animal.poses, Coarsest(1000));
  for (const Shape& pose : animal.poses) {
    const double volume = VolumeOf(*animal.connectivity, pose);
    for (int level = 0; level < hierarchy.NumLevels(); ++level) {
      EXPECT_NEAR(VolumeOf(*hierarchy.LevelConnectivity(level), hierarchy.Restrict(pose, level)),
                  volume, 0.07 * volume)
          << level;
    }
  }
}

// A shape between the poses, lifted with the poses' detail, is nearly the true shape. Bounds are a
// fifth above the measured values.
TEST(Hierarchy, LiftsShapesBetweenThePoses) {
  const ShapeFamily tube = MakeTube(6000);
  const std::vector<Shape> poses = {tube.pose(0), tube.pose(90)};
  const Hierarchy hierarchy(tube.connectivity, poses);
  ASSERT_EQ(hierarchy.NumLevels(), 3);
  for (double t : {0.25, 0.5, 0.75}) {
    SCOPED_TRACE(t);
    const Shape truth = tube.pose(90 * t);
    Shape shape = hierarchy.Restrict(truth, 0);
    for (int level = 0; level + 1 < hierarchy.NumLevels(); ++level) {
      const Connectivity& finer = *hierarchy.LevelConnectivity(level + 1);
      shape = hierarchy.Lift(shape, level, hierarchy.Restrict(poses[0], level + 1),
                             hierarchy.Restrict(poses[1], level + 1), t);
      const Shape true_shape = hierarchy.Restrict(truth, level + 1);
      EXPECT_LT(Apart(true_shape, shape), 0.001);
      EXPECT_LT(LargestStrain(finer, true_shape, shape), 0.017);
      EXPECT_LT((HingeAngles(finer, shape) - HingeAngles(finer, true_shape)).cwiseAbs().maxCoeff(),
                3);
    }
  }
}

TEST(Hierarchy, LiftsKeptVerticesToWhereTheyAre) {
  const PosedMesh mesh = testing::BentTube(2000);
  const Hierarchy hierarchy(mesh.connectivity, mesh.poses);
  const Shape from = hierarchy.Restrict(mesh.poses[0], 1),
              to = hierarchy.Restrict(mesh.poses[1], 1);
  Shape coarse = hierarchy.Restrict(mesh.poses[0], 0);
  coarse += testing::Noise(static_cast<int>(coarse.cols()), 0.05, 1);
  EXPECT_LT(Apart(coarse, hierarchy.RestrictOnce(hierarchy.Lift(coarse, 0, from, to, 0.4), 1)),
            1e-14);
  // From another shape of the finer level, the difference to its base is added.
  const Shape shifted = from.colwise() + Eigen::Vector3d(0, 0, 1);
  const Shape base = hierarchy.RestrictOnce(from, 1);
  EXPECT_LT(Apart(shifted, hierarchy.Lift(base, 0, base, shifted, base, shifted, 0)), 1e-12);
}

TEST(Hierarchy, KeepsPinnedVerticesOnAllLevels) {
  const PosedMesh mesh = testing::Animal(3000, {"stand", "sit"});
  HierarchyOptions options;
  options.pinned = {5, 77, 300, mesh.connectivity->NumVertices() - 1};
  const Hierarchy hierarchy(mesh.connectivity, mesh.poses, options);
  EXPECT_FALSE(hierarchy.StoppedEarly());
  for (int level = 0; level < hierarchy.NumLevels(); ++level) {
    const std::vector<int>& vertices = hierarchy.Vertices(level);
    for (int v : options.pinned) {
      EXPECT_TRUE(std::binary_search(vertices.begin(), vertices.end(), v));
    }
  }
}

TEST(Hierarchy, StopsEarlyWhereNothingMayGo) {
  const PosedMesh mesh = testing::BentTube(2000);
  HierarchyOptions options;
  options.pinned.resize(mesh.connectivity->NumVertices());
  std::iota(options.pinned.begin(), options.pinned.end(), 0);
  const Hierarchy fixed(mesh.connectivity, mesh.poses, options);
  EXPECT_TRUE(fixed.StoppedEarly());
  EXPECT_EQ(fixed.NumLevels(), 1);
  // A level with nearly all triangles would be useless.
  options.pinned.resize(mesh.connectivity->NumVertices() * 9 / 10);
  const Hierarchy nearly(mesh.connectivity, mesh.poses, options);
  EXPECT_TRUE(nearly.StoppedEarly());
  EXPECT_EQ(nearly.NumLevels(), 1);
  options.pinned.resize(mesh.connectivity->NumVertices() / 3);
  const Hierarchy part(mesh.connectivity, mesh.poses, options);
  EXPECT_TRUE(part.StoppedEarly());
  EXPECT_EQ(part.NumLevels(), 2);
  ExpectSoundLevels(mesh, part);
}

TEST(Hierarchy, ExtraEdgesGoWhereTheirEndsGo) {
  const Soup torus = testing::Torus(40, 20);
  const std::pair<int, int> brace = {0, 410}, tie = {100, 101 + 20};
  const auto connectivity =
      Connectivity::Make(torus.NumVertices(), torus.polygon_begin, torus.corners, {}, {brace, tie});
  ASSERT_GT(connectivity->NumEdges(), connectivity->NumTriangleEdges() + 1);
  const PosedMesh mesh = {"torus", connectivity, {torus.vertices}};
  HierarchyOptions options;
  options.pinned = {brace.first, brace.second};
  const Hierarchy hierarchy(connectivity, mesh.poses, options);
  ExpectSoundLevels(mesh, hierarchy);
  for (int level = 0; level < hierarchy.NumLevels(); ++level) {
    SCOPED_TRACE(level);
    const Connectivity& here = *hierarchy.LevelConnectivity(level);
    int braces = 0;
    for (int e = here.NumTriangleEdges(); e < here.NumEdges(); ++e) {
      const int a = hierarchy.Vertices(level)[here.Edges()(0, e)];
      const int b = hierarchy.Vertices(level)[here.Edges()(1, e)];
      EXPECT_NE(a, b);
      braces += std::make_pair(a, b) == brace;
    }
    EXPECT_EQ(braces, 1);
  }
}

TEST(Hierarchy, JoinsWhatSegmentsJoin) {
  const PosedMesh pair = testing::Pair(testing::BentTube(1000), testing::BentTube(1000));
  const Eigen::Matrix3Xi& triangles = pair.connectivity->Triangles();
  const int n = pair.connectivity->NumVertices();
  // A string of two segments through a vertex without triangles.
  const auto connectivity =
      Connectivity::Make(n + 1, pair.connectivity->PolygonBegin(),
                         std::vector<int>(triangles.data(), triangles.data() + triangles.size()),
                         {{10, n}, {n, n - 10}});
  std::vector<Shape> poses;
  for (const Shape& pose : pair.poses) {
    Shape with(3, n + 1);
    with << pose, Eigen::Vector3d(0, 0, 10);
    poses.push_back(with);
  }
  const PosedMesh mesh = {"kite", connectivity, poses};
  const Hierarchy hierarchy(connectivity, poses);
  ExpectSoundLevels(mesh, hierarchy);
  for (int level = 0; level < hierarchy.NumLevels(); ++level) {
    const Connectivity& here = *hierarchy.LevelConnectivity(level);
    EXPECT_EQ(ComputeTopology(here).components, 1);
    EXPECT_EQ(here.NumEdges(), here.NumTriangleEdges() + 2);
  }
}

TEST(Hierarchy, HasOneLevelOfGraphsAndSmallMeshes) {
  const Shape ends = testing::Noise(2, 1, 1);
  const Hierarchy graph(testing::SingleEdge(), {ends});
  EXPECT_EQ(graph.NumLevels(), 1);
  EXPECT_FALSE(graph.StoppedEarly());
  const PosedMesh tube = testing::BentTube(380);
  ASSERT_LT(tube.connectivity->NumTriangles(), 400);
  const Hierarchy small(tube.connectivity, tube.poses);
  EXPECT_EQ(small.NumLevels(), 1);
  EXPECT_FALSE(small.StoppedEarly());
  EXPECT_EQ(Hierarchy(tube.connectivity, tube.poses, Coarsest(2'000'000'000)).NumLevels(), 1);
}

TEST(Hierarchy, RefusesWhatDoesNotFit) {
  for (int triangles : {100, 1000}) {  // with one level and with several
    const PosedMesh tube = testing::BentTube(triangles);
    EXPECT_THROW(Hierarchy(tube.connectivity, {}), MeshError);
    EXPECT_THROW(Hierarchy(tube.connectivity, {tube.poses[0], Shape::Zero(3, 5)}), MeshError);
    HierarchyOptions options;
    options.pinned = {-3};
    EXPECT_TRUE(testing::Refuses<InvalidOptions>(
        [&] { Hierarchy(tube.connectivity, tube.poses, options); }, {"pinned:", "-3"}));
    EXPECT_TRUE(testing::Refuses<InvalidOptions>(
        [&] { Hierarchy(tube.connectivity, tube.poses, Coarsest(3)); }, {"coarsest:", "4"}));
  }
}

TEST(Hierarchy, TakesAnyTriangles) {
  for (int seed = 0; seed < 500; ++seed) {
    SCOPED_TRACE(seed);
    const PosedMesh mesh = testing::AnyMesh(seed);
    const Hierarchy hierarchy(mesh.connectivity, mesh.poses, Coarsest(4));
    for (int level = 0; level + 1 < hierarchy.NumLevels(); ++level) {
      const Shape from = hierarchy.Restrict(mesh.poses[0], level + 1);
      const Shape to = hierarchy.Restrict(mesh.poses[1], level + 1);
      const Shape coarse = hierarchy.RestrictOnce(from, level + 1);
      const Shape lifted = hierarchy.Lift(coarse, level, from, to, 0);
      EXPECT_TRUE(lifted.allFinite());
      // Where all triangles at a vertex lie on one line, rounding determines the rotation of its
      // neighbourhood.
      EXPECT_LT((lifted - from).cwiseAbs().maxCoeff(), 1e-5);
      EXPECT_TRUE(hierarchy.Lift(coarse, level, from, to, 0.5).allFinite());
      const Shape nothing = Shape::Zero(3, coarse.cols());
      EXPECT_TRUE(hierarchy.Lift(nothing, level, from, to, 0.5).allFinite());
    }
  }
}

struct RealPair {
  const char *folder, *first, *second;
  bool manifold;
};

void PrintTo(const RealPair& pair, std::ostream* out) { *out << pair.folder; }

class HierarchyOfRealPoses : public ::testing::TestWithParam<RealPair> {};

TEST_P(HierarchyOfRealPoses, HasSoundLevels) {
  const auto& [name, first, second, manifold] = GetParam();
  const std::filesystem::path folder = std::filesystem::path(SHAPESPACE_DATA_DIR) / name;
  if (!std::filesystem::is_directory(folder)) GTEST_SKIP() << "no real meshes";
  ReadOptions allow;
  allow.allow_nonmanifold = !manifold;
  const Poses poses =
      ReadPoses({(folder / first).string() + ".obj", (folder / second).string() + ".obj"}, allow);
  const PosedMesh mesh = {name, poses.connectivity, poses.shapes};
  const Hierarchy hierarchy(mesh.connectivity, mesh.poses);
  EXPECT_EQ(hierarchy.StoppedEarly(), !manifold);
  EXPECT_LE(hierarchy.LevelConnectivity(0)->NumTriangles(), 350);
  ExpectSoundLevels(mesh, hierarchy);
  for (int level = 0; level < hierarchy.NumLevels(); ++level) {
    ExpectSameTopology(*mesh.connectivity, *hierarchy.LevelConnectivity(level));
  }
}

INSTANTIATE_TEST_SUITE_P(, HierarchyOfRealPoses,
                         ::testing::Values(RealPair{"cactus", "00", "08", true},
                                           RealPair{"horse", "reference", "01", true},
                                           RealPair{"elephant", "reference", "01", true},
                                           RealPair{"camel_nonmanifold", "reference", "01", false}),
                         [](const auto& info) { return info.param.folder; });

}  // namespace
}  // namespace shapespace
