#include <shapespace/deformation/handle.h>

#include <cmath>

#include <gtest/gtest.h>

namespace shapespace {
namespace {

TEST(ScrewMotion, MovesByTheShareOfItsAngleAndItsTranslation) {
  ScrewMotion motion;
  motion.axis = {0, 0, 7};
  motion.angle = 1.5 * M_PI;
  motion.point = {1, 0, 0};
  motion.translation = {0, 0, 4};
  const Eigen::Vector3d x(3, 0, 5);
  EXPECT_TRUE(motion.At(0, x).isApprox(x, 1e-15));
  EXPECT_TRUE(motion.At(1.0 / 3, x).isApprox(Eigen::Vector3d(1, 2, 5 + 4.0 / 3), 1e-14));
  EXPECT_TRUE(motion.At(2.0 / 3, x).isApprox(Eigen::Vector3d(-1, 0, 5 + 8.0 / 3), 1e-14));
  EXPECT_TRUE(motion.At(1, x).isApprox(Eigen::Vector3d(1, -2, 9), 1e-14));
}

TEST(ScrewMotion, NeedsOnlyTheDirectionOfItsAxis) {
  ScrewMotion motion;
  motion.axis = {1, 2, -2};
  motion.angle = 1;
  const Eigen::Vector3d x(3, 0, 5), turned = motion.At(1, x);
  for (const double length : {1e-300, 1e-170, 1e170, 1e200}) {
    motion.axis = length * Eigen::Vector3d(1, 2, -2);
    EXPECT_TRUE(motion.At(1, x).isApprox(turned, 1e-14)) << length;
  }
}

}  // namespace
}  // namespace shapespace
