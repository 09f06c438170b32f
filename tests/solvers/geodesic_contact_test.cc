// Geodesics that do not pass through themselves.

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/analysis/intersections.h>
#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/files/read.h>
#include <shapespace/geodesic/geodesic.h>

#include "support/contact_bodies.h"
#include "support/cut_ring.h"
#include "support/listener.h"
#include "support/message_of.h"
#include "support/threads.h"

namespace shapespace {
namespace {

using testing::BallAndWall;
using testing::CubeAndBox;
using testing::CutRing;
using testing::MostIntersections;
using testing::TwoProngs;

GeodesicOptions AvoidingContact(int shapes) {
  GeodesicOptions options;
  options.shapes = shapes;
  options.avoid_contact = true;
  return options;
}

TEST(GeodesicContactTest, ACutRingOpensOnItsWay) {
  const CutRing ring;
  GeodesicOptions options = AvoidingContact(7);
  const GeodesicResult around = Interpolate(ring.connectivity, ring.poses, options);
  options.avoid_contact = false;
  const GeodesicResult through = Interpolate(ring.connectivity, ring.poses, options);
  EXPECT_GT(MostIntersections(through.path), 0);
  EXPECT_EQ(through.summary.uncertified_segments, -1);
  EXPECT_TRUE(std::isnan(through.summary.contact_distance));

  EXPECT_EQ(around.summary.termination, Termination::kConverged) << around.summary.FullReport();
  EXPECT_EQ(MostIntersections(around.path), 0);
  EXPECT_EQ(around.summary.uncertified_segments, 0);
  EXPECT_EQ(around.summary.crossings_between, 0);
  EXPECT_GT(around.summary.contact_distance, 0);
  EXPECT_EQ(around.path.NumShapes(), 9);
  EXPECT_GT(around.summary.energy, through.summary.energy);
  EXPECT_LT(around.summary.energy, 1.5 * through.summary.energy) << around.summary.FullReport();
  EXPECT_LT(around.summary.quality.speed_max, 1.3);
  // The poses are met.
  EXPECT_LT((around.path.Placed(0) - ring.poses[0]).norm(), 1e-12);
  EXPECT_LT((around.path.Placed(8) - ring.poses[1]).norm(), 1e-12);
}

// A straight line above a sheet, and below it in the last pose: a component of its own, as lines of
// OBJ files are.
struct LineAndSheet {
  LineAndSheet() {
    const Eigen::Matrix3Xi& triangles = sheet.connectivity->Triangles();
    std::vector<int> begin = {0};
    for (int t = 0; t < triangles.cols(); ++t) begin.push_back(3 * (t + 1));
    connectivity = Connectivity::Make(count + 2, begin,
                                      {triangles.data(), triangles.data() + triangles.size()},
                                      {{count, count + 1}});
  }
  // Its ends at these heights, over the middle of a triangle and far beside the sheet.
  Shape Pose(double over, double beside) const {
    Shape shape(3, count + 2);
    shape << sheet.pose(0), Eigen::Vector3d(0.02, 0.03, over), Eigen::Vector3d(0.1, 4, beside);
    return shape;
  }
  // Whether the line passes through the sheet, which is flat.
  bool Pierces(const Shape& shape) const {
    const Eigen::Vector3d a = shape.col(count), b = shape.col(count + 1);
    const auto corners = shape.leftCols(count);
    const Eigen::Vector3d normal =
        (corners.col(1) - corners.col(0))
            .cross(Eigen::Vector3d(corners.col(count - 1)) - corners.col(0));
    const double above = normal.dot(a - corners.col(0)), below = normal.dot(b - corners.col(0));
    if (above * below >= 0) return false;
    const Eigen::Vector3d at = a + above / (above - below) * (b - a);
    return (corners.colwise() - at).colwise().norm().minCoeff() < 0.3;
  }

  ShapeFamily sheet = MakeSheet(2, 2, 8, 8);
  int count = sheet.connectivity->NumVertices();
  std::shared_ptr<const Connectivity> connectivity;
};

TEST(GeodesicContactTest, SegmentsDoNotPassThroughSurfaces) {
  const LineAndSheet body;
  GeodesicOptions options = AvoidingContact(7);
  const auto pierces = [&](const Path& path) {
    bool any = false;
    for (int i = 0; i + 1 < path.NumShapes(); ++i) {
      for (double t : {0., 0.25, 0.5, 0.75}) {
        any = any || body.Pierces((1 - t) * path.shapes[i] + t * path.shapes[i + 1]);
      }
    }
    return any;
  };
  const std::vector<Shape> poses = {body.Pose(0.1, 0.9), body.Pose(-0.9, -0.1)};
  const GeodesicResult around = Interpolate(body.connectivity, poses, options);
  EXPECT_TRUE(around.summary.uncertified_segments > 0 || !pierces(around.path));
  // Where it stays on its side, nothing touches. Where it ends on the sheet in both poses, it may.
  const GeodesicSummary above =
      Interpolate(body.connectivity, {body.Pose(0.5, 0.9), body.Pose(0.3, 0.2)}, options).summary;
  EXPECT_EQ(above.uncertified_segments, 0);
  EXPECT_TRUE(above.warnings.empty()) << above.FullReport();
  const GeodesicSummary rooted =
      Interpolate(body.connectivity, {body.Pose(0, 0.9), body.Pose(0, 0.2)}, options).summary;
  EXPECT_EQ(rooted.uncertified_segments, 0) << rooted.FullReport();
  options.avoid_contact = false;
  EXPECT_TRUE(pierces(Interpolate(body.connectivity, poses, options).path));
}

TEST(GeodesicContactTest, SaysThatAnotherSolverFindsTheWayRound) {
  const CutRing ring;
  for (const GeodesicSolver solver : {GeodesicSolver::kAutomatic, GeodesicSolver::kThreadedLbfgs,
                                      GeodesicSolver::kLbfgs, GeodesicSolver::kTrustRegion}) {
    GeodesicOptions options = AvoidingContact(3);
    options.solver = solver;
    const GeodesicSummary summary = Interpolate(ring.connectivity, ring.poses, options).summary;
    const bool is_other =
        solver == GeodesicSolver::kLbfgs || solver == GeodesicSolver::kTrustRegion;
    EXPECT_EQ(summary.warnings.size(), is_other ? 1u : 0u) << summary.FullReport();
  }
}

TEST(GeodesicContactTest, EndsWhenItIsStopped) {
  const CutRing ring;
  for (const int last : testing::StopsSince("round contacts", [&](Progress* all) {
         Interpolate(ring.connectivity, ring.poses, AvoidingContact(3), all);
       })) {
    testing::Listener listener(last);  // counts it as a failure if there are further reports
    const GeodesicResult result =
        Interpolate(ring.connectivity, ring.poses, AvoidingContact(3), &listener);
    EXPECT_EQ(result.summary.termination, Termination::kCancelled) << last;
    EXPECT_EQ(result.path.NumShapes(), 5);
    for (const std::string& warning : result.summary.warnings) {
      EXPECT_EQ(warning.find("no way"), std::string::npos) << warning;
    }
  }
}

TEST(GeodesicContactTest, IsTheSameOnAnyThreads) {
  const CutRing ring;
  const auto results = testing::OnThreads(
      [&] { return Interpolate(ring.connectivity, ring.poses, AvoidingContact(3)).path.shapes; });
  for (const std::vector<Shape>& shapes : results) EXPECT_EQ(shapes, results.front());
}

TEST(GeodesicContactTest, ScalesWithTheBody) {
  const CutRing ring, large(1000);
  const GeodesicOptions options = AvoidingContact(3);
  const GeodesicResult a = Interpolate(ring.connectivity, ring.poses, options);
  const GeodesicResult b = Interpolate(large.connectivity, large.poses, options);
  EXPECT_EQ(b.summary.uncertified_segments, 0);
  EXPECT_NEAR(b.summary.energy, a.summary.energy, 1e-2 * a.summary.energy);
  EXPECT_NEAR(b.summary.contact_distance, 1000 * a.summary.contact_distance,
              0.2 * b.summary.contact_distance);
}

TEST(GeodesicContactTest, WithoutContactThePathIsTheSameBitForBit) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 16, 4, 4);
  const std::vector<Shape> poses = {bar.pose(0), bar.pose(70), bar.pose(20)};
  GeodesicOptions options = AvoidingContact(3);
  const GeodesicResult with = Interpolate(bar.connectivity, poses, options);
  options.avoid_contact = false;
  const GeodesicResult without = Interpolate(bar.connectivity, poses, options);
  EXPECT_EQ(with.path.shapes, without.path.shapes);
  EXPECT_EQ(with.path.Placed(), without.path.Placed());
  EXPECT_EQ(with.path.parameters, without.path.parameters);
  EXPECT_EQ(with.path.poses, without.path.poses);
  EXPECT_EQ(with.summary.uncertified_segments, 0);
  EXPECT_TRUE(with.summary.warnings.empty());
}

TEST(GeodesicContactTest, LeadsNearTheShapesThatAreNamed) {
  const CutRing ring;
  GeodesicOptions options = AvoidingContact(7);
  Shape open = ring.Open();
  open.colwise() += Eigen::Vector3d(5, 6, 7);
  options.via = {open};
  const GeodesicResult result = Interpolate(ring.connectivity, ring.poses, options);
  EXPECT_EQ(result.summary.uncertified_segments, 0) << result.summary.FullReport();
  EXPECT_EQ(MostIntersections(result.path), 0);
  EXPECT_EQ(result.path.NumShapes(), 9);
  EXPECT_EQ(result.path.poses, (std::vector<int>{0, 8}));
  EXPECT_EQ(result.summary.poses, 2);
  // That is another way than the one that is found without.
  options.via.clear();
  EXPECT_GT(result.summary.energy,
            Interpolate(ring.connectivity, ring.poses, options).summary.energy);
}

// What meets at flat faces, which press against each other without sliding.
void ExpectAWayRound(const std::shared_ptr<const Connectivity>& connectivity,
                     const std::vector<Shape>& poses, double most_energy,
                     const std::vector<Shape>& via = {}) {
  GeodesicOptions options = AvoidingContact(7);
  options.via = via;
  const GeodesicResult result = Interpolate(connectivity, poses, options);
  EXPECT_EQ(result.summary.termination, Termination::kConverged) << result.summary.FullReport();
  EXPECT_EQ(result.summary.uncertified_segments, 0);
  EXPECT_EQ(MostIntersections(result.path), 0);
  EXPECT_LT(result.summary.Ratio(), most_energy);
}

TEST(GeodesicContactTest, AProngPassesTheOther) {
  const TwoProngs fork;
  ExpectAWayRound(fork.connectivity, {fork.Pose({80, -60}, {0, 0}), fork.Pose({80, 60}, {0, 0})},
                  1.05);
}

TEST(GeodesicContactTest, ABodyPassesAnother) {
  const TwoProngs two(false);
  ExpectAWayRound(two.connectivity, {two.Pose({80, -60}, {0, 0}), two.Pose({70, 60}, {0, 0})},
                  1.02);
}

// From crossed one way to crossed the other way: they have to become straight in between. Between
// poses that are mirror images, rounding decides which way the legs go, and with it whether a way
// is found.
TEST(GeodesicContactTest, LegsUncrossAndCrossAgain) {
  const TwoProngs legs;
  const std::vector<Shape> poses = {legs.Pose({64, -52}, {64, 128}),
                                    legs.Pose({56, 60}, {56, 240})};
  ExpectAWayRound(legs.connectivity, poses, 1.2);
  ExpectAWayRound(legs.connectivity, poses, 1.2, {legs.Pose({0, 0}, {0, 0})});
}

TEST(GeodesicContactTest, EndsOfARingThatMeetSlideRoundEachOther) {
  const CutRing ring;
  for (const double front : {0.4, 0.7}) {
    ExpectAWayRound(ring.connectivity, {ring.Wound(front, 0.02), ring.Wound(-front, -0.03)}, 1.12);
  }
}

TEST(GeodesicContactTest, RefusesWhatItCannotDo) {
  const CutRing ring;
  GeodesicOptions options;
  options.via = {ring.poses[0]};
  const auto message = [&](const std::vector<Shape>& poses) {
    return testing::MessageOf<InvalidOptions>(
        [&] { Interpolate(ring.connectivity, poses, options); });
  };
  EXPECT_NE(message(ring.poses).find("avoid_contact"), std::string::npos);
  options.avoid_contact = true;
  EXPECT_NE(message({ring.poses[0], ring.poses[1], ring.poses[0]}).find("two poses"),
            std::string::npos);
  options.via = {Shape::Zero(3, 5)};
  EXPECT_THROW(Interpolate(ring.connectivity, ring.poses, options), MeshError);
  EXPECT_THROW(Interpolator(ring.connectivity, ring.poses, options), InvalidOptions);
  // A graph touches nothing.
  const auto graph = Connectivity::Make(3, {0}, {}, {{0, 1}, {1, 2}});
  const std::vector<Shape> ends = {Shape::Random(3, 3), Shape::Random(3, 3)};
  options.via.clear();
  EXPECT_NE(
      testing::MessageOf<MeshError>([&] { Interpolate(graph, ends, options); }).find("triangles"),
      std::string::npos);
}

TEST(GeodesicContactTest, PosesThatIntersectThemselvesAreSaidSo) {
  const CutRing ring;
  // The ends are within each other, and come apart.
  const std::vector<Shape> poses = {ring.Wound(0.25, 0.15), ring.poses[0]};
  const std::int64_t in_pose = CountIntersections(*ring.connectivity, poses[0]);
  ASSERT_GT(in_pose, 0);
  const GeodesicResult result = Interpolate(ring.connectivity, poses, AvoidingContact(3));
  ASSERT_EQ(result.summary.warnings.size(), 1);
  EXPECT_NE(result.summary.warnings[0].find("intersect themselves"), std::string::npos);
  EXPECT_EQ(result.summary.uncertified_segments, 0);
  EXPECT_LE(MostIntersections(result.path), in_pose);
}

TEST(GeodesicContactTest, WhereNoWayIsFoundThePathWithContactIsReturnedWithAWarning) {
  const CubeAndBox body(6);
  const auto& connectivity = body.connectivity;
  const std::vector<Shape> poses = {body.At(1), body.At(5)};
  ASSERT_EQ(CountIntersections(*connectivity, poses[0]), 0);
  GeodesicOptions options = AvoidingContact(3);
  const GeodesicResult result = Interpolate(connectivity, poses, options);
  options.avoid_contact = false;
  EXPECT_EQ(result.path.shapes, Interpolate(connectivity, poses, options).path.shapes);
  EXPECT_GT(result.summary.uncertified_segments, 0);
  ASSERT_FALSE(result.summary.warnings.empty());
  EXPECT_TRUE(testing::Names(result.summary.warnings[0], {"no way"}));
  // A second piece, beside the box, does not hide the first.
  const GeodesicResult chain =
      Interpolate(connectivity, {body.At(1), body.At(5), body.At(6)}, AvoidingContact(3));
  EXPECT_GT(chain.summary.uncertified_segments, 0);
}

TEST(ContinuedPathTest, EndsBeforeContactIfAskedTo) {
  const CutRing ring;
  const Path path = testing::ClosingPath(ring);
  constexpr int kSteps = 8;  // each of a twentieth of a turn: the ends meet in the sixth
  const ExponentialResult on = Extrapolate(path, kSteps);
  EXPECT_GT(CountIntersections(*ring.connectivity, on.path.Placed(10)), 0);

  ExponentialOptions stop;
  stop.stop_at_contact = true;
  const ExponentialResult result = Extrapolate(path, kSteps, stop);
  EXPECT_EQ(result.summary.ending, ExponentialSummary::Ending::kContact);
  EXPECT_TRUE(result.summary.Converged());
  EXPECT_NE(result.summary.stopped.find("step 6"), std::string::npos) << result.summary.stopped;
  ASSERT_EQ(result.path.NumShapes(), 8);
  EXPECT_EQ(MostIntersections(result.path), 0);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(result.path.shapes[i], on.path.shapes[i]) << i;
  EXPECT_EQ(Extrapolate(path, 5, stop).summary.ending, ExponentialSummary::Ending::kComplete);
}

GeodesicResult Solve(const BallAndWall& ball, int shapes) {
  GeodesicOptions options = AvoidingContact(shapes);
  options.obstacle = ball.wall;
  options.metric.lambda = 0.01;  // else it is almost free to fly up to the wall at once
  return Interpolate(ball.connectivity, ball.poses, options);
}

TEST(ObstacleTest, ABallSqueezesThroughAHoleNarrowerThanItself) {
  const BallAndWall narrow(0.9);
  const GeodesicResult result = Solve(narrow, 15);
  EXPECT_EQ(result.summary.termination, Termination::kConverged) << result.summary.FullReport();
  EXPECT_EQ(result.summary.uncertified_segments, 0);
  EXPECT_EQ(result.summary.crossings_between, 0);
  EXPECT_GT(result.summary.contact_distance, 0);
  EXPECT_TRUE(result.summary.warnings.empty()) << result.summary.warnings[0];
  EXPECT_EQ(MostIntersections(result.path, narrow.wall), 0);
  EXPECT_GT(result.summary.energy, 1e-3);
  EXPECT_LT((result.path.Placed(0) - narrow.poses[0]).norm(), 1e-12);
  EXPECT_LT((result.path.Placed(16) - narrow.poses[1]).norm(), 1e-12);
  // It goes on from shape to shape, and does not spin.
  double before = -3;
  for (const Shape& shape : result.path.Placed()) {
    EXPECT_GT(shape.row(0).mean(), before);
    before = shape.row(0).mean();
  }
}

TEST(ObstacleTest, PastAnObstacleThatIsNotInTheWayABodyMovesRigidly) {
  const BallAndWall wide(1.2);
  const GeodesicResult result = Solve(wide, 3);
  EXPECT_EQ(result.summary.uncertified_segments, 0);
  EXPECT_LT(result.summary.energy, 1e-20);
  for (int i = 0; i <= 4; ++i) {
    EXPECT_LT((result.path.Placed(i) - wide.At(-2 + i)).norm(), 1e-12) << i;
  }
}

TEST(ObstacleTest, ThroughAWallWithoutAHoleThereIsNoWay) {
  const BallAndWall shut(0);
  const GeodesicResult result = Solve(shut, 3);
  EXPECT_GT(result.summary.uncertified_segments, 0);
  EXPECT_GT(result.summary.crossings_between, 0);
  ASSERT_FALSE(result.summary.warnings.empty());
  EXPECT_NE(result.summary.warnings[0].find("the obstacle"), std::string::npos);
  EXPECT_LT((result.path.Placed(2) - shut.At(0)).norm(), 1e-12);
}

TEST(ObstacleTest, UnitAndPlaceDoNotMatter) {
  const BallAndWall here(0.95), large(0.95, 1024);
  const GeodesicResult a = Solve(here, 7), b = Solve(large, 7);
  EXPECT_EQ(b.path.shapes, a.path.shapes);
  EXPECT_DOUBLE_EQ(b.summary.contact_distance, 1024 * a.summary.contact_distance);
  const BallAndWall far(0.95, 1, {1e6, -2e6, 3e6});
  const GeodesicResult c = Solve(far, 7);
  EXPECT_EQ(c.summary.uncertified_segments, 0);
  EXPECT_NEAR(c.summary.energy, a.summary.energy, 0.05 * a.summary.energy);
}

TEST(ObstacleTest, IsTheSameOnAnyThreads) {
  const BallAndWall ball(0.95);
  const auto results = testing::OnThreads([&] { return Solve(ball, 3).path.shapes; });
  for (const std::vector<Shape>& shapes : results) EXPECT_EQ(shapes, results.front());
}

TEST(ObstacleTest, PosesThatIntersectItAreSaidSo) {
  BallAndWall ball(1.2);
  // It begins within the wall, beside the hole.
  ball.poses[0] = ball.At(-0.2);
  ball.poses[0].row(1).array() += 1;
  ball.poses[1].row(1).array() += 1;
  const GeodesicResult result = Solve(ball, 3);
  ASSERT_FALSE(result.summary.warnings.empty());
  EXPECT_TRUE(testing::Names(result.summary.warnings[0], {"obstacle"}));
}

TEST(ObstacleTest, WhatIsNoObstacleIsRefused) {
  const BallAndWall ball(1.2);
  GeodesicOptions options;
  options.obstacle = ball.wall;
  EXPECT_NE(testing::MessageOf<InvalidOptions>([&] {
              Interpolate(ball.connectivity, ball.poses, options);
            }).find("avoid_contact"),
            std::string::npos);
  options.avoid_contact = true;
  EXPECT_THROW(Interpolator(ball.connectivity, ball.poses, options), InvalidOptions);
  options.obstacle->shape(0, 0) = std::nan("");
  EXPECT_THROW(Interpolate(ball.connectivity, ball.poses, options), MeshError);
  options.obstacle = {Connectivity::Make(2, {0}, {}, {{0, 1}}), Shape::Zero(3, 2)};
  EXPECT_NE(testing::MessageOf<MeshError>([&] {
              Interpolate(ball.connectivity, ball.poses, options);
            }).find("no triangles"),
            std::string::npos);
}

// Skipped if the real poses are missing.
TEST(GeodesicContactTest, AnArmSlidesRoundTheBody) {
  const std::filesystem::path folder = SHAPESPACE_DATA_DIR;
  const std::string first = (folder / "scape/5.obj").string(),
                    last = (folder / "scape/6.obj").string();
  if (folder.empty() || !std::filesystem::exists(first)) {
    GTEST_SKIP() << "no real meshes: set the CMake cache path SHAPESPACE_DATA_DIR";
  }
  const GeodesicResult result = Interpolate(ReadPoses({first, last}), AvoidingContact(7));
  EXPECT_EQ(result.summary.termination, Termination::kConverged) << result.summary.FullReport();
  EXPECT_EQ(result.summary.uncertified_segments, 0);
  EXPECT_EQ(MostIntersections(result.path), 0);
  EXPECT_LT(result.summary.Ratio(), 1.10) << result.summary.FullReport();
  EXPECT_LT(result.summary.quality.roughness, 1.3);
}

}  // namespace
}  // namespace shapespace
