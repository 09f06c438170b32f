#include <shapespace/geodesic/internal/arc_length.h>

#include <vector>

#include <gtest/gtest.h>

#include <shapespace/bodies/sheet.h>

namespace shapespace {
namespace {

// Shapes that are moved by these distances, under a metric of positions alone, in which the length
// of a motion is its distance.
std::vector<double> TimesOf(const std::vector<double>& places, const MetricOptions& options) {
  const ShapeFamily sheet = MakeSheet(1, 1, 4, 4);
  const auto metric = FreezeMetric(options, sheet.connectivity, {sheet.pose(0)});
  std::vector<Shape> shapes;
  for (const double place : places) {
    shapes.push_back(sheet.pose(0).colwise() + Eigen::Vector3d(place, 0, 0));
  }
  return internal::ArcLengthTimes(*metric, shapes);
}

MetricOptions Positions() {
  MetricOptions options;
  options.strain = options.bending = 0;
  options.lambda = 1;
  return options;
}

TEST(ArcLengthTimes, AreSharesOfTheLengthAlreadyCovered) {
  const std::vector<double> times = TimesOf({0, 1, 1.5, 4}, Positions());
  ASSERT_EQ(times.size(), 4u);
  EXPECT_EQ(times[0], 0);
  EXPECT_NEAR(times[1], 0.25, 0.01);
  EXPECT_NEAR(times[2], 0.375, 0.01);
  EXPECT_EQ(times[3], 1);
}

TEST(ArcLengthTimes, AscendWhereShapesRest) {
  const std::vector<double> times = TimesOf({0, 0, 0, 2, 2}, Positions());
  for (size_t i = 1; i < times.size(); ++i) EXPECT_GT(times[i], times[i - 1] + 1e-3);
  EXPECT_EQ(times.back(), 1);
}

TEST(ArcLengthTimes, AreUniformWithoutMotionAndWithoutLengths) {
  const std::vector<double> uniform = {0, 0.25, 0.5, 0.75, 1};
  EXPECT_EQ(TimesOf({1, 1, 1, 1, 1}, Positions()), uniform);
  EXPECT_EQ(TimesOf({0, 1, 1.5, 4, 5}, MetricOptions::Rigid()), uniform);
}

}  // namespace
}  // namespace shapespace
