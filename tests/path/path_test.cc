#include <shapespace/path/path.h>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/base/error.h>

#include "support/paths.h"

namespace shapespace {
namespace {

TEST(Resample, IsExactOnCubicsInTimeAndGivesShapesBackAtTheirOwnTimes) {
  const Shape a = testing::Noise(5, 1, 1), b = testing::Noise(5, 1, 2), c = testing::Noise(5, 1, 3);
  const auto at = [&](double t) { return Shape(a + t * b + t * t * t * c); };
  const std::vector<double> times = {0, 0.1, 0.4, 0.5, 0.9, 1};
  std::vector<Shape> shapes;
  for (double t : times) shapes.push_back(at(t));
  const std::vector<double> wanted = {0, 0.03, 0.4, 0.45, 0.77, 0.99, 1};
  const std::vector<Shape> result = Resample(shapes, times, wanted);
  for (size_t i = 0; i < wanted.size(); ++i) EXPECT_TRUE(result[i].isApprox(at(wanted[i]), 1e-12));
  EXPECT_TRUE(result[2] == shapes[2]);
}

// Three poses; on each piece the vertices run along a parabola, with a corner between.
Path CorneredPath() {
  Path path;
  const Shape way = testing::Noise(4, 1, 7);
  for (int i = 0; i <= 8; ++i) {
    const double t = i / 8.0;
    path.parameters.push_back(t);
    path.shapes.push_back(std::abs(t - 0.5) * way);
    path.motions.push_back(
        {Eigen::AngleAxisd(t, Eigen::Vector3d::UnitZ()).toRotationMatrix(), {t, 0, 0}});
  }
  path.poses = {0, 4, 8};
  return path;
}

TEST(ResamplePath, DoesNotRoundTheCornersAtPoses) {
  const Path path = CorneredPath();
  const Path result = Resample(path, {0, 0.2, 0.45, 0.5, 0.55, 0.77, 1});
  const Shape way = 2 * path.shapes[0];
  for (int i = 0; i < result.NumShapes(); ++i) {
    const double t = result.parameters[i];
    EXPECT_LT((result.shapes[i] - std::abs(t - 0.5) * way).norm(), 1e-12) << t;
    EXPECT_NEAR(result.motions[i].translation.x(), t, 1e-12);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(t, Eigen::Vector3d::UnitZ()).toRotationMatrix();
    EXPECT_LT((result.motions[i].rotation - turn).norm(), 1e-12);
  }
  EXPECT_EQ(result.poses, (std::vector<int>{0, 3, 6}));
}

TEST(ResamplePath, RefusesTimesThatFallOrLeaveThePath) {
  const Path path = CorneredPath();
  EXPECT_THROW(Resample(path, {}), InvalidOptions);
  EXPECT_THROW(Resample(path, {0.5, 0.4}), InvalidOptions);
  EXPECT_THROW(Resample(path, {0.5, 0.5}), InvalidOptions);
  EXPECT_THROW(Resample(path, {-0.1, 0.4}), InvalidOptions);
  EXPECT_THROW(Resample(path, {0.1, 1.4}), InvalidOptions);
}

}  // namespace
}  // namespace shapespace
