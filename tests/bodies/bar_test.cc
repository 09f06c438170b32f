#include <shapespace/bodies/bar.h>

#include <gtest/gtest.h>

#include <shapespace/bodies/body.h>

#include "bodies/measure.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

TEST(BarTest, IsAClosedSphereOfDistinctVertices) {
  for (const auto& [nx, ny, nz] :
       {std::array{1, 1, 1}, std::array{1, 3, 2}, std::array{2, 1, 1}, std::array{7, 3, 2}}) {
    const ShapeFamily bar = MakeBar(3, 2, 1, nx, ny, nz);
    EXPECT_EQ(bar.connectivity->NumTriangles(), 4 * (nx * ny + ny * nz + nz * nx));
    EXPECT_EQ(UnmatchedSides(*bar.connectivity), 0);
    EXPECT_EQ(EulerCharacteristic(*bar.connectivity), 2);
    EXPECT_GT(SmallestDistance(bar.pose(0)), 0.1);
  }
}

TEST(BarTest, RestsAsABoxWoundOutwards) {
  const ShapeFamily bar = MakeBar(3, 2, 0.5, 6, 4, 2);
  const Shape rest = bar.pose(bar.begin);
  EXPECT_EQ(rest.rowwise().maxCoeff(), Eigen::Vector3d(1.5, 1, 0.25));
  EXPECT_EQ(rest.rowwise().minCoeff(), Eigen::Vector3d(-1.5, -1, -0.25));
  EXPECT_NEAR(VolumeOf(*bar.connectivity, rest), 3, 1e-14);
  EXPECT_NEAR(Area(*bar.connectivity, rest), 2 * (3 * 2 + 2 * 0.5 + 0.5 * 3), 1e-13);
}

TEST(BarTest, BendsItsMiddleLineToAnArcOfTheSameLength) {
  const double length = 4, angle = 200;
  const ShapeFamily bar = MakeBar(length, 1, 1, 50, 2, 2);
  const Shape rest = bar.pose(0), bent = bar.pose(angle);
  const double radius = length / (angle / kDegrees);
  int on_middle = 0;
  for (int v = 0; v < rest.cols(); ++v) {
    // z at rest is the distance from the middle plane, towards the centre of the arc.
    const double distance = std::hypot(bent(0, v), bent(2, v) - radius);
    EXPECT_NEAR(distance, radius - rest(2, v), 1e-14);
    EXPECT_EQ(bent(1, v), rest(1, v));
    if (rest(2, v) != 0) continue;
    ++on_middle;
    const double turn = std::atan2(bent(0, v), radius - bent(2, v));
    EXPECT_NEAR(radius * turn, rest(0, v), 1e-14);
  }
  EXPECT_EQ(on_middle, 2 * (50 + 2));
}

TEST(BarTest, SmallBendsAreContinuousAtRest) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 8, 2, 2);
  const double angle = 1e-6;
  const double moved = (bar.pose(angle) - bar.pose(0)).cwiseAbs().maxCoeff();
  // The ends rise by length * angle / 8, their corners slide by height * angle / 4.
  EXPECT_NEAR(moved, 4 * angle / kDegrees / 8, 1e-12);
}

TEST(BarTest, KeepsItsVolumeToSecondOrder) {
  double previous = 0;
  for (int n : {8, 16, 32}) {
    const ShapeFamily bar = MakeBar(4, 1, 0.8, 2 * n, n / 2, n / 2);
    const double lost = 4 * 0.8 - VolumeOf(*bar.connectivity, bar.pose(240));
    EXPECT_GT(lost, 0);
    if (previous > 0) {
      EXPECT_NEAR(previous / lost, 4, 0.1);
    }
    previous = lost;
  }
  EXPECT_LT(previous, 0.01);
}

TEST(BarTest, RangeEndsBeforeTheInnerFaceVanishes) {
  const ShapeFamily thick = MakeBar(1, 1, 1, 40, 40, 40);
  EXPECT_LT(thick.end, 2 * kDegrees);
  EXPECT_GT(VolumeOf(*thick.connectivity, thick.pose(thick.end)), 0.99);
  EXPECT_EQ(MakeBar(4, 1, 1, 8, 2, 2).end, 360);
}

TEST(BarTest, RefusesBadArguments) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_TRUE(testing::Names(Refusal([] { MakeBar(0, 1, 1, 1, 1, 1); }), {"length:", "0"}));
  EXPECT_TRUE(testing::Names(Refusal([=] { MakeBar(1, nan, 1, 1, 1, 1); }), {"width:"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeBar(1, 1, 1, 1, 0, 1); }), {"ny:", "0", "1"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeBar(1, 1, 1, 10000, 10000, 1); }),
                             {"triangles:", "400080000", "0", "20000000"}));
  const int huge = std::numeric_limits<int>::max();
  EXPECT_TRUE(testing::Names(Refusal([=] { MakeBar(1, 1, 1, huge, huge, huge); }),
                             {"triangles:", "2147483647", "0", "20000000"}));
}

}  // namespace
}  // namespace shapespace
