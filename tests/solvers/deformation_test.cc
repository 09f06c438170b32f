#include <shapespace/deformation/deformation.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <numeric>
#include <random>

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <shapespace/analysis/quality.h>
#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/mesh/topology.h>

#include "support/listener.h"
#include "support/message_of.h"
#include "support/motions.h"

namespace shapespace {
namespace {

using testing::Diameter;
using testing::Listener;
using testing::MessageOf;
using testing::Rotation;
using testing::Where;

DeformationHandle Fixed(std::vector<int> vertices) {
  DeformationHandle handle;
  handle.vertices = std::move(vertices);
  return handle;
}

DeformationHandle Moving(std::vector<int> vertices, const ScrewMotion& motion) {
  DeformationHandle handle = Fixed(std::move(vertices));
  handle.motion = motion;
  return handle;
}

DeformationHandle To(const Shape& rest, std::vector<int> vertices, const Eigen::Vector3d& way) {
  DeformationHandle handle = Fixed(std::move(vertices));
  handle.positions = rest(Eigen::all, handle.vertices).colwise() + way;
  return handle;
}

ScrewMotion Twist(double degrees) {
  ScrewMotion motion;
  motion.axis = Eigen::Vector3d::UnitX();
  motion.angle = degrees * M_PI / 180;
  return motion;
}

// A bar along x whose ends are handles.
struct HeldBar {
  ShapeFamily body = MakeBar(6, 1, 1, 24, 4, 4);
  Shape rest = body.pose(0);
  std::vector<int> left = Where(rest, [](const auto& p) { return p.x() < -2.7; });
  std::vector<int> right = Where(rest, [](const auto& p) { return p.x() > 2.7; });

  DeformationResult Solve(const ScrewMotion& motion, const DeformationOptions& options = {}) const {
    return Deform(body.connectivity, rest, {Fixed(left), Moving(right, motion)}, options);
  }
};

DeformationOptions Tight(double tolerance = 1e-10) {
  DeformationOptions options;
  options.tolerance = tolerance;
  options.max_iterations = 5000;
  return options;
}

double Largest(const Shape& a, const Shape& b) { return (a - b).cwiseAbs().maxCoeff(); }

Shape Last(const DeformationResult& result) {
  return result.path.Placed(result.path.NumShapes() - 1);
}

TEST(Deform, WithoutHandlesNothingMoves) {
  const HeldBar bar;
  const DeformationResult result = Deform(bar.body.connectivity, bar.rest, {});
  ASSERT_EQ(result.path.NumShapes(), 6);
  for (const Shape& shape : result.path.Placed()) EXPECT_LT(Largest(shape, bar.rest), 1e-13);
  EXPECT_TRUE(result.summary.Converged());
  EXPECT_LT(result.summary.energy, 1e-20);
  EXPECT_EQ(result.summary.free_components, 1);
}

// A single shape may lose a full turn; a path along which handles are followed does not.
TEST(Deform, OneShapeIsTwistedAsFarAsMany) {
  const HeldBar bar;
  ScrewMotion motion;
  motion.axis = {1, 0, 0};
  motion.angle = 250 * M_PI / 180;
  DeformationOptions one;
  one.shapes = 1;
  const double energy = bar.Solve(motion).summary.energy;
  EXPECT_NEAR(bar.Solve(motion, one).summary.energy / energy, 1, 0.05);
}

TEST(Deform, ARigidMotionOfAllHandlesMovesTheBodySo) {
  const HeldBar bar;
  ScrewMotion motion;
  motion.axis = {1, 2, -1};
  motion.angle = 4;
  motion.point = {0, 3, 0};
  motion.translation = {5, 0, 1};
  for (bool hard : {true, false}) {
    std::vector<DeformationHandle> handles = {Moving(bar.left, motion), Moving(bar.right, motion)};
    for (DeformationHandle& handle : handles) handle.hard = hard;
    const DeformationResult result = Deform(bar.body.connectivity, bar.rest, handles);
    EXPECT_TRUE(result.summary.Converged());
    EXPECT_LT(result.summary.energy, 1e-18);
    const Shape last = Last(result);
    for (int v = 0; v < last.cols(); ++v) {
      EXPECT_LT((last.col(v) - motion.At(1, bar.rest.col(v))).norm(), 1e-9);
    }
    EXPECT_LT(result.summary.error.edge_max, 1e-9);
  }
}

TEST(Deform, ASingleVertexTakesTheBodyAlong) {
  const HeldBar bar;
  const Eigen::Vector3d way(0, 0, 2);
  const DeformationResult result =
      Deform(bar.body.connectivity, bar.rest, {To(bar.rest, {7}, way)});
  EXPECT_LT(Largest(Last(result), bar.rest.colwise() + way), 1e-9);
  EXPECT_LT(result.summary.energy, 1e-18);
}

// Hard handles are met exactly: motions in all shapes, as a screw, positions in the last one.
TEST(Deform, HardHandlesAreMetExactly) {
  const HeldBar bar;
  ScrewMotion motion = Twist(100);
  motion.translation = {0.5, 0, 0};
  const std::vector<DeformationHandle> handles = {To(bar.rest, bar.left, {0, 0.3, 0.4}),
                                                  Moving(bar.right, motion)};
  const DeformationResult result = Deform(bar.body.connectivity, bar.rest, handles);
  const std::vector<Shape> placed = result.path.Placed();
  for (int i = 0; i <= 5; ++i) {
    for (int v : bar.right) {
      EXPECT_LT((placed[i].col(v) - motion.At(i / 5.0, bar.rest.col(v))).norm(), 1e-12);
    }
  }
  for (size_t k = 0; k < bar.left.size(); ++k) {
    EXPECT_LT((placed[5].col(bar.left[k]) - handles[0].positions->col(k)).norm(), 1e-12);
  }
  for (const auto& handle : result.summary.handles) EXPECT_LT(handle.residual_max, 1e-12);
}

// The mean angle about x by which the cross-section at each end of the bar's middle line has
// turned, summed cell by cell, so that full turns count.
double Turned(const Shape& rest, const Shape& shape) {
  double sum = 0;
  Eigen::Matrix3d before = Eigen::Matrix3d::Identity();
  for (double x = -3; x <= 3; x += 0.25) {
    const std::vector<int> section =
        Where(rest, [&](const auto& p) { return std::abs(p.x() - x) < 1e-9; });
    const Shape from = rest(Eigen::all, section), to = shape(Eigen::all, section);
    const Eigen::Matrix3d turn =
        FitRigidMotion(from, to, Eigen::VectorXd::Ones(from.cols())).rotation;
    const Eigen::Matrix3d step = turn * before.transpose();
    sum += std::atan2(step(2, 1) - step(1, 2), step(1, 1) + step(2, 2));
    before = turn;
  }
  return sum * 180 / M_PI;
}

TEST(Deform, ATurnBy270DegreesIsNoTurnBy90) {
  const HeldBar bar;
  for (double degrees : {270.0, -90.0}) {
    const DeformationResult result = bar.Solve(Twist(degrees));
    EXPECT_NEAR(Turned(bar.rest, Last(result)), degrees, 1e-3);
    EXPECT_EQ(result.summary.error.inverted_hinges, 0);
  }
}

TEST(Deform, ASoftHandleFollowsALargeTurnToo) {
  const HeldBar bar;
  DeformationHandle handle = Moving(bar.right, Twist(270));
  handle.hard = false;
  DeformationOptions options;
  options.balance = 1e-4;
  const DeformationResult result =
      Deform(bar.body.connectivity, bar.rest, {Fixed(bar.left), handle}, options);
  EXPECT_NEAR(Turned(bar.rest, Last(result)), 270, 5);
}

TEST(Deform, TheBalanceLeadsFromTheHandlesToTheRestShape) {
  const HeldBar bar;
  DeformationHandle soft = To(bar.rest, bar.right, {0, 0, 1});
  soft.hard = false;
  double before = 0;
  for (double balance : {1e-6, 1e-3, 0.1, 0.9}) {
    DeformationOptions options = Tight(1e-8);
    options.balance = balance;
    const DeformationResult result =
        Deform(bar.body.connectivity, bar.rest, {Fixed(bar.left), soft}, options);
    const double residual = result.summary.handles[1].residual_rms;
    EXPECT_GT(residual, before);
    before = residual;
    if (balance == 1e-6) {
      EXPECT_LT(residual, 1e-4);
    }
  }
  DeformationOptions options;
  options.balance = 1;
  const DeformationResult result =
      Deform(bar.body.connectivity, bar.rest, {Fixed(bar.left), soft}, options);
  EXPECT_LT(Largest(Last(result), bar.rest), 1e-9);
}

// The meaning of the balance does not depend on equivalent ways to specify the same penalty.
TEST(Deform, TheBalanceMeansTheSameForAnyNumberOfHandlesOrShapes) {
  const HeldBar bar;
  DeformationHandle soft = To(bar.rest, bar.right, {0, 0, 1});
  soft.hard = false;
  DeformationOptions options = Tight();
  options.balance = 0.2;
  options.shapes = 3;
  const DeformationResult one =
      Deform(bar.body.connectivity, bar.rest, {Fixed(bar.left), soft}, options);
  const DeformationResult twice =
      Deform(bar.body.connectivity, bar.rest, {Fixed(bar.left), soft, soft}, options);
  EXPECT_LT(Largest(Last(one), Last(twice)), 1e-6);
  options.shapes = 6;
  const DeformationResult longer =
      Deform(bar.body.connectivity, bar.rest, {Fixed(bar.left), soft}, options);
  EXPECT_NEAR(longer.summary.handles[1].residual_rms, one.summary.handles[1].residual_rms,
              0.02 * one.summary.handles[1].residual_rms);
}

TEST(Deform, TheBalanceMeansTheSameAtAnyResolution) {
  double residuals[2];
  for (int fine : {0, 1}) {
    const ShapeFamily body = MakeBar(6, 1, 1, fine ? 36 : 18, fine ? 6 : 3, fine ? 6 : 3);
    const Shape rest = body.pose(0);
    const auto at = [&](double from, double to) {
      return Where(rest, [&](const auto& p) { return p.x() > from - 1e-9 && p.x() < to + 1e-9; });
    };
    DeformationHandle soft = To(rest, at(2, 3), {0, 0, 1});
    soft.hard = false;
    DeformationOptions options;
    options.balance = 0.2;
    residuals[fine] = Deform(body.connectivity, rest, {Fixed(at(-3, -2)), soft}, options)
                          .summary.handles[1]
                          .residual_rms;
  }
  EXPECT_NEAR(residuals[0], residuals[1], 0.15 * residuals[1]);
}

TEST(Deform, HardHandlesAreTheLimitOfSoftOnes) {
  const HeldBar bar;
  DeformationHandle hard = To(bar.rest, bar.right, {0, 0, 1}), soft = hard;
  soft.hard = false;
  const Shape limit =
      Last(Deform(bar.body.connectivity, bar.rest, {Fixed(bar.left), hard}, Tight()));
  double before = std::numeric_limits<double>::infinity();
  for (double balance : {1e-2, 1e-3, 1e-4, 1e-5}) {
    DeformationOptions options = Tight();
    options.balance = balance;
    const double distance = Largest(
        Last(Deform(bar.body.connectivity, bar.rest, {Fixed(bar.left), soft}, options)), limit);
    EXPECT_LT(distance, 0.3 * before);
    before = distance;
  }
}

TEST(Deform, IsTheSameInAnyFrameAndUnitAndFarAway) {
  const HeldBar bar;
  DeformationHandle left = To(bar.rest, bar.left, {0, 0, 0.2});
  left.hard = false;
  ScrewMotion motion = Twist(70);
  motion.translation = {0.2, 0.1, 0};
  const DeformationOptions options = Tight();
  const Shape expected =
      Last(Deform(bar.body.connectivity, bar.rest, {left, Moving(bar.right, motion)}, options));
  const Eigen::Matrix3d turn = Rotation(50, {1, -2, 3});
  for (const auto& [scale, away] : {std::make_pair(1e-3, 0.0), {1e3, 10.0}, {1.0, 1e6}}) {
    const Eigen::Vector3d shift(away, -away, 0.5 * away);
    const auto moved = [&, s = scale](const Shape& shape) -> Shape {
      return (s * turn * shape).colwise() + shift;
    };
    DeformationHandle there = left;
    there.positions = moved(*left.positions);
    ScrewMotion turned = motion;
    turned.axis = turn * motion.axis;
    turned.point = scale * turn * motion.point + shift;
    turned.translation = scale * turn * motion.translation;
    const Shape result = Last(Deform(bar.body.connectivity, moved(bar.rest),
                                     {there, Moving(bar.right, turned)}, options));
    EXPECT_LT(Largest(result, moved(expected)), 2e-6 * scale * Diameter(bar.rest)) << scale;
  }
}

TEST(Deform, IsTheSameForAnyOrderOfVertices) {
  const ShapeFamily body = MakeBar(6, 1, 1, 12, 2, 2);
  const Shape rest = body.pose(0);
  const int count = static_cast<int>(rest.cols());
  std::vector<int> to(count);
  std::iota(to.begin(), to.end(), 0);
  std::mt19937 generator(3);
  std::shuffle(to.begin(), to.end(), generator);
  Shape other(3, count);
  for (int v = 0; v < count; ++v) other.col(to[v]) = rest.col(v);
  Eigen::Matrix3Xi triangles = body.connectivity->Triangles();
  for (int& v : triangles.reshaped()) v = to[v];
  const auto solve = [&](const std::shared_ptr<const Connectivity>& connectivity,
                         const Shape& shape) {
    // One level only, because decimation depends on the order of vertices with equal costs.
    DeformationOptions options = Tight(1e-12);
    options.coarsest = 1000;
    return Last(Deform(connectivity, shape,
                       {Fixed(Where(shape, [](const auto& p) { return p.x() < -2.4; })),
                        Moving(Where(shape, [](const auto& p) { return p.x() > 2.4; }), Twist(60))},
                       options));
  };
  const Shape a = solve(body.connectivity, rest);
  const Shape b = solve(Connectivity::FromTriangles(count, triangles), other);
  for (int v = 0; v < count; ++v) EXPECT_LT((a.col(v) - b.col(to[v])).norm(), 1e-4);
}

TEST(Deform, OwnLbfgsAndCeresTrustRegionAgree) {
  const ShapeFamily body = MakeBar(6, 1, 1, 8, 2, 2);
  const Shape rest = body.pose(0);
  DeformationHandle soft =
      To(rest, Where(rest, [](const auto& p) { return std::abs(p.x()) < 0.1; }), {0, 0, 0.4});
  soft.hard = false;
  const std::vector<DeformationHandle> handles = {
      Fixed(Where(rest, [](const auto& p) { return p.x() < -2.9; })),
      To(rest, Where(rest, [](const auto& p) { return p.x() > 2.9; }), {0, 0.5, 0.3}), soft};
  DeformationOptions options = Tight(1e-13);
  options.shapes = 3;
  const DeformationResult own = Deform(body.connectivity, rest, handles, options);
  options.solver = DeformationOptions::Solver::kTrustRegion;
  const DeformationResult ceres = Deform(body.connectivity, rest, handles, options);
  EXPECT_TRUE(own.summary.Converged());
  EXPECT_TRUE(ceres.summary.Converged());
  const double value = own.summary.levels.back().value;
  EXPECT_NEAR(ceres.summary.levels.back().value, value, 1e-9 * value);
  for (int i = 0; i <= 3; ++i) {
    EXPECT_LT(Largest(own.path.Placed(i), ceres.path.Placed(i)), 1e-4);
  }
}

TEST(Deform, KeepsTheVolumeThatIsAskedFor) {
  const HeldBar bar;
  DeformationOptions options;
  options.metric = MetricOptions::Deformation(*bar.body.connectivity, bar.rest);
  EXPECT_LT(bar.Solve(Twist(360), options).summary.error.volume, -0.1);
  options.metric->volume = 30;
  EXPECT_LT(std::abs(bar.Solve(Twist(360), options).summary.error.volume), 0.003);
}

// Two copies of a sheet, one on the other and sewn together along the border: a closed mesh that
// encloses no volume.
TEST(Deform, BendsAFlatPillowAsASheet) {
  const ShapeFamily sheet = MakeSheet(2, 1, 16, 8);
  const Shape flat = sheet.pose(0);
  int count = static_cast<int>(flat.cols());
  std::vector<int> copy(count, -1), original;
  const Topology topology = ComputeTopology(*sheet.connectivity);
  for (int v : topology.boundary_loops[0]) copy[v] = v;
  for (int v = 0; v < flat.cols(); ++v) {
    if (copy[v] >= 0) continue;
    copy[v] = count++;
    original.push_back(v);
  }
  const Eigen::Matrix3Xi& front = sheet.connectivity->Triangles();
  Eigen::Matrix3Xi triangles(3, 2 * front.cols());
  for (int f = 0; f < front.cols(); ++f) {
    const Eigen::Vector3i t = front.col(f);
    triangles.col(f) = t;
    triangles.col(front.cols() + f) << copy[t(0)], copy[t(2)], copy[t(1)];
  }
  Shape rest(3, count);
  rest << flat, flat(Eigen::all, original);
  const auto pillow = Connectivity::FromTriangles(count, triangles);

  const double least = rest.row(0).minCoeff(), most = rest.row(0).maxCoeff();
  ScrewMotion bend;
  bend.axis = Eigen::Vector3d::UnitY();
  bend.angle = -0.5;
  const std::vector<DeformationHandle> handles = {
      Fixed(Where(rest, [&](const auto& p) { return p.x() < least + 0.2; })),
      Moving(Where(rest, [&](const auto& p) { return p.x() > most - 0.2; }), bend)};
  // Coordinates of files are rounded, so that the volume is seldom exactly zero.
  for (double rounding : {0.0, 1e-7}) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> noise(-rounding, rounding);
    const Shape given = rest.unaryExpr([&](double x) { return x + noise(random); });
    const DeformationResult result = Deform(pillow, given, handles);
    EXPECT_TRUE(result.summary.Converged());
    EXPECT_EQ(result.summary.metric.find("volume"), std::string::npos) << result.summary.metric;
    EXPECT_LT(result.summary.error.edge_rms, 0.05);
  }
}

// A sheet whose edge is rotated: bending without stretching is possible, so lengths should not
// change.
TEST(Deform, ASheetBentByItsEdgesStaysIsometric) {
  const ShapeFamily sheet = MakeSheet(2, 1, 32, 16);
  const Shape rest = sheet.pose(0), rolled = sheet.pose(150);
  const auto end = [&](double from, double to) {
    return Where(rest, [&](const auto& p) { return p.x() > from && p.x() < to; });
  };
  std::vector<DeformationHandle> handles;
  for (const auto& [from, to] : {std::make_pair(-2.0, -0.9), {0.9, 2.0}}) {
    handles.push_back(Fixed(end(from, to)));
    handles.back().positions = rolled(Eigen::all, handles.back().vertices);
  }
  MetricOptions metric;
  metric.lambda = 0;
  DeformationOptions options;
  options.metric = metric;
  const DeformationResult result = Deform(sheet.connectivity, rest, handles, options);
  EXPECT_LT(result.summary.error.edge_rms, 3e-3);
  // It also lies on the cylinder, the surface with the least bending.
  EXPECT_LT(Largest(Last(result), rolled), 0.05);
}

TEST(Deformer, WarmIsCold) {
  const HeldBar bar;
  const DeformationOptions options = Tight();
  Deformer deformer(bar.body.connectivity, bar.rest, options);
  EXPECT_FALSE(deformer.Deform({Fixed(bar.left), Moving(bar.right, Twist(60))}).summary.warm);
  const DeformationResult warm = deformer.Deform({Fixed(bar.left), Moving(bar.right, Twist(63))});
  EXPECT_TRUE(warm.summary.warm);
  const DeformationResult cold = bar.Solve(Twist(63), options);
  EXPECT_NEAR(warm.summary.energy, cold.summary.energy, 1e-8 * cold.summary.energy);
  for (int i = 0; i <= options.shapes; ++i) {
    EXPECT_LT(Largest(warm.path.Placed(i), cold.path.Placed(i)), 1e-3);
  }
  EXPECT_LT(warm.summary.levels.back().iterations, cold.summary.levels.back().iterations);
}

// Full turns lead to the same positions, but are not a small change.
TEST(Deformer, FullTurnsAreNotWarm) {
  const HeldBar bar;
  Deformer deformer(bar.body.connectivity, bar.rest);
  deformer.Deform({Fixed(bar.left), Moving(bar.right, Twist(0))});
  const DeformationResult result =
      deformer.Deform({Fixed(bar.left), Moving(bar.right, Twist(540))});
  EXPECT_FALSE(result.summary.warm);
  EXPECT_NEAR(Turned(bar.rest, Last(result)), 540, 1);
}

TEST(Deformer, OtherHandlesAreSolvedAnew) {
  const HeldBar bar;
  Deformer deformer(bar.body.connectivity, bar.rest);
  deformer.Deform({Fixed(bar.left), Moving(bar.right, Twist(30))});
  const std::vector<DeformationHandle> handles = {Fixed(bar.right),
                                                  To(bar.rest, {bar.left[0]}, {0, 0, 0.1})};
  const DeformationResult again = deformer.Deform(handles);
  EXPECT_FALSE(again.summary.warm);
  EXPECT_EQ(Last(again), Last(Deform(bar.body.connectivity, bar.rest, handles)));
}

TEST(Deformer, OtherWeightsOfSoftHandlesAreSolvedAnew) {
  const HeldBar bar;
  DeformationHandle up = To(bar.rest, bar.right, {0, 0, 0.05}), down = up;
  *down.positions -= Eigen::Vector3d(0, 0, 0.1).replicate(1, bar.right.size());
  up.hard = down.hard = false;
  Deformer deformer(bar.body.connectivity, bar.rest);
  const DeformationResult first = deformer.Deform({Fixed(bar.left), up, down});
  up.weight = 9;
  const std::vector<DeformationHandle> handles = {Fixed(bar.left), up, down};
  const DeformationResult again = deformer.Deform(handles);
  EXPECT_FALSE(again.summary.warm);
  EXPECT_EQ(Last(again), Last(Deform(bar.body.connectivity, bar.rest, handles)));
  EXPECT_LT(again.summary.handles[1].residual_rms, 0.5 * first.summary.handles[1].residual_rms);
}

// Vertices that a hard handle holds are not pulled by soft ones.
TEST(Deformer, ASoftHandleUnderHardOnesChangesNothing) {
  const HeldBar bar;
  DeformationHandle under = To(bar.rest, {bar.right[0]}, {0, 0, 1});
  under.hard = false;
  Deformer deformer(bar.body.connectivity, bar.rest);
  const std::vector<DeformationHandle> handles = {Fixed(bar.left), Moving(bar.right, Twist(30))};
  const DeformationResult first = deformer.Deform(handles);
  const DeformationResult again = deformer.Deform({handles[0], handles[1], under});
  EXPECT_TRUE(again.summary.warm);
  EXPECT_LT(Largest(Last(again), Last(first)), 0.01);
  EXPECT_TRUE(deformer.Deform(handles).summary.warm);
}

TEST(Deformer, StartsFromAGivenEnd) {
  const HeldBar bar;
  const DeformationOptions options = Tight();
  const DeformationResult wanted = bar.Solve(Twist(60), options);
  Deformer deformer(bar.body.connectivity, bar.rest, options);
  const std::vector<DeformationHandle> handles = {Fixed(bar.left), Moving(bar.right, Twist(60))};
  const DeformationResult found = deformer.DeformFrom(Last(wanted), handles);
  EXPECT_EQ(found.summary.levels.front().start, "given");
  EXPECT_NEAR(found.summary.energy, wanted.summary.energy, 1e-6 * wanted.summary.energy);
}

TEST(Deformer, StartsFromAGivenEndWhateverItSolvedBefore) {
  const HeldBar bar;
  const std::vector<DeformationHandle> handles = {Fixed(bar.left), Moving(bar.right, Twist(60))};
  Deformer fresh(bar.body.connectivity, bar.rest), used(bar.body.connectivity, bar.rest);
  const Shape end = Last(used.Deform(handles)).colwise() + Eigen::Vector3d(0.3, 0, 0);
  const DeformationResult found = used.DeformFrom(end, handles);
  EXPECT_FALSE(found.summary.warm);
  EXPECT_EQ(found.summary.levels.front().start, "given");
  EXPECT_EQ(Last(found), Last(fresh.DeformFrom(end, handles)));
}

TEST(Deformer, MeetsHardHandlesFromAnEndThatDoesNot) {
  const HeldBar bar;
  const std::vector<DeformationHandle> handles = {Fixed(bar.left), Moving(bar.right, Twist(10))};
  for (const int coarsest : {100, 100000}) {  // several levels, and one alone
    DeformationOptions options = Tight();
    options.coarsest = coarsest;
    Deformer deformer(bar.body.connectivity, bar.rest, options);
    const DeformationResult found = deformer.DeformFrom(bar.rest, handles);
    for (const auto& handle : found.summary.handles) {
      EXPECT_LT(handle.residual_max, 1e-12) << coarsest;
    }
    EXPECT_GT(found.summary.energy, 0) << coarsest;
  }
}

TEST(Deformer, RefusesAnEndThatIsNotAShapeOfTheMesh) {
  const HeldBar bar;
  Deformer deformer(bar.body.connectivity, bar.rest);
  const std::vector<DeformationHandle> handles = {Fixed(bar.left), Moving(bar.right, Twist(30))};
  const Shape half = bar.rest.leftCols(bar.rest.cols() / 2);
  Shape infinite = bar.rest;
  infinite(1, 2) = std::numeric_limits<double>::infinity();
  for (const Shape& end : {half, infinite}) {
    const std::string message = MessageOf<MeshError>([&] { deformer.DeformFrom(end, handles); });
    EXPECT_EQ(message.find("the end "), 0u) << message;
  }
}

TEST(Deform, ContradictoryHandlesMeetHalfWayAndAreToldOf) {
  const HeldBar bar;
  DeformationHandle up = To(bar.rest, bar.right, {0, 0, 1}),
                    down = To(bar.rest, bar.right, {0, 0, -1});
  up.name = "up";
  const DeformationResult result =
      Deform(bar.body.connectivity, bar.rest, {Fixed(bar.left), up, down});
  EXPECT_TRUE(result.summary.Converged());
  EXPECT_NEAR(result.summary.handles[1].residual_max, 1, 1e-12);
  EXPECT_NEAR(result.summary.handles[2].residual_rms, 1, 1e-12);
  ASSERT_EQ(result.summary.warnings.size(), 2u);
  EXPECT_NE(result.summary.warnings[0].find("\"up\""), std::string::npos);
}

// Two bars, of which one has handles.
TEST(Deform, APieceWithoutHandleStaysAndIsNamed) {
  const HeldBar bar;
  const int count = static_cast<int>(bar.rest.cols());
  const Eigen::Matrix3Xi& triangles = bar.body.connectivity->Triangles();
  Eigen::Matrix3Xi both(3, 2 * triangles.cols());
  both << triangles, triangles.array() + count;
  Shape rest(3, 2 * count);
  rest << bar.rest, bar.rest.colwise() + Eigen::Vector3d(0, 5, 0);
  const DeformationResult result = Deform(Connectivity::FromTriangles(2 * count, both), rest,
                                          {Fixed(bar.left), Moving(bar.right, Twist(90))});
  EXPECT_EQ(result.summary.free_components, 1);
  ASSERT_EQ(result.summary.warnings.size(), 1u);
  EXPECT_NE(result.summary.warnings[0].find("vertex " + std::to_string(count + 1)),
            std::string::npos);
  for (const Shape& shape : result.path.Placed()) {
    EXPECT_LT(Largest(shape.rightCols(count), rest.rightCols(count)), 1e-12);
  }
}

TEST(Deform, TakesCollapsedAndRepeatedTriangles) {
  const HeldBar bar;
  const Eigen::Matrix3Xi& good = bar.body.connectivity->Triangles();
  Eigen::Matrix3Xi triangles(3, good.cols() + 2);
  triangles << good, good.col(100), Eigen::Vector3i(5, 6, 5);
  Shape rest = bar.rest;
  const Eigen::Vector3i collapsed = good.col(200);
  rest.col(collapsed(1)) = rest.col(collapsed(0));
  const DeformationResult result =
      Deform(Connectivity::FromTriangles(static_cast<int>(rest.cols()), triangles), rest,
             {Fixed(bar.left), Moving(bar.right, Twist(90))});
  EXPECT_TRUE(Last(result).allFinite());
  EXPECT_TRUE(std::isfinite(result.summary.energy));
  EXPECT_NEAR(Turned(bar.rest, Last(result)), 90, 1);
}

TEST(Deform, TakesHundredsOfHandles) {
  const ShapeFamily tube = MakeTube(4000);
  const Shape rest = tube.pose(0), bent = tube.pose(60);
  std::vector<DeformationHandle> handles;
  for (int k = 0; k < 300; ++k) {
    const int v = static_cast<int>(k * rest.cols() / 300);
    handles.push_back(Fixed({v}));
    handles.back().positions = bent.col(v);
    handles.back().hard = k % 2 == 0;
  }
  DeformationOptions options;
  options.balance = 1e-4;
  const DeformationResult result = Deform(tube.connectivity, rest, handles, options);
  EXPECT_TRUE(result.summary.Converged());
  EXPECT_LT(Largest(Last(result), bent), 0.02 * Diameter(rest));
}

TEST(Deform, TakesAGraph) {
  std::vector<std::pair<int, int>> segments;
  Shape rest(3, 20);
  for (int v = 0; v < 20; ++v) {
    rest.col(v) << v, v % 2, 0;
    if (v > 0) segments.emplace_back(v - 1, v);
    if (v > 1) segments.emplace_back(v - 2, v);
  }
  const auto graph = Connectivity::Make(20, {0}, {}, segments);
  const DeformationResult result =
      Deform(graph, rest, {Fixed({0, 1}), To(rest, {18, 19}, {-1, 4, 0})});
  EXPECT_TRUE(result.summary.Converged());
  EXPECT_LT(result.summary.error.edge_rms, 0.05);
  EXPECT_TRUE(std::isnan(result.summary.error.volume));
}

TEST(Deform, RefusesWhatMakesNoSense) {
  const HeldBar bar;
  const auto of_handle = [&](const std::function<void(DeformationHandle*)>& change) {
    DeformationHandle handle = To(bar.rest, {3, 4}, {0, 0, 1});
    handle.name = "tip";
    change(&handle);
    return MessageOf<InvalidOptions>([&] {
      Deform(bar.body.connectivity, bar.rest, {Fixed({0}), handle});
    });
  };
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const auto& [change, what] :
       std::vector<std::pair<std::function<void(DeformationHandle*)>, std::string>>{
           {[](DeformationHandle* h) { h->vertices = {}; }, "has no vertex"},
           {[](DeformationHandle* h) {
              h->vertices = {3, 100000};
            },
            "vertex 100000"},
           {[](DeformationHandle* h) {
              h->vertices = {3, 3};
            },
            "listed twice"},
           {[](DeformationHandle* h) { h->vertices = {3}; }, "2 positions for 1"},
           {[&](DeformationHandle* h) { (*h->positions)(0, 0) = nan; }, "position"},
           {[](DeformationHandle* h) { h->motion.axis.setZero(); }, "axis"},
           {[&](DeformationHandle* h) { h->motion.angle = nan; }, "angle"},
           {[](DeformationHandle* h) { h->hard = false, h->weight = 0; }, "weight"}}) {
    const std::string message = of_handle(change);
    EXPECT_NE(message.find("handles: 1 (\"tip\")"), std::string::npos) << message;
    EXPECT_NE(message.find(what), std::string::npos) << message;
  }
  const auto of_options = [&](const std::function<void(DeformationOptions*)>& change) {
    DeformationOptions options;
    change(&options);
    const std::string message =
        MessageOf<InvalidOptions>([&] { Deform(bar.body.connectivity, bar.rest, {}, options); });
    return message.substr(0, message.find(':'));
  };
  EXPECT_EQ(of_options([](auto* o) { o->shapes = 0; }), "shapes");
  EXPECT_EQ(of_options([](auto* o) { o->balance = 0; }), "balance");
  EXPECT_EQ(of_options([](auto* o) { o->balance = 1.1; }), "balance");
  EXPECT_EQ(of_options([](auto* o) { o->tolerance = 0; }), "tolerance");
  EXPECT_EQ(of_options([](auto* o) { o->max_iterations = 0; }), "max_iterations");
  EXPECT_EQ(of_options([](auto* o) { o->coarsest = 1; }), "coarsest");
  EXPECT_EQ(of_options([](auto* o) { o->memory_limit = 0; }), "memory_limit");
  EXPECT_EQ(of_options([](auto* o) { o->metric = MetricOptions::Rigid(); }), "rigid");
  EXPECT_EQ(of_options([](auto* o) { o->metric = MetricOptions::Paper(); }), "discretization");
}

TEST(Deform, RefusesWhatIsTooLarge) {
  const HeldBar bar;
  DeformationOptions options;
  options.memory_limit = 1e5;
  EXPECT_THROW(bar.Solve(Twist(30), options), SolverError);
  const ShapeFamily large = MakeBar(6, 1, 1, 60, 20, 20);
  options = {};
  options.solver = DeformationOptions::Solver::kTrustRegion;  // its rows would be dense
  EXPECT_THROW(Deformer(large.connectivity, large.pose(0), options), InvalidOptions);
}

TEST(Deform, StopsWhenAskedTo) {
  const HeldBar bar;
  const std::vector<DeformationHandle> handles = {Fixed(bar.left), Moving(bar.right, Twist(90))};
  Listener first(1);
  EXPECT_THROW(Deform(bar.body.connectivity, bar.rest, handles, {}, &first), Cancelled);
  Listener all;
  Deform(bar.body.connectivity, bar.rest, handles, Tight(), &all);
  Listener late(all.reports - 2);
  const DeformationResult result = Deform(bar.body.connectivity, bar.rest, handles, Tight(), &late);
  EXPECT_EQ(result.summary.termination, Termination::kCancelled);
  EXPECT_FALSE(result.path.converged);
  EXPECT_EQ(result.path.NumShapes(), 6);
  EXPECT_LT(result.summary.handles[1].residual_max, 1e-12);
}

TEST(Deformer, StopsAtEveryReportWhenAskedTo) {
  const HeldBar bar;
  const std::vector<DeformationHandle> handles = {Fixed(bar.left), Moving(bar.right, Twist(60))};
  const Shape end = Last(bar.Solve(Twist(50)));
  const auto solve = [&](Progress* progress) {
    return Deformer(bar.body.connectivity, bar.rest).DeformFrom(end, handles, progress);
  };
  Listener all;
  solve(&all);
  for (int last = 1; last < all.reports; ++last) {
    Listener listener(last);  // counts it as a failure if there are further reports
    try {
      EXPECT_EQ(solve(&listener).summary.termination, Termination::kCancelled) << last;
    } catch (const Cancelled&) {
      continue;
    }
  }
}

// A path that was not finished is no start for the next one.
TEST(Deformer, IsNotWarmFromACancelledSolve) {
  const HeldBar bar;
  const auto twisted = [&](double degrees) -> std::vector<DeformationHandle> {
    return {Fixed(bar.left), Moving(bar.right, Twist(degrees))};
  };
  Listener all;
  Deform(bar.body.connectivity, bar.rest, twisted(90), Tight(), &all);
  Deformer deformer(bar.body.connectivity, bar.rest, Tight());
  Listener late(all.reports - 2);
  ASSERT_EQ(deformer.Deform(twisted(90), &late).summary.termination, Termination::kCancelled);
  const DeformationResult next = deformer.Deform(twisted(91));
  EXPECT_FALSE(next.summary.warm);
  EXPECT_EQ(next.summary.factor_seconds, 0);  // hierarchy and factors are kept
  EXPECT_EQ(Last(next), Last(bar.Solve(Twist(91), Tight())));

  // The last path that was finished remains one.
  Listener early(3);
  const DeformationResult stopped = deformer.Deform(twisted(94), &early);
  ASSERT_TRUE(stopped.summary.warm);
  ASSERT_EQ(stopped.summary.termination, Termination::kCancelled);
  EXPECT_FALSE(deformer.Deform(twisted(98)).summary.warm);  // 7 degrees from the finished one
}

// A single shape is compared with the first by the chord between them, which is short again after a
// full turn.
TEST(Deform, TooFewShapesForATurnAreToldOf) {
  const HeldBar bar;
  DeformationOptions options;
  options.shapes = 1;
  for (const double degrees : {360, -360}) {
    const DeformationSummary slipped = bar.Solve(Twist(degrees), options).summary;
    ASSERT_EQ(slipped.warnings.size(), 1u) << degrees;
    EXPECT_NE(slipped.warnings[0].find("turns by 360 degrees"), std::string::npos);
    EXPECT_NE(slipped.warnings[0].find("4 shapes or more"), std::string::npos);
  }
  EXPECT_TRUE(bar.Solve(Twist(360)).summary.warnings.empty());
}

TEST(Deform, OutOfIterationsIsSaid) {
  const HeldBar bar;
  DeformationOptions options = Tight();
  options.max_iterations = 2;
  const DeformationResult result = bar.Solve(Twist(90), options);
  EXPECT_EQ(result.summary.termination, Termination::kMaxIterations);
  EXPECT_FALSE(result.path.converged);
  const auto json = nlohmann::json::parse(result.summary.ToJson());
  EXPECT_EQ(json["termination"], "max_iterations");
  EXPECT_EQ(json["levels"].back()["termination"], "max_iterations");
}

}  // namespace
}  // namespace shapespace
