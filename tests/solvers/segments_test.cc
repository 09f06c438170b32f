// Segments without triangles that are attached to a surface.
#include <algorithm>

#include <gtest/gtest.h>

#include <shapespace/deformation/deformation.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/transfer/detail/gradient_transfer.h>

#include "support/motions.h"
#include "support/whiskered.h"

namespace shapespace {
namespace {

using testing::Where;
using testing::WhiskeredBar;

// The greatest relative change of a segment's length in any shape of a path.
double GreatestChange(const WhiskeredBar& bar, const Path& path) {
  double greatest = 0;
  for (const Shape& shape : path.Placed()) {
    const Eigen::ArrayXd change = bar.Lengths(shape).array() / WhiskeredBar::kLength - 1;
    greatest = std::max(greatest, change.abs().maxCoeff());
  }
  return greatest;
}

MetricOptions Stretching(double isometric, double strain) {
  MetricOptions options;
  options.isometric = isometric;
  options.strain = strain;
  options.lambda = 1e-4;
  options.bending = 1e-5;
  return options;
}

TEST(Segments, KeepTheirLengthsBetweenPoses) {
  for (const WhiskeredBar& bar : {WhiskeredBar(8, 2), WhiskeredBar(32, 8)}) {
    for (const MetricOptions& metric : {Stretching(1, 0), Stretching(0, 1)}) {
      GeodesicOptions options;
      options.metric = metric;
      const GeodesicResult result = Interpolate(
          bar.connectivity,
          {bar.Pose(0, {1, 0, 0}), bar.Pose(30, Eigen::Vector3d(-1, 3, 1).normalized())}, options);
      EXPECT_TRUE(result.path.converged);
      EXPECT_LT(GreatestChange(bar, result.path), 0.05) << DescribeMetric(metric);
    }
  }
}

TEST(Segments, KeepTheirLengthsUnderHandles) {
  const WhiskeredBar bar(8, 2);
  const Shape rest = bar.Pose(0, {1, 0, 0});
  DeformationHandle foot, tip;
  foot.vertices = Where(rest, [](const auto& p) { return p.x() < -1.9; });
  tip.vertices = {bar.first + WhiskeredBar::kSegments - 1};
  tip.positions = rest.col(tip.vertices[0]) + Eigen::Vector3d(-0.4, 0.6, 0.3);
  const DeformationResult result = Deform(bar.connectivity, rest, {foot, tip});
  EXPECT_TRUE(result.path.converged);
  EXPECT_LT(GreatestChange(bar, result.path), 0.05);
}

// The whisker keeps its direction while its bar bends.
TEST(Segments, StayAttachedWhenABendIsTransferredToALargerBar) {
  const WhiskeredBar bar(8, 2);
  const Eigen::Vector3d along = Eigen::Vector3d::UnitX();
  const Shape rest = bar.Pose(0, along), target = 2 * rest;
  const Shape bent =
      internal::GradientTransfer(bar.connectivity, rest, target)(bar.Pose(60, along));
  EXPECT_GT((bent.col(bar.root) - target.col(bar.root)).norm(), 0.5);
  EXPECT_LT((bar.Lengths(bent).array() - 2 * WhiskeredBar::kLength).abs().maxCoeff(), 0.01);
}

}  // namespace
}  // namespace shapespace
