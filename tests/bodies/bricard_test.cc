#include <shapespace/bodies/bricard.h>

#include <gtest/gtest.h>

#include <shapespace/bodies/body.h>

#include "bodies/measure.h"

namespace shapespace {
namespace {

TEST(BricardTest, IsAnOctahedron) {
  const ShapeFamily body = MakeBricard();
  const Connectivity& connectivity = *body.connectivity;
  EXPECT_EQ(connectivity.NumVertices(), 6);
  EXPECT_EQ(connectivity.NumEdges(), 12);
  EXPECT_EQ(connectivity.NumTriangles(), 8);
  EXPECT_EQ(UnmatchedSides(connectivity), 0);
  for (const auto& edge : connectivity.Edges().colwise()) {
    EXPECT_NE(edge(0) / 2, edge(1) / 2) << "opposite vertices are not joined";
  }
}

TEST(BricardTest, KeepsAllEdgesWhileEveryHingeMoves) {
  const ShapeFamily body = MakeBricard();
  const Shape rest = body.pose(body.begin);
  const Eigen::VectorXd rest_angles = HingeAngles(*body.connectivity, rest);
  Eigen::VectorXd moved = Eigen::VectorXd::Zero(rest_angles.size());
  for (int i = 1; i <= 100; ++i) {
    const Shape shape = body.pose(body.begin + (body.end - body.begin) * i / 100);
    EXPECT_LT(LargestStrain(*body.connectivity, rest, shape), 1e-14);
    const Eigen::VectorXd angles = HingeAngles(*body.connectivity, shape);
    // Hinges may pass through 180 degrees, so differences are taken modulo a full turn.
    for (int h = 0; h < moved.size(); ++h) {
      moved(h) = std::max(moved(h), std::abs(std::remainder(angles(h) - rest_angles(h), 360)));
    }
  }
  EXPECT_EQ(moved.size(), 12);
  EXPECT_GT(moved.minCoeff(), 30);
}

TEST(BricardTest, OppositeVerticesChangeTheirDistances) {
  const ShapeFamily body = MakeBricard();
  const Shape first = body.pose(body.begin), last = body.pose(body.end);
  for (int v : {0, 2, 4}) {
    const double before = (first.col(v) - first.col(v + 1)).norm();
    const double after = (last.col(v) - last.col(v + 1)).norm();
    EXPECT_GT(std::abs(after - before), 0.1) << v;
  }
}

TEST(BricardTest, ParameterIsTheAngleToThePlaneOfSymmetry) {
  const ShapeFamily body = MakeBricard();
  for (double angle : {-35.0, 0.0, 20.0, 50.0}) {
    const Shape shape = body.pose(angle);
    const Eigen::Vector3d edge = shape.col(0) - shape.col(2);
    EXPECT_NEAR(std::asin(edge.y() / edge.norm()) * kDegrees, angle, 1e-12);
  }
}

TEST(BricardTest, EnclosesNoVolumeAsSymmetryDemands) {
  const ShapeFamily body = MakeBricard();
  for (double angle : {-35.0, -10.0, 15.0, 50.0}) {
    EXPECT_NEAR(VolumeOf(*body.connectivity, body.pose(angle)), 0, 1e-14);
  }
}

TEST(BricardTest, NeverComesNearADegenerateTriangleOrAFlatPose) {
  const ShapeFamily body = MakeBricard();
  for (int i = 0; i <= 100; ++i) {
    const Shape shape = body.pose(body.begin + (body.end - body.begin) * i / 100);
    EXPECT_GT(SmallestAngle(*body.connectivity, shape), 40);
    EXPECT_GT(shape.row(2).maxCoeff(), 0.5);
    EXPECT_LT(shape.row(2).minCoeff(), -0.5);
  }
}

}  // namespace
}  // namespace shapespace
