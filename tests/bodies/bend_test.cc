#include <shapespace/bodies/detail/bend.h>

#include <cmath>

#include <gtest/gtest.h>

namespace shapespace::internal {
namespace {

// A point on the axis lies on the circle as far along it as before, and what lies beside the axis
// on the radius there, as far from it.
TEST(Bend, PutsTheAxisOnACircleAndNormalsOnItsRadii) {
  for (const double curvature : {2.0, 0.5, -1.3, 1e-3}) {
    const Eigen::Vector3d centre(0, 0, 1 / curvature);
    for (const double along : {-1.2, 0.0, 0.4, 1.1}) {
      const double angle = curvature * along;
      const Eigen::Vector3d inwards(-std::sin(angle), 0, std::cos(angle));
      for (const double up : {0.0, 0.2, -0.3}) {
        const Eigen::Vector3d bent = Bend({along, 0.7, up}, curvature);
        const Eigen::Vector3d expected =
            centre + (up - 1 / curvature) * inwards + Eigen::Vector3d(0, 0.7, 0);
        EXPECT_LT((bent - expected).norm(), 1e-12 * (1 + centre.norm()))
            << curvature << ", " << along;
      }
    }
  }
}

// The series of the circle in the curvature, where the circle's centre is too far away for it.
TEST(Bend, IsAccurateWhereTheCurvatureIsNearlyNone) {
  EXPECT_EQ(Bend({1.5, 2, 3}, 0), Eigen::Vector3d(1.5, 2, 3));
  for (const double curvature : {1e-4, 1e-5, -1e-6, 1e-9}) {
    const double x = 0.9, z = 0.2, turn = curvature * x;
    const Eigen::Vector3d bent = Bend({x, 0, z}, curvature);
    const double squared = turn * turn;
    EXPECT_NEAR(bent.x(), x * (1 - squared / 6) - z * turn * (1 - squared / 6), 5e-16) << curvature;
    EXPECT_NEAR(bent.z(), z * (1 - squared / 2) + x * turn * (1 - squared / 12) / 2, 5e-16);
  }
}

}  // namespace
}  // namespace shapespace::internal
