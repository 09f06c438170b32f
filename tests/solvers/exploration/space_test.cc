#include <shapespace/exploration/space.h>

#include <cmath>
#include <limits>
#include <random>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>

#include "solvers/exploration/spaces.h"
#include "support/message_of.h"
#include "support/motions.h"

namespace shapespace {
namespace {

using testing::Diameter;
using testing::Distance;
using testing::MadeUpSpace;
using testing::MessageOf;
using testing::SmallTube;

TEST(SpaceTest, NodesAreMetExactly) {
  const ShapeFamily tube = SmallTube();
  const PoseSpace space = MadeUpSpace(tube);
  space.Validate();
  for (int i = 0; i < 4; ++i) EXPECT_EQ(space.At(space.points.col(i)), space.Placed(i)) << i;
  const Shape first = tube.pose(0).colwise() + Eigen::Vector3d(1, 2, 3);
  EXPECT_LT(Distance(space.Placed(0), first), 1e-14 * Diameter(first));
}

TEST(SpaceTest, IsLinearInsideATriangleAndContinuousAcrossItsSides) {
  const PoseSpace space = MadeUpSpace(SmallTube());
  const Shape expected = .5 * space.Placed(0) + .3 * space.Placed(1) + .2 * space.Placed(2);
  EXPECT_LT(Distance(space.At({.5, .2}), expected), 1e-12);
  std::mt19937 random(5);
  std::uniform_real_distribution<double> uniform(0, 1);
  for (int k = 0; k < 50; ++k) {
    const double t = uniform(random);
    const Eigen::Vector2d aside(1e-14, -1e-14);
    const Shape one = space.At(Eigen::Vector2d(t, t) + aside);
    const Shape other = space.At(Eigen::Vector2d(t, t) - aside);
    EXPECT_LT(Distance(one, other), 1e-12 * Diameter(one));
  }
}

TEST(SpaceTest, PointsOutsideAreMovedToTheNearestOfTheHull) {
  const PoseSpace space = MadeUpSpace(SmallTube());
  const PlaneLocation aside = space.Locate({0.4, -2});
  EXPECT_FALSE(aside.inside);
  EXPECT_LT((aside.point - Eigen::Vector2d(0.4, 0)).norm(), 1e-15);
  EXPECT_LT(Distance(space.At({0.4, -2}), space.At({0.4, 0})), 1e-14);
  EXPECT_EQ(space.At({7, 9}), space.Placed(2));
  EXPECT_TRUE(space.Locate({0.4, 0}).inside);
  EXPECT_TRUE(space.Locate({1, 1}).inside);
}

TEST(SpaceTest, APointThatIsNotFiniteHasNoShape) {
  const PoseSpace space = MadeUpSpace(SmallTube());
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {std::nan(""), infinity, -infinity}) {
    EXPECT_THROW(space.At({bad, 0.5}), InvalidOptions);
    EXPECT_THROW(space.Locate({0.5, bad}), InvalidOptions);
  }
  EXPECT_FALSE(space.Locate({1e300, 0.5}).inside);
}

TEST(SpaceTest, ALineHasNoInside) {
  PoseSpace space = MadeUpSpace(SmallTube());
  space.triangles.resize(3, 0);
  space.segments.resize(2, 2);
  space.segments << 0, 1, 1, 2;
  space.Validate();
  EXPECT_EQ(space.At({1, 0}), space.Placed(1));
  EXPECT_TRUE(space.Locate({.25, 0}).inside);
  EXPECT_LT(Distance(space.At({.25, 0}), .75 * space.Placed(0) + .25 * space.Placed(1)), 1e-12);
  EXPECT_TRUE(space.Locate({.25, -.001}).inside);  // within the tolerance for collinear points
  const PlaneLocation off = space.Locate({.25, -.1});
  EXPECT_FALSE(off.inside);
  EXPECT_LT((off.point - Eigen::Vector2d(.25, 0)).norm(), 1e-15);
}

TEST(SpaceTest, FarFromTheOriginShapesKeepTheirForm) {
  const ShapeFamily tube = SmallTube();
  const PoseSpace near = MadeUpSpace(tube, Eigen::Vector3d::Zero());
  const PoseSpace far = MadeUpSpace(tube, Eigen::Vector3d(1e6, -1e6, 1e6));
  Shape difference = far.At({.3, .2}) - near.At({.3, .2});
  difference.colwise() -= far.translation;
  EXPECT_LT(difference.cwiseAbs().maxCoeff(), 1e-9);
}

TEST(SpaceTest, ACurveIsWalkedAtEvenSteps) {
  const PoseSpace space = MadeUpSpace(SmallTube());
  const PlaneWalk walk = WalkAlong(space, {{0, 0}, {1, 0}, {1, 0}, {1, 1}, {0, 1}}, 7);
  walk.path.Validate();
  ASSERT_EQ(walk.path.NumShapes(), 7);
  EXPECT_EQ(walk.outside, 0);
  const double expected[7][2] = {{0, 0}, {.5, 0}, {1, 0}, {1, .5}, {1, 1}, {.5, 1}, {0, 1}};
  for (int i = 0; i < 7; ++i) {
    const Eigen::Vector2d point(expected[i][0], expected[i][1]);
    EXPECT_LT((walk.locations[i].point - point).norm(), 1e-14) << i;
    EXPECT_LT(Distance(walk.path.Placed(i), space.At(point)), 1e-12) << i;
  }
  EXPECT_EQ(walk.path.poses, (std::vector<int>{0, 2, 4, 6}));
}

TEST(SpaceTest, AMidpointOnTheWayIsNoPose) {
  PoseSpace space = MadeUpSpace(SmallTube());
  space.triangles.resize(3, 0);
  space.segments.resize(2, 2);
  space.segments << 0, 4, 4, 2;
  const PlaneWalk walk = WalkAlong(space, {{0, 0}, {1, 1}}, 3);
  EXPECT_EQ(walk.path.Placed(1), space.Placed(4));
  EXPECT_EQ(walk.path.poses, (std::vector<int>{0, 2}));
}

TEST(SpaceTest, ACurveThatLeavesTheHullSaysSo) {
  const PoseSpace space = MadeUpSpace(SmallTube());
  const PlaneWalk walk = WalkAlong(space, {{.5, .5}, {.5, 1.5}}, 5);
  EXPECT_EQ(walk.outside, 2);
  EXPECT_EQ(WalkAlong(space, {{.5, .2}}, 1).path.NumShapes(), 1);
  EXPECT_EQ(WalkAlong(space, {{.5, .2}}, 3).path.NumShapes(), 3);
}

TEST(SpaceTest, WhatIsNoCurveIsRefused) {
  const PoseSpace space = MadeUpSpace(SmallTube());
  EXPECT_THROW(WalkAlong(space, {}, 3), InvalidOptions);
  EXPECT_THROW(WalkAlong(space, {{0, 0}}, 0), InvalidOptions);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(WalkAlong(space, {{0, nan}}, 3), InvalidOptions);
  EXPECT_THROW(WalkAlong(space, {{-1e308, 0}, {1e308, 0}}, 3), InvalidOptions);
  EXPECT_EQ(WalkAlong(space, {{1, 0}, {1e200, 0}}, 3).path.Placed(0), space.Placed(1));
}

TEST(SpaceTest, ASpaceAtOddsWithItselfIsRefused) {
  const ShapeFamily tube = SmallTube();
  const auto message = [&](const auto& spoil) {
    PoseSpace space = MadeUpSpace(tube);
    spoil(&space);
    return MessageOf<MeshError>([&] { space.Validate(); });
  };
  const auto contains = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos;
  };
  EXPECT_TRUE(contains(message([](PoseSpace* s) { s->names.resize(1); }), "two poses"));
  EXPECT_TRUE(contains(message([](PoseSpace* s) { s->parents.clear(); }), "differ in number"));
  EXPECT_TRUE(contains(message([](PoseSpace* s) { s->points.resize(2, 1); }), "differ in number"));
  EXPECT_TRUE(contains(message([](PoseSpace* s) { s->nodes[1].resize(3, 2); }), "a node"));
  EXPECT_TRUE(contains(message([](PoseSpace* s) { s->triangles(0, 0) = 5; }), "out of range"));
  EXPECT_TRUE(contains(message([](PoseSpace* s) { s->triangles.resize(3, 0); }), "neither"));
  EXPECT_TRUE(contains(message([](PoseSpace* s) { s->distances.setZero(); }), "distances"));
  EXPECT_TRUE(contains(message([](PoseSpace* s) { s->distances(0, 1) = 2; }), "symmetric"));
  EXPECT_TRUE(contains(message([](PoseSpace* s) { s->parents[0] = {0, 4}; }), "parents"));
  EXPECT_TRUE(contains(
      message([](PoseSpace* s) { s->points(0, 0) = std::numeric_limits<double>::infinity(); }),
      "not finite"));
  EXPECT_TRUE(contains(message([](PoseSpace* s) {
                         s->nodes[1](0, 0) = 1e308;
                         s->translation.x() = 1e308;
                       }),
                       "not finite in the unit"));
}

}  // namespace
}  // namespace shapespace
