#include <shapespace/bodies/detail/skeleton.h>

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include "bodies/measure.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

using internal::Rotations;
using internal::Skeleton;
using internal::Skin;

// A trunk of two bones along x, and a limb up from the end of the first, on the side of y > 0.
Skeleton ThreeBones() {
  Skeleton skeleton;
  skeleton.bones = {{"root", -1, {0, 0, 0}, {2, 0, 0}, 0, -1},
                    {"tip", 0, {2, 0, 0}, {5, 0, 0}, 0.5, -1},
                    {"arm", 0, {1, 1, 1}, {1, 1, 4}, 0.25, 0}};
  skeleton.limbs = {{0.5, 1}};
  skeleton.flesh = {{0, {{0, 0, 0}, {2, 0, 0}, 0.4, 0.4}},
                    {1, {{2, 0, 0}, {5, 0, 0}, 0.4, 0.3}},
                    {2, {{1, 1, 1}, {1, 1, 4}, 0.3, 0.2}}};
  return skeleton;
}

// Points: the lowest, two before and two behind the joint of the tip, one at it, two of the arm.
Eigen::Matrix3Xd Points() {
  Eigen::Matrix3Xd points(3, 8);
  points << 0.1, 0.2, 1.2, 3, 4.5, 2, 1.1, 1.1,  //
      0, 0.3, -0.1, 0.2, -0.3, 0.1, 1.1, 0.8,    //
      -9, 0.1, 0.4, -0.2, 0.1, 0.3, 2.5, 4;
  return points;
}

Rotations Still() { return Rotations(3, Eigen::Vector3d::Zero()); }

TEST(SkinTest, AtRestPointsStandOnTheFloor) {
  const Shape rest = Skin(ThreeBones(), Points()).Pose(Still());
  EXPECT_LT((rest - (Points().colwise() + Eigen::Vector3d(0, 0, 9))).cwiseAbs().maxCoeff(), 1e-14);
}

TEST(SkinTest, WhatIsBehindAJointTurnsAboutItAndTheRestStays) {
  const Eigen::Vector3d turn(0.1, -0.3, 0.7);
  Rotations rotations = Still();
  rotations[1] = turn;
  const Shape posed =
      Skin(ThreeBones(), Points()).Pose(rotations).colwise() - Eigen::Vector3d(0, 0, 9);
  const auto turned = [&](int v, double part) -> Eigen::Vector3d {
    const Eigen::Vector3d joint(2, 0, 0);
    return joint + Eigen::AngleAxisd(part * turn.norm(), turn.normalized()) *
                       Eigen::Vector3d(Points().col(v) - joint);
  };
  for (const int v : {0, 1, 2, 6, 7}) {
    EXPECT_LT((posed.col(v) - Points().col(v)).norm(), 1e-14) << v;
  }
  for (const int v : {3, 4}) EXPECT_LT((posed.col(v) - turned(v, 1)).norm(), 1e-14) << v;
  EXPECT_LT((posed.col(5) - turned(5, 0.5)).norm(), 1e-14);
}

TEST(SkinTest, JointsNearerToTheTipsTurnFirst) {
  Rotations rotations = Still();
  rotations[0] = {0, 0, M_PI / 2};
  rotations[1] = {0, 0, M_PI / 2};
  const Shape posed = Skin(ThreeBones(), Points()).Pose(rotations);
  // A point 2.5 behind the joint at 2: to (2, 2.5) about the joint, then to (-2.5, 2) about the
  // root.
  EXPECT_NEAR(posed(0, 4), -2.5, 1e-14);
  EXPECT_NEAR(posed(1, 4), 2 + 0.3, 1e-14);
}

TEST(SkinTest, ALimbMovesNothingButItsOwnSide) {
  Rotations rotations = Still();
  rotations[2] = {0.5, 0, 0};
  Eigen::Matrix3Xd points = Points();
  points.col(7) << 1, -0.2, 2;  // the other side
  const Shape posed = Skin(ThreeBones(), points).Pose(rotations);
  const Shape rest = Skin(ThreeBones(), points).Pose(Still());
  for (const int v : {0, 1, 2, 3, 4, 5, 7}) EXPECT_EQ(posed.col(v), rest.col(v)) << v;
  EXPECT_GT((posed.col(6) - rest.col(6)).norm(), 0.5);
}

TEST(SkinTest, BonesScaleAlongAndAcross) {
  Skeleton skeleton = ThreeBones();
  skeleton.bones[0].length_scale = 1.5;
  skeleton.bones[0].girth_scale = 0.5;
  skeleton.bones[1].length_scale = 2;
  skeleton.bones[1].girth_scale = 3;
  const Shape rest = Skin(skeleton, Points()).Pose(Still());
  const double floor = 9 * 0.5;
  // Of the first bone.
  for (const int v : {0, 1, 2}) {
    const Eigen::Vector3d expected(1.5 * Points()(0, v), 0.5 * Points()(1, v),
                                   0.5 * Points()(2, v) + floor);
    EXPECT_LT((rest.col(v) - expected).norm(), 1e-14) << v;
  }
  // The second begins where the first one ends, at 3.
  for (const int v : {3, 4}) {
    const Eigen::Vector3d expected(3 + 2 * (Points()(0, v) - 2), 3 * Points()(1, v),
                                   3 * Points()(2, v) + floor);
    EXPECT_LT((rest.col(v) - expected).norm(), 1e-14) << v;
  }
  // At the joint, half of each.
  EXPECT_LT(
      (rest.col(5) - Eigen::Vector3d(3, (0.5 + 3) / 2 * 0.1, (0.5 + 3) / 2 * 0.3 + floor)).norm(),
      1e-14);
  // The arm begins at (1, 1, 1), scaled as the trunk's, and has no scale of its own.
  EXPECT_LT((rest.col(6) - Eigen::Vector3d(1.5 + 0.1, 0.5 + 0.1, 0.5 + 1.5 + floor)).norm(), 1e-14);
}

TEST(SkeletonTest, BonesAreFoundByTheirNames) {
  const Skeleton skeleton = ThreeBones();
  EXPECT_EQ(skeleton.Find("root"), 0);
  EXPECT_EQ(skeleton.Find("arm"), 2);
  EXPECT_TRUE(testing::Names(Refusal([&] { skeleton.Find("leg"); }), {"bone:", "'leg'"}));
  ASSERT_EQ(skeleton.Cones().size(), 3u);
  EXPECT_EQ(skeleton.Cones()[1].end_radius, 0.3);
}

}  // namespace
}  // namespace shapespace
