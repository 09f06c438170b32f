#include <shapespace/bodies/miura.h>

#include <gtest/gtest.h>

#include "bodies/measure.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

TEST(MiuraTest, RestsFlatFacingUpAsParallelograms) {
  const ShapeFamily body = MakeMiura(1, 2, 60, 4, 3);
  EXPECT_EQ(body.connectivity->NumPolygons(), 12);
  EXPECT_EQ(body.connectivity->NumTriangles(), 24);
  EXPECT_EQ(UnmatchedSides(*body.connectivity), 2 * (4 + 3));
  const Shape rest = body.pose(0);
  EXPECT_EQ(rest.row(2).cwiseAbs().maxCoeff(), 0);
  EXPECT_NEAR(Area(*body.connectivity, rest), 12 * 2 * std::sin(60 / kDegrees), 1e-13);
  EXPECT_GT(VolumeOf(*body.connectivity, rest.colwise() + Eigen::Vector3d::UnitZ()), 0);
}

TEST(MiuraTest, KeepsSidesDiagonalsAndFlatnessOfEveryParallelogram) {
  for (double corner : {10.0, 45.0, 60.0, 80.0}) {
    const ShapeFamily body = MakeMiura(1, 1.5, corner, 5, 4);
    const Shape rest = body.pose(0);
    for (double angle : {1e-6, 10.0, 45.0, 85.0}) {
      const Shape folded = body.pose(angle);
      // Edges include both diagonals of the polygons.
      EXPECT_EQ(body.connectivity->NumEdges(), 5 * 5 + 6 * 4 + 2 * 20);
      EXPECT_LT(LargestStrain(*body.connectivity, rest, folded), 1e-13);
      for (int p = 0; p < body.connectivity->NumPolygons(); ++p) {
        const int* quad = &body.connectivity->Corners()[4 * p];
        const Eigen::Vector3d u = folded.col(quad[1]) - folded.col(quad[0]);
        const Eigen::Vector3d v = folded.col(quad[3]) - folded.col(quad[0]);
        const Eigen::Vector3d w = folded.col(quad[2]) - folded.col(quad[0]);
        EXPECT_LT(std::abs(u.cross(v).dot(w)), 1e-13);
        EXPECT_NEAR(u.cross(v).normalized().z(), std::cos(angle / kDegrees), 1e-13);
      }
    }
  }
}

TEST(MiuraTest, ShrinksBothWaysAsItFolds) {
  const ShapeFamily body = MakeMiura(1, 1, 60, 10, 10);
  Eigen::Vector3d previous(100, 100, -1);
  for (double angle : {0.0, 20.0, 40.0, 60.0, 80.0}) {
    const Shape shape = body.pose(angle);
    const Eigen::Vector3d size = shape.rowwise().maxCoeff() - shape.rowwise().minCoeff();
    EXPECT_LT(size.x(), previous.x());
    EXPECT_LT(size.y(), previous.y());
    EXPECT_GT(size.z(), previous.z());
    previous = size;
  }
  EXPECT_LT(previous.x(), 0.4 * 10 * std::sin(60 / kDegrees));
}

TEST(MiuraTest, RefusesBadArguments) {
  EXPECT_TRUE(testing::Names(Refusal([] { MakeMiura(0, 1, 60, 2, 2); }), {"a:", "0"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeMiura(1, 1, 90, 2, 2); }), {"corner:", "10", "80"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeMiura(1, 1, 60, 2, 0); }), {"ny:", "0", "1"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeMiura(1, 1, 60, 1'000'000, 1'000'000); }),
                             {"triangles:", "2000000000000", "0", "20000000"}));
}

}  // namespace
}  // namespace shapespace
