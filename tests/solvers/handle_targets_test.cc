// What handles ask of the vertices of a mesh and of its coarser levels.

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/deformation/detail/handle_targets.h>
#include <shapespace/deformation/detail/held_level.h>
#include <shapespace/deformation/handle.h>

#include "support/message_of.h"
#include "support/motions.h"
#include "support/paths.h"

namespace shapespace::internal {
namespace {

using shapespace::testing::Distance;
using shapespace::testing::MessageOf;
using shapespace::testing::Names;
using shapespace::testing::Noise;
using shapespace::testing::Refuses;
using shapespace::testing::Rotation;
using shapespace::testing::Where;

// Vertices on a line, at x = 0, 1, 2, ...
Shape OnLine(int count) {
  Shape shape = Shape::Zero(3, count);
  for (int v = 0; v < count; ++v) shape(0, v) = v;
  return shape;
}

DeformationHandle At(std::vector<int> vertices, const Shape& positions, bool hard = true,
                     double weight = 1) {
  DeformationHandle handle;
  handle.vertices = std::move(vertices);
  handle.positions = positions;
  handle.hard = hard;
  handle.weight = weight;
  return handle;
}

DeformationHandle By(std::vector<int> vertices, const Eigen::Vector3d& way, double angle = 0) {
  DeformationHandle handle;
  handle.vertices = std::move(vertices);
  handle.motion.translation = way;
  handle.motion.angle = angle;
  return handle;
}

TEST(DeformationHandle, PositionsAreApproachedOnStraightLines) {
  Shape positions(3, 2);
  positions << 1, 10, 2, 20, 3, 40;
  const DeformationHandle handle = At({5, 2}, positions);
  EXPECT_TRUE(handle.Target(1, 0.25, {2, 4, 0}).isApprox(Eigen::Vector3d(4, 8, 10), 1e-15));
  EXPECT_TRUE(handle.Target(0, 1, {2, 4, 0}).isApprox(Eigen::Vector3d(1, 2, 3), 1e-15));
  const DeformationHandle moved = By({5, 2}, {4, 0, 8});
  EXPECT_TRUE(moved.Target(1, 0.25, {2, 4, 0}).isApprox(Eigen::Vector3d(3, 4, 2), 1e-15));
}

// Vertex 1 has a hard and a soft handle, vertex 2 two hard ones, vertex 6 two soft ones.
HandleTargets MixedTargets(const Eigen::Vector3d& origin = {1, 2, 3}, double unit = 2) {
  Shape two(3, 2), one(3, 1), soft(3, 2);
  two << 10, 20, 0, 4, 0, 8;
  one << 30, 6, -2;
  soft << 7, 9, 1, 5, 3, 1;
  return HandleTargets(
      {By({4, 1}, {0, 0, 6}), At({2, 1}, two.rowwise().reverse(), false, 5), At({2}, one),
       At({2}, two.col(0)), At({7, 6}, soft, false, 3), At({6}, two.col(1), false)},
      OnLine(9), origin, unit);
}

TEST(HandleTargets, HardHandlesTakePrecedenceAndMeansAreWeighted) {
  const HandleTargets targets = MixedTargets();
  EXPECT_EQ(targets.Held(), (std::vector<int>{1, 2, 4, 6, 7}));
  const bool carried[] = {true, false, true, false, false};
  const bool given[] = {true, true, true, false, false};
  for (int i = 0; i < 5; ++i) {
    EXPECT_EQ(targets.IsCarried(i), carried[i]) << i;
    EXPECT_EQ(targets.IsGiven(i), given[i]) << i;
  }
  // The places at the end, in the user's frame and unit.
  Shape last(3, 5);
  last.col(0) << 1, 0, 6;
  last.col(1) = Eigen::Vector3d(30 + 10, 6, -2) / 2;
  last.col(2) << 4, 0, 6;
  last.col(3) = (3 * Eigen::Vector3d(9, 5, 1) + Eigen::Vector3d(20, 4, 8)) / 4;
  last.col(4) << 7, 1, 3;
  const Eigen::Vector3d origin(1, 2, 3);
  EXPECT_TRUE(targets.At(1).isApprox((last.colwise() - origin) / 2, 1e-14));
  const Shape first = OnLine(9)(Eigen::all, targets.Held());
  const Shape third = (2 * first + last) / 3;
  EXPECT_TRUE(targets.At(1. / 3).isApprox((third.colwise() - origin) / 2, 1e-14));
}

TEST(HandleTargets, PenaltiesAreTheMeanOverSoftHandlesOfAreaWeightedMeans) {
  const HandleTargets targets = MixedTargets();
  // A level without vertices 0, 4 and 8, with areas that all differ.
  const std::vector<int> vertices = {1, 2, 3, 5, 6, 7};
  Eigen::VectorXd areas(6);
  areas << 1, 2, 3, 4, 5, 6;
  const PositionConstraints constraints = targets.Restrict(vertices, areas, 0.7);
  EXPECT_EQ(constraints.prescribed, (std::vector<int>{0}));
  EXPECT_EQ(constraints.prescribed_last, (std::vector<int>{1}));
  // Two of the three soft handles draw: the other one's vertices are held by hard ones.
  Eigen::VectorXd penalty = Eigen::VectorXd::Zero(6);
  penalty(4) = 0.7 / 2 * (3 * 5. / (5 + 6) + 1 * 5. / 5);
  penalty(5) = 0.7 / 2 * 3 * 6. / (5 + 6);
  EXPECT_TRUE(constraints.penalty.isApprox(penalty, 1e-14));
}

TEST(HandleTargets, TheGreatestTurnIsThatOfAHandleThatMovesRigidly) {
  DeformationHandle positions = At({3}, Shape::Zero(3, 1));
  positions.motion.angle = 9;
  const auto turn = [&](double a, double b) {
    return HandleTargets({By({0}, {0, 0, 0}, a), positions, By({1}, {0, 0, 0}, b)}, OnLine(4),
                         {0, 0, 0}, 1)
        .GreatestTurn();
  };
  EXPECT_EQ(turn(2, -3), 3);
  EXPECT_EQ(turn(4, -3), 4);
  EXPECT_EQ(turn(0, 0), 0);
}

TEST(HandleTargets, PinsAreFarFromEachOther) {
  const auto pins = [](const std::vector<DeformationHandle>& handles, const Shape& rest) {
    return HandleTargets(handles, rest, {0, 0, 0}, 1).Pins();
  };
  std::vector<int> all(33);
  for (int v = 0; v < 33; ++v) all[v] = v;
  const std::vector<int> of_line = pins({By(all, {0, 0, 0})}, OnLine(33));
  ASSERT_EQ(of_line.size(), 12u);
  EXPECT_EQ((std::vector<int>{of_line.begin(), of_line.begin() + 3}),
            (std::vector<int>{0, 32, 16}));
  for (size_t i = 0; i < of_line.size(); ++i) {
    for (size_t j = 0; j < i; ++j) EXPECT_GE(std::abs(of_line[i] - of_line[j]), 2);
  }
  // All of a small handle, and of vertices in one place only one.
  Shape rest = OnLine(9);
  rest.col(6) = rest.col(5);
  EXPECT_EQ(pins({By({2, 8, 3}, {0, 0, 0}), By({6, 5}, {0, 0, 0})}, rest),
            (std::vector<int>{2, 8, 3, 6}));
}

TEST(HandleTargets, AreAlikeIfTheyHoldTheSameVerticesInTheSameWay) {
  const Shape rest = OnLine(6), somewhere = Noise(2, 1, 4);
  const auto of = [&](const std::vector<DeformationHandle>& handles) {
    return HandleTargets(handles, rest, {0, 0, 0}, 1);
  };
  const DeformationHandle moved = By({1, 2}, {0, 0, 1}), soft = At({3, 4}, somewhere, false, 2);
  const HandleTargets one = of({moved, soft});
  EXPECT_TRUE(one.HoldAlike(of({By({1, 2}, {5, 0, 0}, 3), At({3, 4}, 9 * somewhere, false, 2)})));
  EXPECT_FALSE(one.HoldAlike(of({By({1}, {0, 0, 1}), soft})));
  EXPECT_FALSE(one.HoldAlike(of({By({1, 5}, {0, 0, 1}), soft})));
  EXPECT_FALSE(one.HoldAlike(of({moved, At({3, 4}, somewhere, false, 3)})));
  EXPECT_FALSE(one.HoldAlike(of({moved, At({3, 4}, somewhere, true, 2)})));
  EXPECT_FALSE(one.HoldAlike(of({At({1, 2}, somewhere), soft})));
  EXPECT_FALSE(one.HoldAlike(of({moved, soft, At({4}, somewhere.col(0), false)})));
  EXPECT_FALSE(one.HoldAlike(of({soft, moved})));
}

TEST(HandleTargets, AreNearIfNoPlaceIsFarOnTheWayOrAtItsEnd) {
  const Shape rest = OnLine(6);
  const auto of = [&](double z, double angle, const Eigen::Vector3d& axis) {
    DeformationHandle handle = By({1, 2}, {0, 0, z}, angle);
    handle.motion.axis = axis;
    handle.motion.point = {1.5, 0, 0};
    return HandleTargets({By({0}, {0, 0, 0}), handle}, rest, {0, 0, 0}, 1);
  };
  const Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  const HandleTargets one = of(1, 0.5, up);
  EXPECT_TRUE(one.IsNear(of(1.09, 0.5, up), 0.1));
  EXPECT_FALSE(one.IsNear(of(1.11, 0.5, up), 0.1));
  EXPECT_TRUE(one.IsNear(of(1, 0.59, up), 0.1));
  EXPECT_FALSE(one.IsNear(of(1, 0.61, up), 0.1));
  EXPECT_FALSE(one.IsNear(of(1, 0.39, up), 0.1));
  // Half a turn to either side has one end.
  EXPECT_FALSE(of(0, M_PI, up).IsNear(of(0, M_PI, -up), 0.1));
  EXPECT_TRUE(of(0, M_PI, up).IsNear(of(0, M_PI, up), 0));
}

TEST(HandleTargets, RefusalsNameTheHandleAndTheVertex) {
  const auto message = [](void (*change)(DeformationHandle*)) {
    DeformationHandle handle = At({3, 4}, OnLine(2));
    handle.name = "tip";
    change(&handle);
    return MessageOf<InvalidOptions>([&] {
      HandleTargets({By({0}, {0, 0, 0}), handle}, OnLine(6), {0, 0, 0}, 1);
    });
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  const std::string tip = "handles: 1 (\"tip\"): ";
  EXPECT_EQ(message([](DeformationHandle*) {}), "nothing was thrown");
  EXPECT_TRUE(Names(message([](DeformationHandle* h) { h->vertices = {}; }), {tip, "vertex"}));
  EXPECT_TRUE(Names(message([](DeformationHandle* h) {
                      h->vertices = {5, 6};
                    }),
                    {tip, "vertex 6", "0", "5"}));
  EXPECT_TRUE(Names(message([](DeformationHandle* h) {
                      h->vertices = {2, -1};
                    }),
                    {tip, "vertex -1", "0", "5"}));
  EXPECT_TRUE(Names(message([](DeformationHandle* h) {
                      h->vertices = {4, 2, 4};
                    }),
                    {tip, "vertex 4"}));
  EXPECT_TRUE(Names(message([](DeformationHandle* h) {
                      h->vertices = {4, 2, 3};
                    }),
                    {tip, "2 positions", "3 vertices"}));
  EXPECT_TRUE(Names(message([](DeformationHandle* h) { (*h->positions)(1, 1) = kInfinity; }),
                    {tip, "position"}));
  EXPECT_TRUE(
      Names(message([](DeformationHandle* h) { h->motion.axis.setZero(); }), {tip, "axis"}));
  EXPECT_TRUE(
      Names(message([](DeformationHandle* h) { h->motion.axis(1) = kInfinity; }), {tip, "axis"}));
  EXPECT_TRUE(
      Names(message([](DeformationHandle* h) { h->motion.angle = kInfinity; }), {tip, "angle"}));
  EXPECT_TRUE(
      Names(message([](DeformationHandle* h) { h->motion.point(2) = kInfinity; }), {tip, "point"}));
  EXPECT_TRUE(Names(message([](DeformationHandle* h) { h->motion.translation(2) = kInfinity; }),
                    {tip, "translation"}));
  for (const double weight : {0., -1., kInfinity}) {
    DeformationHandle soft = By({2}, {0, 0, 0});
    soft.weight = weight;
    EXPECT_NO_THROW(HandleTargets({soft}, OnLine(6), {0, 0, 0}, 1));
    soft.hard = false;
    EXPECT_TRUE(Refuses<InvalidOptions>(
        [&] {
          HandleTargets({soft}, OnLine(6), {0, 0, 0}, 1);
        },
        {"handles:", "0"}));
  }
}

// Two bars and a vertex of no triangle.
struct TwoBars {
  explicit TwoBars(const std::vector<DeformationHandle>& handles) {
    const int count = bar.connectivity->NumVertices();
    Eigen::Matrix3Xi both(3, 2 * bar.connectivity->NumTriangles());
    both << bar.connectivity->Triangles(), bar.connectivity->Triangles().array() + count;
    rest.resize(3, 2 * count + 1);
    rest << bar.pose(0), bar.pose(0).colwise() + Eigen::Vector3d(0, 5, 0), Eigen::Vector3d(9, 9, 9);
    component.assign(2 * count + 1, 0);
    std::fill(component.begin() + count, component.end(), 1);
    component.back() = -1;
    metric = FreezeMetric({}, Connectivity::FromTriangles(2 * count + 1, both), {rest}, 1);
    vertices.resize(2 * count + 1);
    for (int v = 0; v < 2 * count + 1; ++v) vertices[v] = v;
    targets.emplace_back(handles, rest, Eigen::Vector3d::Zero(), 1);
    level.emplace_back(metric, rest, vertices, component, targets[0], 1);
  }
  ShapeFamily bar = MakeBar(4, 1, 1, 4, 1, 1);
  Shape rest;
  std::vector<int> component, vertices;
  std::shared_ptr<const Metric> metric;
  std::vector<HandleTargets> targets;
  std::vector<HeldLevel> level;
};

TEST(HeldLevel, MovesEveryComponentAsItsOwnVerticesMove) {
  const int count = MakeBar(4, 1, 1, 4, 1, 1).connectivity->NumVertices();
  DeformationHandle one = By({0, 3, 7, 9}, {1, 2, 3}, 0.7), other = By({}, {-3, 0, 1}, -0.4);
  one.motion.axis = {1, 1, 2};
  other.motion.axis = {0, 3, 1};
  for (const int v : {2, 5, 8, 11}) other.vertices.push_back(count + v);
  DeformationHandle lonely = By({2 * count}, {5, 5, 5});
  const TwoBars bars({one, other, lonely});
  Shape shape = bars.rest;
  const Shape places = bars.targets[0].At(1);
  bars.level[0].MoveComponents(places, &shape);
  for (int v = 0; v < count; ++v) {
    EXPECT_LT((shape.col(v) - one.motion.At(1, bars.rest.col(v))).norm(), 1e-9);
    EXPECT_LT((shape.col(count + v) - other.motion.At(1, bars.rest.col(count + v))).norm(), 1e-9);
  }
  EXPECT_EQ(shape.col(2 * count), bars.rest.col(2 * count));
  // The targets by vertex.
  const Shape target = bars.level[0].Target(places);
  EXPECT_LT((target.col(7) - one.motion.At(1, bars.rest.col(7))).norm(), 1e-12);
  EXPECT_EQ(target.col(8), Eigen::Vector3d::Zero());
  EXPECT_LT((target.col(2 * count) - bars.rest.col(2 * count) - Eigen::Vector3d(5, 5, 5)).norm(),
            1e-12);
  // The path's constraints: no other vertex is prescribed where every component is held.
  EXPECT_EQ(bars.level[0].Path().Factors().Constraints().prescribed.size(), 9u);
  EXPECT_EQ(bars.level[0].NumVertices(), 2 * count + 1);
}

TEST(HeldLevel, WhatNoHandleHoldsIsPrescribedWhereItIs) {
  const int count = MakeBar(4, 1, 1, 4, 1, 1).connectivity->NumVertices();
  const TwoBars bars({By({count + 3}, {0, 0, 1})});
  std::vector<int> prescribed = bars.level[0].Path().Factors().Constraints().prescribed;
  std::sort(prescribed.begin(), prescribed.end());
  std::vector<int> expected;
  for (int v = 0; v < count; ++v) expected.push_back(v);
  expected.push_back(count + 3);
  expected.push_back(2 * count);
  EXPECT_EQ(prescribed, expected);
}

TEST(HeldLevel, PlacesWhatIsHeldInEveryShapeAndTheRestInTheLast) {
  Shape positions(3, 2), soft(3, 1);
  positions << 1, 2, 3, 4, 5, 6;
  soft << 7, 8, 9;
  const int count = MakeBar(4, 1, 1, 4, 1, 1).connectivity->NumVertices();
  const TwoBars bars(
      {By({0, 1}, {1, 0, 0}), At({4, 3}, positions), At({6}, soft, false), By({count}, {0, 0, 0})});
  const Shape places = bars.targets[0].At(1);
  const HeldLevel& level = bars.level[0];
  for (const bool last : {false, true}) {
    Shape shape = bars.rest;
    level.Place(places, last, &shape);
    for (int v = 0; v < count; ++v) {
      const Eigen::Vector3d expected =
          v < 2            ? Eigen::Vector3d(bars.rest.col(v) + Eigen::Vector3d::UnitX())
          : last && v == 3 ? Eigen::Vector3d(positions.col(1))
          : last && v == 4 ? Eigen::Vector3d(positions.col(0))
                           : Eigen::Vector3d(bars.rest.col(v));
      EXPECT_LT((shape.col(v) - expected).norm(), 1e-12) << v;
    }
  }
  // Soft handles do not draw here; others are met, and their neighbours follow.
  const Shape moved = level.WithHardHandlesAt(places, bars.rest);
  EXPECT_LT((moved.col(3) - positions.col(1)).norm(), 1e-12);
  EXPECT_LT((moved.col(0) - bars.rest.col(0) - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_GT((moved.col(8) - bars.rest.col(8)).norm(), 0.01);
  Shape elsewhere = places;
  elsewhere.col(4) *= 2;
  ASSERT_EQ(bars.targets[0].Held()[4], 6);
  EXPECT_EQ(level.WithHardHandlesAt(elsewhere, bars.rest), moved);
  // Of several shapes each goes to its own places, and the first stays.
  std::vector<Shape> shapes = {bars.rest, bars.rest, bars.rest};
  const std::vector<Shape> all = {bars.targets[0].At(0), bars.targets[0].At(0.5), places};
  level.MoveHandlesTo(all, &shapes);
  EXPECT_EQ(shapes[0], bars.rest);
  EXPECT_LT((shapes[1].col(1) - bars.rest.col(1) - Eigen::Vector3d(0.5, 0, 0)).norm(), 1e-12);
  EXPECT_LT((shapes[2].col(1) - bars.rest.col(1) - Eigen::Vector3d::UnitX()).norm(), 1e-12);
  EXPECT_LT((shapes[2].col(4) - positions.col(0)).norm(), 1e-12);
  EXPECT_GT((shapes[2].col(6) - bars.rest.col(6)).norm(), 0.1);
}

}  // namespace
}  // namespace shapespace::internal
