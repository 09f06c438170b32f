#include <shapespace/mesh/internal/geometry.h>

#include <gtest/gtest.h>

namespace shapespace::internal {
namespace {

TEST(GeometryTest, ARightTriangleHasHalfItsRectangle) {
  const Eigen::Vector3d a(1, 1, 1), b(3, 1, 1), c(1, 6, 1);
  EXPECT_DOUBLE_EQ(TriangleArea(a, b, c), 5);
  EXPECT_EQ(UnitNormal(a, b, c), Eigen::Vector3d::UnitZ());
  EXPECT_EQ(AreaNormal(a, c, b), Eigen::Vector3d(0, 0, -10));
  Shape shape(3, 3);
  shape << a, b, c;
  EXPECT_EQ(AreaNormal(shape, Eigen::Vector3i(1, 2, 0)), Eigen::Vector3d(0, 0, 10));
  EXPECT_EQ(TriangleArea(a, b, a), 0);
  EXPECT_TRUE(UnitNormal(a, b, a).isZero(0));
  // Squares of these lengths are no doubles.
  EXPECT_EQ(UnitNormal(a * 1e-90, b * 1e-90, c * 1e-90), Eigen::Vector3d::UnitZ());
}

TEST(GeometryTest, TheShortestLengthIsAThousandthOfTheRootMeanSquare) {
  const Eigen::Vector4d lengths(1, 5, 7, 5);
  EXPECT_NEAR(std::sqrt(SquaredShortest(lengths.cwiseAbs2())), 5e-3, 1e-17);
}

TEST(GeometryTest, TheSmoothStepRisesFromZeroToOneWithoutKinks) {
  EXPECT_EQ(SmoothStep(-1), 0);
  EXPECT_EQ(SmoothStep(2), 1);
  EXPECT_EQ(SmoothStep(0.5), 0.5);
  constexpr double kStep = 1e-4;
  double before = 0, steepest = 0;
  for (double x = -0.1; x < 1.1; x += kStep) {
    EXPECT_NEAR(SmoothStep(x) + SmoothStep(1 - x), 1, 1e-14) << x;
    const double slope = (SmoothStep(x + kStep) - SmoothStep(x)) / kStep;
    EXPECT_GE(slope, -1e-10) << x;
    EXPECT_LT(std::abs(slope - before), 10 * kStep) << x;  // the slope has no jumps
    before = slope;
    steepest = std::max(steepest, slope);
  }
  EXPECT_NEAR(steepest, kSteepestStep, 1e-6);
}

}  // namespace
}  // namespace shapespace::internal
