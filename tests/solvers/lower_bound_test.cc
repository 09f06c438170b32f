// The lower bound of path/energy.h compared with minima that are found by a solver.

#include <memory>
#include <string>

#include <gtest/gtest.h>

#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/geodesic/geodesic.h>

#include "support/blends.h"
#include "support/motions.h"

namespace shapespace {
namespace {

GeodesicSummary Solved(const std::shared_ptr<const Connectivity>& connectivity, const Shape& first,
                       const Shape& last, int shapes, const MetricOptions& metric) {
  GeodesicOptions options;
  options.metric = metric;
  options.shapes = shapes;
  options.tolerance = 1e-10;
  options.max_iterations = 5000;
  return Interpolate(connectivity, {first, last}, options).summary;
}

// No cost of position, whose bound is reached by straight lines.
MetricOptions Only(double isometric, double strain, double bending) {
  MetricOptions options;
  options.lambda = 0;
  options.isometric = isometric;
  options.strain = strain;
  options.bending = bending;
  return options;
}

TEST(EnergyLowerBound, IsBelowTheMinimaOfEveryBlend) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 2, 2), tube = MakeTube(150);
  struct Pair {
    std::string name;
    std::shared_ptr<const Connectivity> connectivity;
    Shape first, last;
  };
  const Pair pairs[] = {
      {"bent bar", bar.connectivity, bar.pose(0), bar.pose(80)},
      {"bent and stretched bar", bar.connectivity, bar.pose(30),
       Eigen::Vector3d(1.4, 0.8, 1).asDiagonal() * bar.pose(0)},
      {"bent tube", tube.connectivity, tube.pose(0), tube.pose(100)},
      {"growing tube", tube.connectivity, tube.pose(40), 1.5 * tube.pose(20)},
  };
  for (const Pair& pair : pairs) {
    for (const testing::Blend& blend : testing::AllBlends()) {
      for (int shapes : {1, 7}) {
        SCOPED_TRACE(pair.name + ", " + blend.name + ", " + std::to_string(shapes));
        const GeodesicSummary summary =
            Solved(pair.connectivity, pair.first, pair.last, shapes, blend.options);
        EXPECT_EQ(summary.termination, Termination::kConverged);
        EXPECT_GT(summary.lower_bound, 0);
        EXPECT_LE(summary.lower_bound, summary.energy * (1 + 1e-12));
        // Features that would change at different times are slightly incompatible. The paper's form
        // also penalises the rotation of edges.
        if (blend.options.discretization == Discretization::kMidpoint) {
          EXPECT_LT(summary.Ratio(), 1.02);
        }
      }
    }
  }
}

// If all elements can follow their own shortest paths at once, the minimum equals the bound.
TEST(EnergyLowerBound, IsReachedByGrowthUnderOneMeasureOfLength) {
  const ShapeFamily tube = MakeTube(150);
  for (int shapes : {1, 7}) {
    for (const MetricOptions& metric : {Only(1, 0, 1e-3), Only(0, 1, 1e-3)}) {
      SCOPED_TRACE(DescribeMetric(metric) + ", " + std::to_string(shapes));
      const GeodesicSummary summary =
          Solved(tube.connectivity, tube.pose(60), 2 * tube.pose(60), shapes, metric);
      EXPECT_NEAR(summary.energy, summary.lower_bound, 1e-7 * summary.energy);
    }
  }
}

TEST(EnergyLowerBound, IsReachedByIsometricMotionThatFoldsEvenly) {
  const ShapeFamily strip = MakeStrip(1, 1, 12);
  for (int shapes : {1, 2, 7}) {
    SCOPED_TRACE(shapes);
    const GeodesicSummary summary = Solved(strip.connectivity, strip.pose(0),
                                           strip.pose(0.9 * strip.end), shapes, Only(1, 0, 1e-3));
    EXPECT_NEAR(summary.energy, summary.lower_bound, 1e-7 * summary.energy);
  }
}

// Two triangles, folded by 150 degrees in one direction and by 150 in the other: the difference is
// 60 degrees, through the closed hinge.
TEST(EnergyLowerBound, IsReachedByAHingeThatShutsOnItsWay) {
  const auto connectivity =
      Connectivity::FromTriangles(4, (Eigen::Matrix3Xi(3, 2) << 0, 1, 1, 0, 2, 3).finished());
  const auto folded = [](double degrees) {
    Shape shape(3, 4);
    shape << Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.4, 1, 0),
        testing::Rotation(degrees, {1, 0, 0}) * Eigen::Vector3d(0.6, -1, 0);
    return shape;
  };
  for (int shapes : {1, 3}) {
    const GeodesicSummary summary =
        Solved(connectivity, folded(150), folded(-150), shapes, Only(1, 0, 1e-2));
    EXPECT_GT(summary.lower_bound, 0);
    EXPECT_NEAR(summary.energy, summary.lower_bound, 1e-7 * summary.energy);
  }
}

// A triangle without area has no normal, and its hinges' values lie inside the circle of angles,
// where the shortest path is straight.
TEST(EnergyLowerBound, IsOneWhereAPoseHoldsACollapsedTriangle) {
  const auto connectivity =
      Connectivity::FromTriangles(4, (Eigen::Matrix3Xi(3, 2) << 0, 1, 1, 0, 2, 3).finished());
  const auto folded = [](double degrees, double height) {
    Shape shape(3, 4);
    shape << Eigen::Vector3d(0, 0, 0), Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0.4, 1, 0),
        testing::Rotation(degrees, {1, 0, 0}) * Eigen::Vector3d(0.6, -height, 0);
    return shape;
  };
  for (int shapes : {1, 3, 7}) {
    const GeodesicSummary summary =
        Solved(connectivity, folded(0, 0), folded(150, 1), shapes, Only(1, 0, 1));
    EXPECT_GT(summary.lower_bound, 0);
    EXPECT_LT(summary.lower_bound, (1 + 1e-9) * summary.energy);
  }
}

TEST(EnergyLowerBound, IsReachedByStraightLinesUnderPositionAlone) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 6, 2, 2);
  MetricOptions metric = Only(0, 0, 0);
  metric.lambda = 1;
  const GeodesicSummary summary = Solved(bar.connectivity, bar.pose(0), bar.pose(80), 7, metric);
  EXPECT_GT(summary.lower_bound, 0);
  EXPECT_NEAR(summary.energy, summary.lower_bound, 1e-9 * summary.energy);
}

TEST(EnergyLowerBound, IsZeroAndReachedBetweenRigidCopies) {
  const ShapeFamily tube = MakeTube(150);
  const Shape copy =
      (testing::Rotation(70, {1, 2, 3}) * tube.pose(30)).colwise() + Eigen::Vector3d(4, 5, 6);
  for (const testing::Blend& blend : testing::AllBlends()) {
    SCOPED_TRACE(blend.name);
    const GeodesicSummary summary =
        Solved(tube.connectivity, tube.pose(30), copy, 3, blend.options);
    EXPECT_LT(summary.energy, GeodesicSummary::kZeroEnergy);
    EXPECT_LT(summary.lower_bound, GeodesicSummary::kZeroEnergy);
  }
}

}  // namespace
}  // namespace shapespace
