#include <cmath>
#include <map>
#include <set>

#include <gtest/gtest.h>

#include <shapespace/bodies/bar.h>
#include <shapespace/exploration/explore.h>

#include "solvers/exploration/spaces.h"

namespace shapespace {
namespace {

using testing::BentAndTwisted;
using testing::SmallTube;
using testing::TubePoses;

PoseSpace Explored(int depth, double threshold = 0.05) {
  const ShapeFamily tube = SmallTube();
  ExploreOptions options;
  options.depth = depth;
  options.threshold = threshold;
  return Explore(tube.connectivity, TubePoses(tube), {}, options).space;
}

double AreaOf(const PoseSpace& space) {
  double area = 0;
  for (int t = 0; t < space.triangles.cols(); ++t) {
    const Eigen::Vector2d a = space.points.col(space.triangles(0, t));
    const Eigen::Vector2d b = space.points.col(space.triangles(1, t)) - a;
    const Eigen::Vector2d c = space.points.col(space.triangles(2, t)) - a;
    EXPECT_GT(b.x() * c.y() - b.y() * c.x(), 0) << "triangle " << t;
    area += (b.x() * c.y() - b.y() * c.x()) / 2;
  }
  return area;
}

// Each side belongs to one triangle, on the hull, or to two with opposite directions; and no node
// lies inside a side.
void ExpectNoHangingNodes(const PoseSpace& space) {
  std::map<std::pair<int, int>, int> sides;
  for (int t = 0; t < space.triangles.cols(); ++t) {
    for (int k = 0; k < 3; ++k) {
      const int a = space.triangles(k, t), b = space.triangles((k + 1) % 3, t);
      EXPECT_EQ(++sides[std::make_pair(a, b)], 1);
      const Eigen::Vector2d p = space.points.col(a), side = space.points.col(b) - p;
      for (int i = 0; i < space.NumNodes(); ++i) {
        if (i == a || i == b) continue;
        const Eigen::Vector2d q = space.points.col(i) - p;
        const double along = q.dot(side) / side.squaredNorm();
        if (along <= 0 || along >= 1) continue;
        EXPECT_GT((q - along * side).norm(), 1e-9 * side.norm()) << i << " on " << a << ' ' << b;
      }
    }
  }
}

class RefinementTo : public ::testing::TestWithParam<double> {};

TEST_P(RefinementTo, TilesTheHullWithoutHangingNodes) {
  const PoseSpace coarse = Explored(0), fine = Explored(3, GetParam());
  ASSERT_GT(fine.NumNodes(), coarse.NumNodes());
  EXPECT_NEAR(AreaOf(fine), AreaOf(coarse), 1e-12 * AreaOf(coarse));
  ExpectNoHangingNodes(fine);
}

INSTANTIATE_TEST_SUITE_P(Thresholds, RefinementTo, ::testing::Values(0.01, 0.02, 0.05, 0.1, 0.2));

// In the middle is a triangle of which no side is marked and its neighbours' far sides are: two of
// its sides at least are halved, so it has to be split as well.
TEST(RefinementTest, ATriangleWithTwoHalvedSidesIsSplit) {
  const ShapeFamily tube = SmallTube();
  std::vector<Shape> poses;
  for (int k = 0; k < 3; ++k) {
    const double turn = 2 * M_PI * k / 3;
    poses.push_back(BentAndTwisted(tube, 75 + 15 * std::cos(turn), 60 + 25 * std::sin(turn)));
    poses.push_back(BentAndTwisted(tube, 75 - 70 * std::cos(turn), 60 - 110 * std::sin(turn)));
  }
  ExploreOptions options;
  options.depth = 1;
  for (const double threshold : {0.06, 0.12, 0.16}) {
    options.threshold = threshold;
    ExpectNoHangingNodes(Explore(tube.connectivity, poses, {}, options).space);
  }
}

TEST(RefinementTest, EachNodeIsThereOnceHalfWayBetweenItsParents) {
  const PoseSpace space = Explored(3);
  std::set<std::array<int, 2>> pairs;
  for (size_t i = 0; i < space.parents.size(); ++i) {
    const auto& parents = space.parents[i];
    EXPECT_TRUE(pairs.insert(parents).second);
    const Eigen::Vector2d middle =
        (space.points.col(parents[0]) + space.points.col(parents[1])) / 2;
    EXPECT_LT((space.points.col(space.NumPoses() + static_cast<int>(i)) - middle).norm(), 1e-15);
  }
}

TEST(RefinementTest, LowersTheErrorUntilItIsBelowTheThreshold) {
  const ShapeFamily tube = SmallTube();
  ExploreOptions options;
  double before = 1;
  for (int depth : {0, 1, 3}) {
    options.depth = depth;
    const PoseSpace space = Explore(tube.connectivity, TubePoses(tube), {}, options).space;
    const BlendErrors errors = MeasureBlends(space, 100, options);
    EXPECT_EQ(errors.samples, 100);
    EXPECT_LT(errors.max, 0.7 * before) << depth;
    EXPECT_LE(errors.mean, errors.max);
    before = errors.max;
    if (depth == 3) {
      EXPECT_EQ(errors.within, 1);
      EXPECT_LE(errors.max, options.threshold);
    }
  }
}

TEST(MeasureBlends, MeasuresInTheMetricOfTheSpace) {
  const ShapeFamily tube = SmallTube();
  ExploreOptions options;
  options.depth = 0;
  options.geodesic.metric.isometric = 0;
  options.geodesic.metric.strain = 1;
  options.geodesic.metric.bending = 1e-3;
  const PoseSpace space = Explore(tube.connectivity, TubePoses(tube), {}, options).space;
  const BlendErrors own = MeasureBlends(space, 10, options);
  options.geodesic.metric = MetricOptions::Isometric();
  options.geodesic.metric.bending = 0;
  const BlendErrors other = MeasureBlends(space, 10, options);
  EXPECT_EQ(other.mean, own.mean);
  EXPECT_EQ(other.max, own.max);
}

// Where only positions count and no pose is turned against another, geodesics are straight lines.
TEST(MeasureBlends, StraightLinesAreRightWhereTheMetricIsFlat) {
  const ShapeFamily bar = MakeBar(3, 2, 1, 3, 2, 1);
  std::vector<Shape> poses(3, bar.pose(0));
  for (int k = 0; k < 3; ++k) poses[k].row(k) *= 1.5;
  ExploreOptions options;
  options.depth = 0;
  MetricOptions& metric = options.geodesic.metric;
  metric.isometric = metric.strain = metric.bending = 0;
  metric.lambda = 1;
  const PoseSpace space = Explore(bar.connectivity, poses, {}, options).space;
  EXPECT_LT(MeasureBlends(space, 20, options).max, 1e-3);
}

TEST(RefinementTest, StopsWhereStraightLinesAreGoodEnough) {
  const ShapeFamily tube = SmallTube();
  ExploreOptions options;
  options.threshold = 100;
  const ExploreResult all = Explore(tube.connectivity, TubePoses(tube), {}, options);
  EXPECT_EQ(all.space.NumNodes(), 4);
  EXPECT_EQ(all.summary.levels.size(), 1u);
  EXPECT_EQ(all.summary.edges_not_measured, 0);
  options.threshold = 0.05;
  options.depth = 1;
  const ExploreResult one = Explore(tube.connectivity, TubePoses(tube), {}, options);
  EXPECT_GT(one.summary.levels[0].marked, 0);
  EXPECT_GT(one.summary.levels[0].greatest_excess, options.threshold);
  EXPECT_GT(one.summary.edges_not_measured, 0);
  EXPECT_EQ(one.space.NumNodes(), 4 + one.summary.levels[0].new_nodes);
  options.depth = 10;
  const ExploreResult whole = Explore(tube.connectivity, TubePoses(tube), {}, options);
  EXPECT_LT(whole.summary.levels.size(), 10u);
  EXPECT_EQ(whole.summary.levels.back().marked, 0);
  EXPECT_EQ(whole.summary.edges_not_measured, 0);
}

// An edge is marked if its excess is above the threshold.
TEST(RefinementTest, BelowTheGreatestExcessOneEdgeIsMarked) {
  const ShapeFamily tube = SmallTube();
  ExploreOptions options;
  options.depth = 1;
  const auto measured = [&](double threshold) {
    options.threshold = threshold;
    return Explore(tube.connectivity, TubePoses(tube), {}, options).summary.levels[0];
  };
  const double greatest = measured(100).greatest_excess;
  EXPECT_EQ(measured(greatest).marked, 0);
  EXPECT_EQ(measured(0.999 * greatest).marked, 1);
}

// Poses close to each other and one far away: only the triangles at the latter are split, so that
// triangles with one and with two halved sides occur.
TEST(RefinementTest, NeighboursOfWhatIsSplitFollow) {
  const ShapeFamily tube = SmallTube();
  std::vector<Shape> poses = {tube.pose(100)};
  for (const auto& [bend, twist] : {std::make_pair(0, 0), {8, 0}, {0, 20}, {9, 22}, {4, -15}}) {
    poses.push_back(testing::BentAndTwisted(tube, bend, twist));
  }
  ExploreOptions options;
  options.depth = 1;
  options.threshold = 0.2;
  const ExploreResult result = Explore(tube.connectivity, poses, {}, options);
  const ExploreSummary::Level& level = result.summary.levels[0];
  EXPECT_GT(level.marked, 0);
  EXPECT_LT(level.marked, level.edges);
  EXPECT_LT(level.new_nodes, level.edges);
  EXPECT_LT(result.summary.cells, 4 * level.cells);
  options.depth = 0;
  const PoseSpace before = Explore(tube.connectivity, poses, {}, options).space;
  EXPECT_NEAR(AreaOf(result.space), AreaOf(before), 1e-12 * AreaOf(before));
}

TEST(RefinementTest, NodesArePosesAndNewOnesKeepTheirSize) {
  const PoseSpace space = Explored(2);
  const auto area = [&](const Shape& shape) {
    double sum = 0;
    const Eigen::Matrix3Xi& triangles = space.metric->connectivity->Triangles();
    for (int t = 0; t < triangles.cols(); ++t) {
      const Eigen::Vector3d a = shape.col(triangles(0, t));
      sum += (shape.col(triangles(1, t)) - a).cross(shape.col(triangles(2, t)) - a).norm() / 2;
    }
    return sum;
  };
  for (int i = 0; i < space.NumNodes(); ++i) {
    EXPECT_NEAR(area(space.nodes[i]), 1, 0.02) << i;
    EXPECT_LT(Centroid(space.nodes[i], space.metric->vertex_area).norm(), 1e-10) << i;
  }
}

}  // namespace
}  // namespace shapespace
