#include <shapespace/bodies/sheet.h>

#include <gtest/gtest.h>

#include <shapespace/bodies/body.h>

#include "bodies/measure.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

TEST(SheetTest, RestsFlatFacingUp) {
  const ShapeFamily sheet = MakeSheet(3, 2, 6, 5);
  const Shape rest = sheet.pose(sheet.begin);
  EXPECT_EQ(sheet.connectivity->NumTriangles(), 60);
  EXPECT_EQ(UnmatchedSides(*sheet.connectivity), 2 * (6 + 5));
  EXPECT_EQ(rest.row(2).cwiseAbs().maxCoeff(), 0);
  EXPECT_NEAR(Area(*sheet.connectivity, rest), 6, 1e-14);
  // The volume between an upward facing sheet at height 1 and the origin is a third of its area.
  EXPECT_NEAR(VolumeOf(*sheet.connectivity, rest.colwise() + Eigen::Vector3d::UnitZ()), 2, 1e-14);
}

TEST(SheetTest, RollsOntoACylinderUntilItsEndsMeet) {
  const ShapeFamily sheet = MakeSheet(3, 2, 12, 4);
  const Shape rolled = sheet.pose(sheet.end);
  const double radius = 3 / (360 / kDegrees);
  for (int v = 0; v < rolled.cols(); ++v) {
    EXPECT_NEAR(std::hypot(rolled(0, v), rolled(2, v) - radius), radius, 1e-15);
  }
  EXPECT_LT((rolled.leftCols(5) - rolled.rightCols(5)).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(SheetTest, EdgesShortenByTheDocumentedPart) {
  const double angle = 180;
  for (int nx : {10, 40}) {
    const ShapeFamily sheet = MakeSheet(3, 2, nx, 8);
    const double expected = std::pow(angle / kDegrees / nx, 2) / 24;
    const double strain = LargestStrain(*sheet.connectivity, sheet.pose(0), sheet.pose(angle));
    EXPECT_NEAR(strain / expected, 1, 0.01);
  }
}

TEST(SheetTest, RefusesBadArguments) {
  EXPECT_TRUE(testing::Names(Refusal([] { MakeSheet(1, -1, 2, 2); }), {"width:", "-1"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeSheet(1, 1, -2, 2); }), {"nx:", "-2", "1"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeSheet(1, 1, 2'000'000'000, 2'000'000'000); }),
                             {"triangles:", "8000000000000000000", "0", "20000000"}));
}

TEST(StripTest, RestsFlatFacingUp) {
  const ShapeFamily strip = MakeStrip(1, 0.8, 7);
  const Shape rest = strip.pose(strip.begin);
  EXPECT_EQ(strip.connectivity->NumTriangles(), 7);
  EXPECT_EQ(strip.connectivity->NumHinges(), 6);
  EXPECT_EQ(rest.row(2).cwiseAbs().maxCoeff(), 0);
  EXPECT_NEAR(Area(*strip.connectivity, rest), 7 * 0.8 / 2, 1e-15);
  EXPECT_NEAR(VolumeOf(*strip.connectivity, rest.colwise() + Eigen::Vector3d::UnitZ()),
              7 * 0.8 / 2 / 3, 1e-15);
}

TEST(StripTest, FoldsEveryHingeByTheAngleAndKeepsEveryEdge) {
  for (const auto& [side, width, triangles] :
       {std::tuple(1.0, 0.8, 40), std::tuple(2.0, 0.1, 40), std::tuple(0.1, 5.0, 7),
        std::tuple(1e4, 1.0, 5), std::tuple(1.0, 1.0, 2), std::tuple(20.0, 1.0, 3)}) {
    const ShapeFamily strip = MakeStrip(side, width, triangles);
    ASSERT_TRUE(strip.isometric);
    for (double part : {1e-9, 0.01, 0.5, 1.0}) {
      const double angle = part * strip.end;
      const Shape folded = strip.pose(angle);
      EXPECT_LT(LargestStrain(*strip.connectivity, strip.pose(0), folded), 1e-12);
      const Eigen::ArrayXd hinges = HingeAngles(*strip.connectivity, folded);
      EXPECT_LT((hinges - angle).abs().maxCoeff(), 1e-8) << angle;
    }
  }
}

TEST(StripTest, ClosesToAnAntiprism) {
  const ShapeFamily strip = MakeStrip(1, 1.5, 12);
  const Shape ring = strip.pose(strip.end);
  EXPECT_LT((ring.leftCols(2) - ring.rightCols(2)).cwiseAbs().maxCoeff(), 1e-14);
  EXPECT_GT(SmallestDistance(ring.leftCols(12)), 0.5);

  const ShapeFamily long_strip = MakeStrip(1, 1.5, 100000);
  const Shape long_ring = long_strip.pose(long_strip.end);
  EXPECT_LT((long_ring.leftCols(2) - long_ring.rightCols(2)).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(StripTest, RefusesBadArguments) {
  EXPECT_TRUE(testing::Names(Refusal([] { MakeStrip(1, 1, 1); }), {"triangles:", "1", "2"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeStrip(1, 1, 20'000'001); }),
                             {"triangles:", "20000001", "0", "20000000"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeStrip(1e300, 1, 4); }), {"side:", "1e+300"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeStrip(1e6, 1, 4); }), {"side:", "10000"}));
}

}  // namespace
}  // namespace shapespace
