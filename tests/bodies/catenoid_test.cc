#include <shapespace/bodies/catenoid.h>

#include <gtest/gtest.h>

#include <shapespace/bodies/body.h>

#include "bodies/measure.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

TEST(CatenoidTest, BeginsAtTheCatenoidAndEndsAtTheHelicoid) {
  const ShapeFamily body = MakeCatenoid(1.2, 24, 8);
  const Shape catenoid = body.pose(body.begin), helicoid = body.pose(body.end);
  for (int v = 0; v < catenoid.cols(); ++v) {
    const auto p = catenoid.col(v), q = helicoid.col(v);
    EXPECT_NEAR(std::hypot(p.x(), p.y()), std::cosh(p.z()), 1e-14);
    // On the helicoid the direction from the axis rotates with the height.
    EXPECT_NEAR(q.x() * std::cos(q.z()) - q.y() * std::sin(q.z()), 0, 1e-14);
  }
  EXPECT_NEAR(catenoid.row(2).maxCoeff(), 1.2, 1e-15);
  EXPECT_NEAR(helicoid.row(2).maxCoeff() - helicoid.row(2).minCoeff(), 360 / kDegrees, 1e-14);
}

TEST(CatenoidTest, AreaApproachesTheCatenoids) {
  // Area of the catenoid between -h and h: pi (2 h + sinh 2 h), constant along the family.
  const double exact = 180 / kDegrees * (2 + std::sinh(2.0));
  const ShapeFamily body = MakeCatenoid(1, 160, 50);
  for (double angle : {0.0, 45.0, 90.0}) {
    EXPECT_NEAR(Area(*body.connectivity, body.pose(angle)) / exact, 1, 1e-3);
  }
}

TEST(CatenoidTest, EdgesAreKeptToSecondOrder) {
  double previous = 0;
  for (int n : {8, 16, 32, 64}) {
    const ShapeFamily body = MakeCatenoid(1, 3 * n, n);
    const double strain = LargestStrain(*body.connectivity, body.pose(0), body.pose(90));
    if (previous > 0) {
      EXPECT_NEAR(previous / strain, 4, 0.2);
    }
    previous = strain;
  }
  EXPECT_LT(previous, 1e-3);
  EXPECT_GT(previous, 0);
}

TEST(CatenoidTest, TangentPlanesKeepTheirDirections) {
  const ShapeFamily body = MakeCatenoid(1, 150, 50);
  const Shape first = body.pose(0), last = body.pose(90);
  for (const auto& t : body.connectivity->Triangles().colwise()) {
    const auto normal = [&t](const Shape& shape) {
      const Eigen::Vector3d u = shape.col(t(1)) - shape.col(t(0));
      const Eigen::Vector3d v = shape.col(t(2)) - shape.col(t(0));
      return u.cross(v).normalized();
    };
    // A triangle's normal equals that of a tangent plane somewhere within the triangle.
    EXPECT_GT(normal(first).dot(normal(last)), 0.998);
  }
}

TEST(CatenoidTest, RefusesBadArguments) {
  EXPECT_TRUE(testing::Names(Refusal([] { MakeCatenoid(-1, 10, 10); }), {"half_height:", "-1"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeCatenoid(21, 10, 10); }), {"half_height:", "20"}));
  EXPECT_TRUE(testing::Names(Refusal([] { MakeCatenoid(1, 2, 10); }), {"around:", "2", "3"}));
}

}  // namespace
}  // namespace shapespace
