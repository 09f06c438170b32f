#include <shapespace/mesh/ties.h>

#include <algorithm>
#include <memory>
#include <set>

#include <gtest/gtest.h>

#include <shapespace/base/parallel.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/hierarchy/hierarchy.h>
#include <shapespace/mesh/topology.h>
#include <shapespace/output/picture.h>
#include <shapespace/spline/spline.h>
#include <shapespace/statistics/average.h>
#include <shapespace/transfer/transfer.h>

#include "support/threads.h"
#include "support/worn.h"

namespace shapespace {
namespace {

using testing::Arm;
using testing::Ball;
using testing::Bent;
using testing::BentArmWithBracelet;
using testing::BraceletOff;
using testing::Part;
using testing::PosesOf;
using testing::Together;

using Pairs = std::vector<std::pair<int, int>>;

constexpr double kOff = 0.01;  // widths of the arm

ReadOptions Loose() {
  ReadOptions options;
  options.loose_components = true;
  return options;
}

Ties TiesOf(const std::vector<Part>& poses) {
  const Poses loose = PosesOf(poses, Loose());
  return FindTies(*loose.connectivity, loose.shapes);
}

int NumComponents(const Poses& poses) { return ComputeTopology(*poses.connectivity).components; }

const std::vector<Part>& ArmPoses() {
  static const std::vector<Part> poses = {BentArmWithBracelet(0), BentArmWithBracelet(120)};
  return poses;
}

// Motions of the bracelet in its tangent space that change no length of a tie: none.
TEST(Ties, HoldPlaceAndOrientation) {
  const Ties ties = TiesOf(ArmPoses());
  EXPECT_EQ(ties.tied, 1);
  EXPECT_EQ(ties.loose, 0);
  EXPECT_GE(ties.stiffeners.size(), 12u);
  EXPECT_LE(ties.stiffeners.size(), 18u);
  EXPECT_TRUE(std::is_sorted(ties.stiffeners.begin(), ties.stiffeners.end()));
  const int arm = static_cast<int>(Arm().vertices.cols());
  Eigen::MatrixXd derivative(ties.stiffeners.size(), 6);
  for (size_t i = 0; i < ties.stiffeners.size(); ++i) {
    const auto [a, b] = ties.stiffeners[i];
    EXPECT_LT(a, arm);
    EXPECT_GE(b, arm);
    const Shape& shape = ArmPoses()[0].vertices;
    const Eigen::Vector3d along = (shape.col(b) - shape.col(a)).normalized();
    const Eigen::Vector3d from = shape.col(b) - Eigen::Vector3d(1.6, 0, 0);
    derivative.row(i) << along.transpose(), from.cross(along).transpose();
  }
  const Eigen::VectorXd singular = derivative.jacobiSvd().singularValues();
  EXPECT_GT(singular(5) / singular(0), 0.1);
}

TEST(Ties, AMeshOfOneComponentIsLeftAsItIs) {
  Part bent = Arm();
  bent.vertices = Bent(bent.vertices, 120);
  const Poses tied = PosesOf({Arm(), bent}), loose = PosesOf({Arm(), bent}, Loose());
  EXPECT_EQ(tied.connectivity->Edges(), loose.connectivity->Edges());
  EXPECT_TRUE(tied.notes.empty());
}

TEST(Ties, AreSaidAndCanBeLeftOut) {
  const Poses tied = PosesOf(ArmPoses()), loose = PosesOf(ArmPoses(), Loose());
  EXPECT_EQ(NumComponents(tied), 1);
  EXPECT_EQ(tied.notes.size(), 1u);
  EXPECT_TRUE(tied.warnings.empty());
  EXPECT_EQ(NumComponents(loose), 2);
  EXPECT_TRUE(loose.notes.empty());
  EXPECT_EQ(WithoutStiffeners(tied.connectivity)->Edges(), loose.connectivity->Edges());
  EXPECT_EQ(WithoutStiffeners(loose.connectivity), loose.connectivity);
}

TEST(Ties, WhatStiffenersConnectAlreadyIsNotTied) {
  Poses poses = PosesOf(ArmPoses(), Loose());
  poses.connectivity = WithStiffeners(*poses.connectivity, {{200, 450}});
  const auto before = poses.connectivity;
  TieComponents(&poses);
  EXPECT_EQ(poses.connectivity, before);
}

TEST(Ties, WhatPartsSlidesOrTurnsIsNotTied) {
  const auto none = [](const std::vector<Part>& poses, int loose) {
    const Ties ties = TiesOf(poses);
    EXPECT_EQ(ties.tied, 0);
    EXPECT_EQ(ties.loose, loose);
    EXPECT_TRUE(ties.stiffeners.empty());
  };
  // In the pose that is spread most the ball is far away.
  const Part held = Together({Arm(), Ball({3.6, 0, 0}, 0.5)});
  none({held, Together({Arm(), Ball({5, 3, 2}, 0.5)})}, 0);
  none({held, Together({Arm(), Ball({-3.6, 0, 0}, 0.5)})}, 1);
  EXPECT_EQ(TiesOf({held}).tied, 1);
  EXPECT_EQ(TiesOf({held, held}).tied, 1);
  none({BentArmWithBracelet(0, 1.2), BentArmWithBracelet(90, 2)}, 1);
  // By as much to either side of a row of the arm's vertices, to which distances are the same.
  none({BentArmWithBracelet(0, 1.25), BentArmWithBracelet(0, 1.75)}, 1);
  none({BentArmWithBracelet(0), BentArmWithBracelet(0, 1.6, 0.62, 1)}, 1);
  // Twice as far away, in the one pose there is.
  EXPECT_EQ(TiesOf({Together({Arm(), Ball({4.1, 0, 0}, 0.5)})}).tied, 0);
}

TEST(Ties, DoNotDependOnFramesUnitsOrderOrThreads) {
  const std::vector<Part> poses = {BentArmWithBracelet(0), BentArmWithBracelet(50),
                                   BentArmWithBracelet(120)};
  const Pairs expected = TiesOf(poses).stiffeners;
  EXPECT_FALSE(expected.empty());
  EXPECT_EQ(TiesOf({poses[2], poses[0], poses[1]}).stiffeners, expected);
  std::vector<Part> moved = poses;
  for (size_t i = 0; i < moved.size(); ++i) {
    const Eigen::Matrix3d turn =
        Eigen::AngleAxisd(1.0 + i, Eigen::Vector3d(1, 2, 3).normalized()).matrix();
    moved[i].vertices = (1000 * (i + 1.0) * turn * moved[i].vertices).colwise() +
                        Eigen::Vector3d(1e6, -2e6, 5e5) * (1000.0 * i);
  }
  EXPECT_EQ(TiesOf(moved).stiffeners, expected);
  for (const Pairs& pairs : testing::OnThreads([&] { return TiesOf(poses).stiffeners; })) {
    EXPECT_EQ(pairs, expected);
  }
}

// Forty locks on a ball, each of them near others too: a tree, and a handful of stiffeners each.
TEST(Ties, ConnectComponentsToATree) {
  std::vector<Part> parts = {Ball({0, 0, 0}, 1)};
  for (int i = 0; i < 40; ++i) {
    const double turn = 2.4 * i, height = -0.6 + 0.03 * i;
    const Eigen::Vector3d out(height, std::sqrt(1 - height * height) * std::cos(turn),
                              std::sqrt(1 - height * height) * std::sin(turn));
    const Eigen::Vector3d side = out.cross(Eigen::Vector3d::UnitX()).normalized();
    Part lock = {Shape(3, 12), Eigen::Matrix3Xi(3, 10)};
    for (int v = 0; v < 12; ++v) {
      lock.vertices.col(v) = (1 + 0.1 * (v / 2)) * out + 0.03 * (v % 2) * side;
    }
    for (int f = 0; f < 10; ++f) lock.triangles.col(f) << f, f + 1 + f % 2, f + 2 - f % 2;
    parts.push_back(lock);
  }
  Part all = Together(parts), longer = all;
  longer.vertices.row(0) *= 1.15;
  const Poses poses = PosesOf({all, longer});
  EXPECT_EQ(NumComponents(poses), 1);
  const Ties ties = TiesOf({all, longer});
  EXPECT_EQ(ties.tied, 40);
  EXPECT_LE(ties.stiffeners.size(), 40u * 18);
  // The ball is the largest that is as near as the locks are to each other.
  const int ball = static_cast<int>(parts[0].vertices.cols());
  for (const auto& [a, b] : ties.stiffeners) EXPECT_LT(a, ball);
}

// A hair of segments that is joined to no vertex.
TEST(Ties, SegmentsAreComponentsToo) {
  Soup soup = MakeSoup(Arm().vertices, Arm().triangles, Layout::kColumns);
  const int arm = soup.NumVertices();
  soup.vertices.conservativeResize(3, arm + 6);
  for (int k = 0; k < 6; ++k) {
    soup.vertices.col(arm + k) << 1.6 + 0.05 * k * k, 0, 0.52 + 0.1 * k;
    if (k > 0) soup.segments.emplace_back(arm + k - 1, arm + k);
  }
  Soup bent = soup;
  bent.vertices = Bent(bent.vertices, 120);
  EXPECT_EQ(NumComponents(MakePoses({soup, bent})), 1);
  bent.vertices.rightCols(6).array() += 1;
  EXPECT_EQ(NumComponents(MakePoses({soup, bent})), 2);
}

TEST(Ties, AreOnAllLevels) {
  const Poses poses = PosesOf(ArmPoses());
  HierarchyOptions options;
  options.coarsest = 100;
  const Hierarchy hierarchy(poses.connectivity, poses.shapes, options);
  ASSERT_GT(hierarchy.NumLevels(), 1);
  for (int level = 0; level < hierarchy.NumLevels(); ++level) {
    const Connectivity& here = *hierarchy.LevelConnectivity(level);
    EXPECT_EQ(ComputeTopology(here).components, 1) << level;
    EXPECT_GE(here.NumEdges() - here.NumTriangleEdges(), 6) << level;
  }
}

TEST(Ties, ABraceletStaysRoundTheArmBetweenPoses) {
  GeodesicOptions options;
  options.shapes = 3;
  const auto farthest = [&](const Poses& poses) {
    double off = 0;
    for (const Shape& shape : Interpolate(poses, options).path.Placed()) {
      off = std::max(off, BraceletOff(shape));
    }
    return off;
  };
  EXPECT_LT(farthest(PosesOf(ArmPoses())), kOff);
  EXPECT_GT(farthest(PosesOf(ArmPoses(), Loose())), kOff);
}

TEST(Ties, ABraceletStaysRoundTheArmBeyondPoses) {
  const Poses poses = PosesOf({BentArmWithBracelet(0), BentArmWithBracelet(60)});
  GeodesicOptions options;
  options.shapes = 3;
  const Path path = Interpolate(poses, options).path;
  for (const Shape& shape : Extrapolate(path, 2).path.Placed()) EXPECT_LT(BraceletOff(shape), kOff);
}

TEST(Ties, ABraceletStaysRoundTheArmInSplinesAndMeans) {
  const Poses poses =
      PosesOf({BentArmWithBracelet(0), BentArmWithBracelet(40), BentArmWithBracelet(120)});
  SplineOptions options;
  options.geodesic.shapes = 3;
  for (const Shape& shape : Spline(poses, options).path.Placed()) {
    EXPECT_LT(BraceletOff(shape), kOff);
  }
  AverageOptions average;
  average.certify = false;
  EXPECT_LT(BraceletOff(Average(poses, average).shape), kOff);
}

TEST(Ties, ABraceletStaysRoundTheArmInATransfer) {
  const Part wider = BentArmWithBracelet(20, 1.6, 0.7);
  const Poses poses = PosesOf({ArmPoses()[0], ArmPoses()[1], wider});
  GeodesicOptions options;
  options.shapes = 3;
  const Path path =
      Interpolate(poses.connectivity, {poses.shapes[0], poses.shapes[1]}, options).path;
  for (const Shape& shape : Transfer(path, poses.shapes[2]).path.Placed()) {
    EXPECT_LT(BraceletOff(shape), kOff);
  }
}

// A handle at the end x > 0 of the arm lifts it; the bracelet has none.
TEST(Ties, ABraceletMovesWithTheArmThatHandlesMove) {
  const Poses poses = PosesOf({BentArmWithBracelet(0)});
  const int arm = static_cast<int>(Arm().vertices.cols());
  DeformationHandle root, hand;
  for (int v = 0; v < arm; ++v) {
    if (poses.shapes[0](0, v) < -2.6) root.vertices.push_back(v);
    if (poses.shapes[0](0, v) > 2.6) hand.vertices.push_back(v);
  }
  hand.motion.translation = {-0.5, 0, 2};
  const auto deform = [&](const Poses& of) {
    return Deform(of.connectivity, of.shapes[0], {root, hand});
  };
  const DeformationResult tied = deform(poses);
  EXPECT_LT(BraceletOff(tied.path.Placed(tied.path.NumShapes() - 1)), 2 * kOff);
  EXPECT_EQ(tied.summary.free_components, 0);
  const DeformationResult loose = deform(PosesOf({BentArmWithBracelet(0)}, Loose()));
  EXPECT_EQ(loose.summary.free_components, 1);
}

TEST(Picture, DoesNotShowStiffenersOfGraphs) {
  Shape square(3, 4);
  square << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
  const Pairs sides = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  FilmStripOptions options;
  options.frame_width = 64;
  const auto draw = [&](const Pairs& stiffeners) {
    return RenderFilmStrip(*Connectivity::Make(4, {0}, {}, sides, stiffeners), {square}, options);
  };
  EXPECT_TRUE(draw({{0, 2}}).pixels == draw({}).pixels);
}

}  // namespace
}  // namespace shapespace
