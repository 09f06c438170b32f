#include <shapespace/path/path.h>

#include <algorithm>
#include <cmath>

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

// Three poses; in each piece the vertices move along a parabola, with a corner between.
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

// Between two poses lie too few shapes for a cubic, so that it takes shapes beyond a pose to find
// it.
TEST(ResamplePath, TakesShapesBeyondAPoseWhereThePathIsSmooth) {
  const Shape a = testing::Noise(4, 1, 7), b = testing::Noise(4, 1, 8);
  const auto at = [&](double t) { return Shape(a + t * t * t * b); };
  Path path = CorneredPath();
  for (int i = 0; i <= 8; ++i) path.shapes[i] = at(path.parameters[i]);
  path.poses = {0, 2, 4, 6, 8};
  const std::vector<double> times = {0.1, 0.3, 0.4, 0.7, 0.95};
  const auto error = [&] {
    const Path result = Resample(path, times);
    double most = 0;
    for (size_t i = 0; i < times.size(); ++i) {
      most = std::max(most, (result.shapes[i] - at(times[i])).norm());
    }
    return most;
  };
  path.smooth = true;
  EXPECT_LT(error(), 1e-12);
  path.smooth = false;
  EXPECT_GT(error(), 1e-4);
}

// The cornered path, continued beyond the last pose by four shapes, back along a line, so that
// there is a corner.
Path ContinuedPath() {
  Path path = CorneredPath();
  const Shape end = path.shapes.back();
  for (int i = 1; i <= 4; ++i) {
    path.parameters.push_back(1 + i / 8.0);
    path.shapes.push_back((1 - 2 * i / 8.0) * end);
    path.motions.push_back({Eigen::Matrix3d::Identity(), {path.parameters.back(), 0, 0}});
  }
  path.extrapolated = 4;
  return path;
}

TEST(ResamplePath, GoesOnBeyondTheLastPose) {
  const Path path = ContinuedPath();
  const Path result = Resample(path, {0, 0.9, 0.97, 1, 1.03, 1.2, 1.5});
  const Shape end = path.shapes[8];
  for (int i = 0; i < result.NumShapes(); ++i) {
    const double t = result.parameters[i];
    const double height = t <= 1 ? 2 * std::abs(t - 0.5) : 3 - 2 * t;
    EXPECT_LT((result.shapes[i] - height * end).norm(), 1e-12) << t;
    EXPECT_NEAR(result.motions[i].translation.x(), t, 1e-12);
  }
  EXPECT_EQ(result.poses, (std::vector<int>{0, 3}));
  EXPECT_EQ(result.extrapolated, 3);
  EXPECT_EQ(Resample(path, {0, 0.5, 1}).extrapolated, 0);
  EXPECT_EQ(Resample(path, path.parameters).extrapolated, 4);
  EXPECT_THROW(Resample(path, {0, 1.6}), InvalidOptions);
}

TEST(FirstShapes, KeepsThePosesAndExtrapolatedShapesThatAreAmongThem) {
  const Path path = ContinuedPath();
  const auto expect = [&](int count, const std::vector<int>& poses, int extrapolated) {
    const Path first = FirstShapes(path, count);
    ASSERT_EQ(first.NumShapes(), count);
    for (int i = 0; i < count; ++i) EXPECT_TRUE(first.shapes[i] == path.shapes[i]);
    EXPECT_TRUE(std::equal(first.parameters.begin(), first.parameters.end(),
                           path.parameters.begin(), path.parameters.begin() + count));
    EXPECT_EQ(first.motions.size(), static_cast<size_t>(count));
    EXPECT_EQ(first.poses, poses) << count;
    EXPECT_EQ(first.extrapolated, extrapolated) << count;
  };
  expect(2, {0}, 0);
  expect(5, {0, 4}, 0);
  expect(9, {0, 4, 8}, 0);
  expect(10, {0, 4, 8}, 1);
  expect(13, {0, 4, 8}, 4);
  EXPECT_THROW(FirstShapes(path, 0), InvalidOptions);
  EXPECT_THROW(FirstShapes(path, 14), InvalidOptions);
}

TEST(SelectShapes, ReversesAMotion) {
  const Path path = ContinuedPath();
  const Path back = SelectShapes(path, {12, 8, 4, 0});
  EXPECT_EQ(back.parameters, (std::vector<double>{0, 0.5, 1, 1.5}));
  EXPECT_TRUE(back.shapes[1] == path.shapes[8] && back.shapes[3] == path.shapes[0]);
  EXPECT_EQ(back.motions[1].translation, path.motions[8].translation);
  EXPECT_EQ(back.poses, (std::vector<int>{1, 2, 3}));
  EXPECT_EQ(back.extrapolated, 0);
  EXPECT_EQ(SelectShapes(back, {3, 2, 1, 0}).parameters, (std::vector<double>{0, 0.5, 1, 1.5}));
}

TEST(SelectShapes, KeepsWhatIsExtrapolatedButForTheFirstShape) {
  const Path path = ContinuedPath();
  const Path middle = SelectShapes(path, {4, 8, 10, 12});
  EXPECT_EQ(middle.parameters, (std::vector<double>{0, 0.5, 0.75, 1}));
  EXPECT_EQ(middle.poses, (std::vector<int>{0, 1}));
  EXPECT_EQ(middle.extrapolated, 2);
  const Path end = SelectShapes(path, {10, 11, 12});
  EXPECT_EQ(end.extrapolated, 2);
}

TEST(SelectShapes, RefusesIndicesThatAreNotOfThePathOrTurnBack) {
  const Path path = ContinuedPath();
  for (const std::vector<int>& bad :
       {std::vector<int>{}, {13}, {-1, 0}, {0, 2, 1}, {5, 3, 4}, {1, 1}}) {
    EXPECT_THROW(SelectShapes(path, bad), InvalidOptions) << bad.size();
  }
}

TEST(ResamplePath, RefusesTimesThatFallOrLeaveThePath) {
  const Path path = CorneredPath();
  EXPECT_THROW(Resample(path, {}), InvalidOptions);
  EXPECT_THROW(Resample(path, {0.5, 0.4}), InvalidOptions);
  EXPECT_THROW(Resample(path, {0.5, 0.5}), InvalidOptions);
  EXPECT_THROW(Resample(path, {-0.1, 0.4}), InvalidOptions);
  EXPECT_THROW(Resample(path, {0.1, 1.4}), InvalidOptions);
}

TEST(ResamplePath, RefusesTimesThatAreNotFinite) {
  const Path path = CorneredPath();
  for (const double bad : {std::nan(""), HUGE_VAL, -HUGE_VAL}) {
    for (const std::vector<double>& times :
         {std::vector<double>{bad}, {0.1, bad}, {bad, 0.9}, {0.1, bad, 0.9}}) {
      EXPECT_THROW(Resample(path, times), InvalidOptions);
      EXPECT_THROW(Resample(path.shapes, path.parameters, times), InvalidOptions);
    }
  }
}

TEST(Resample, RefusesWhatIsNoPathAndTimesOffIt) {
  const std::vector<Shape> shapes(3, testing::Noise(5, 1, 1));
  const std::vector<double> times = {0, 0.5, 1};
  EXPECT_THROW(Resample({}, {}, {0.5}), InvalidOptions);
  EXPECT_THROW(Resample(shapes, {0, 1}, {0.5}), InvalidOptions);
  EXPECT_THROW(Resample(shapes, {0, 0.5, 0.5}, {0.5}), InvalidOptions);
  EXPECT_THROW(Resample(shapes, {0, std::nan(""), 1}, {0.5}), InvalidOptions);
  EXPECT_THROW(Resample(shapes, times, {-0.1}), InvalidOptions);
  EXPECT_THROW(Resample(shapes, times, {0.2, 1.1}), InvalidOptions);
  EXPECT_THROW(Resample(shapes, times, {0.5, 0.2}), InvalidOptions);
  EXPECT_TRUE(Resample(shapes, times, {}).empty());
}

}  // namespace
}  // namespace shapespace
