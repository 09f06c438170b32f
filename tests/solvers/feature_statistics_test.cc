// The parts of which averages and modes are made.

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/bodies/bar.h>
#include <shapespace/metric/dihedral.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/statistics/detail/feature_chart.h>
#include <shapespace/statistics/detail/feature_statistics.h>
#include <shapespace/statistics/detail/logarithms.h>
#include <shapespace/statistics/detail/permutations.h>
#include <shapespace/statistics/detail/procrustes.h>
#include <shapespace/statistics/detail/size.h>

#include "support/features.h"
#include "support/motions.h"
#include "support/paths.h"

namespace shapespace::internal {
namespace {

using shapespace::testing::Get;
using shapespace::testing::Noise;
using shapespace::testing::Rotation;

// Two triangles with a common edge, of which one is turned about it.
Shape HingeAt(double degrees) {
  const double turn = degrees * M_PI / 180;
  return (Shape(3, 4) << 0, 0, 1, -std::cos(turn), 0, 1, 0.5, 0.4, 0, 0, 0, std::sin(turn))
      .finished();
}

struct OneHinge {
  explicit OneHinge(const std::vector<double>& degrees) {
    for (const double angle : degrees) poses.push_back(HingeAt(angle));
    metric = FreezeMetric(
        {}, Connectivity::FromTriangles(4, (Eigen::Matrix3Xi(3, 2) << 0, 1, 1, 0, 2, 3).finished()),
        poses, 0, PosePairs::kAll);
    for (Shape& pose : poses) pose /= metric->unit;
    for (size_t i = 0; i < metric->features.size(); ++i) {
      if (metric->features[i]->As<Dihedral>() != nullptr) feature = i;
    }
  }
  double Weight() const { return Get<Dihedral>(*metric).weights(0); }

  std::vector<Shape> poses;
  std::shared_ptr<const Metric> metric;
  size_t feature = 0;
};

TEST(FeatureStatistics, MeanAndVarianceAreArithmeticButForAngles) {
  const OneHinge hinge({150, 170, -160});
  const FeatureMap map(hinge.metric);
  const Eigen::Vector3d weights(0.5, 0.2, 0.3);
  const FeatureStatistics statistics(map, hinge.poses, weights);
  Eigen::MatrixXd values(map.Values(hinge.poses[0]).size(), 3);
  for (int i = 0; i < 3; ++i) values.col(i) = map.Values(hinge.poses[i]);
  Eigen::VectorXd expected = values * weights;
  const int at = map.FirstValue(hinge.feature);
  // The weighted mean of 150, 170 and 200 degrees, counted from where the first pose is.
  const Eigen::Vector2d first = values.col(0).segment<2>(at);
  const double turn = (0.2 * 20 + 0.3 * 50) * M_PI / 180;
  Eigen::Vector2d there = Eigen::Rotation2Dd(turn) * first,
                  back = Eigen::Rotation2Dd(-turn) * first;
  const Eigen::Vector2d mean = statistics.Mean().segment<2>(at);
  EXPECT_LT(std::min((mean - there).norm(), (mean - back).norm()), 1e-12);
  expected.segment<2>(at) = mean;
  EXPECT_TRUE(statistics.Mean().isApprox(expected, 1e-13));
  double variance = 0;
  for (int i = 0; i < 3; ++i) variance += weights(i) * (values.col(i) - expected).squaredNorm();
  EXPECT_NEAR(statistics.Variance(), variance, 1e-13);
}

// The least over a fine grid of angles and all ways to unwrap.
TEST(FeatureStatistics, TheLowerBoundIsTheLeastOfEveryFeature) {
  const std::vector<double> degrees = {100, 175, -150, -60};
  const OneHinge hinge(degrees);
  const FeatureMap map(hinge.metric);
  const Eigen::Vector4d weights(0.4, 0.1, 0.2, 0.3);
  Eigen::MatrixXd values(map.Values(hinge.poses[0]).size(), 4);
  for (int i = 0; i < 4; ++i) values.col(i) = map.Values(hinge.poses[i]);
  const int at = map.FirstValue(hinge.feature);
  double others = 0;
  for (int k = 0; k < values.rows(); ++k) {
    if (k == at || k == at + 1) continue;
    const double mean = values.row(k).dot(weights);
    for (int i = 0; i < 4; ++i) others += weights(i) * std::pow(values(k, i) - mean, 2);
  }
  for (const int segments : {1, 2, 5}) {
    double least = 1e9;
    for (int t = 0; t < 7200; ++t) {
      const double angle = t * M_PI / 3600;
      double sum = 0;
      for (int i = 0; i < 4; ++i) {
        double nearest = 1e9;
        for (const int turns : {-2, -1, 0, 1, 2}) {
          const double off = degrees[i] * M_PI / 180 + 2 * M_PI * turns - angle;
          if (std::abs(off) > M_PI * segments) continue;
          nearest = std::min(nearest, std::pow(2 * segments * std::sin(off / (2 * segments)), 2));
        }
        sum += weights(i) * nearest;
      }
      least = std::min(least, sum);
    }
    const double bound = FeatureStatistics(map, hinge.poses, weights).LowerBound(segments);
    EXPECT_NEAR(bound, others + hinge.Weight() * least, 1e-5 * bound) << segments;
  }
}

TEST(FeatureChart, AnglesAreTakenTheShorterWayAndComeBack) {
  const OneHinge hinge({160, -170});
  const FeatureMap map(hinge.metric);
  const int at = map.FirstValue(hinge.feature);
  const Eigen::VectorXd from = map.Values(hinge.poses[0]), to = map.Values(hinge.poses[1]);
  const FeatureChart chart(map, from);
  EXPECT_EQ(chart.Centre(), from);
  const Eigen::VectorXd relative = chart.Log(to);
  EXPECT_NEAR(std::abs(relative(at)), std::sqrt(hinge.Weight()) * 30 * M_PI / 180, 1e-9);
  EXPECT_EQ(relative(at + 1), 0);
  EXPECT_TRUE(chart.Exp(relative).isApprox(to, 1e-9));
  Eigen::VectorXd rest = relative - (to - from);
  rest.segment<2>(at).setZero();
  EXPECT_EQ(rest.norm(), 0);
  // Half of it is half of the angle.
  EXPECT_NEAR(chart.Log(chart.Exp(0.5 * relative))(at), 0.5 * relative(at), 1e-12);
  // A hinge that has collapsed has not turned.
  Eigen::VectorXd collapsed = to;
  collapsed.segment<2>(at).setZero();
  EXPECT_EQ(chart.Log(collapsed)(at), 0);
  EXPECT_EQ(chart.Log(collapsed)(at + 1), 0);
  // At another point of the circle the change is tangential there, as long, and in the same sense.
  const Eigen::VectorXd change = chart.ChangeAt(to, relative);
  constexpr double kStep = 1e-6;
  const Eigen::VectorXd slope =
      (chart.Exp((1 + kStep) * relative) - chart.Exp((1 - kStep) * relative)) / (2 * kStep);
  EXPECT_LT((change - slope).norm(), 1e-6 * slope.norm());
}

// A point inside of the circle, the mean of hinges that collapse, may move straight.
TEST(FeatureChart, InsideOfTheCircleNothingIsAnAngle) {
  const OneHinge hinge({160, -170});
  const FeatureMap map(hinge.metric);
  const int at = map.FirstValue(hinge.feature);
  Eigen::VectorXd centre = map.Values(hinge.poses[0]);
  centre.segment<2>(at) *= 0.9;
  const FeatureChart chart(map, centre);
  const Eigen::VectorXd to = map.Values(hinge.poses[1]);
  EXPECT_EQ(chart.Log(to), to - centre);
  EXPECT_EQ(chart.Exp(to - centre), centre + (to - centre));
  EXPECT_EQ(chart.ChangeAt(to, centre), centre);
}

TEST(MeanMotion, WeighsRotationsAndTranslations) {
  AlignedPoses poses;
  const double turn = 1.1;
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(turn, Eigen::Vector3d(1, 2, 2).normalized()).toRotationMatrix();
  poses.motions = {{Eigen::Matrix3d::Identity(), {1, 2, 3}}, {rotation, {5, -2, 7}}};
  const RigidMotion mean = MeanMotion(poses, Eigen::Vector2d(0.25, 0.75));
  EXPECT_TRUE(mean.translation.isApprox(Eigen::Vector3d(4, -1, 6), 1e-14));
  const double expected = std::atan2(0.75 * std::sin(turn), 0.25 + 0.75 * std::cos(turn));
  const Eigen::Matrix3d wanted =
      Eigen::AngleAxisd(expected, Eigen::Vector3d(1, 2, 2).normalized()).toRotationMatrix();
  EXPECT_TRUE(mean.rotation.isApprox(wanted, 1e-9));
}

TEST(AlignToMean, EveryPoseIsTurnedOntoTheMeanAndComesBack) {
  const ShapeFamily bar = MakeBar(4, 1, 1, 6, 2, 2);
  std::vector<Shape> poses;
  for (int i = 0; i < 3; ++i) {
    // With noise: bars that are symmetric are turned onto each other at once.
    const Shape bent = bar.pose(40 * i) + Noise(bar.connectivity->NumVertices(), 0.2, i);
    poses.push_back((Rotation(50 * i, {1, 2, 3}) * bent).colwise() + Eigen::Vector3d(i, -5, 2));
  }
  const auto metric = FreezeMetric({}, bar.connectivity, poses);
  const Eigen::Vector3d weights(0.2, 0.5, 0.3);
  const AlignedPoses aligned = AlignToMean(*metric, poses, weights);
  Shape mean = Shape::Zero(3, poses[0].cols());
  for (int i = 0; i < 3; ++i) mean += weights(i) * aligned.shapes[i];
  for (int i = 0; i < 3; ++i) {
    EXPECT_TRUE(
        FitRigidMotion(aligned.shapes[i], mean, metric->vertex_area).rotation.isIdentity(1e-5));
    EXPECT_LT((aligned.motions[i](metric->unit * aligned.shapes[i]) - poses[i]).norm(), 1e-9);
    EXPECT_LT(Centroid(aligned.shapes[i], metric->vertex_area).norm(), 1e-12);
  }
}

TEST(Size, IsTheRootOfTheAreaOrTheLengthOfAllEdges) {
  const auto mesh =
      Connectivity::FromTriangles(4, (Eigen::Matrix3Xi(3, 2) << 0, 1, 1, 0, 2, 3).finished());
  // Areas 1/2 each, whatever the angle.
  EXPECT_NEAR(Size(*mesh, HingeAt(70)), 1, 1e-12);
  EXPECT_NEAR(Size(*mesh, 3 * HingeAt(70)), 3, 1e-12);
  const auto graph = Connectivity::Make(3, {0}, {}, {{0, 1}, {1, 2}});
  Shape line(3, 3);
  line << 0, 3, 3, 0, 4, 4, 0, 0, 2;
  EXPECT_NEAR(Size(*graph, line), 7, 1e-12);
  std::vector<Shape> shapes = {line, (3 * line).colwise() + Eigen::Vector3d(5, 6, 7)};
  const std::vector<Shape> before = shapes;
  ScaleToMeanSize(*graph, &shapes);
  for (int i = 0; i < 2; ++i) {
    EXPECT_NEAR(Size(*graph, shapes[i]), 14, 1e-12);
    EXPECT_TRUE(shapes[i].rowwise().mean().isApprox(before[i].rowwise().mean(), 1e-13));
  }
  // A shape without extent is left for others to refuse.
  shapes = {line, Shape::Constant(3, 3, 2)};
  ScaleToMeanSize(*graph, &shapes);
  EXPECT_TRUE(shapes[1].isApproxToConstant(2, 0));
  EXPECT_NEAR(Size(*graph, shapes[0]), 3.5, 1e-12);
}

TEST(RemoveRigidPart, LeavesNoMomentumAndWhatIsNotRigid) {
  const Eigen::VectorXd area = Eigen::VectorXd::LinSpaced(7, 0.5, 2);
  Shape shape = Noise(7, 1, 1);
  shape.colwise() -= Centroid(shape, area);
  const Tangent change = Noise(7, 1, 2);
  const Eigen::Vector3d way(1, -2, 3), turn(0.3, 0.5, -0.7);
  Tangent moved = change.colwise() + way;
  for (int v = 0; v < 7; ++v) moved.col(v) += turn.cross(shape.col(v));
  Tangent one = change, other = moved;
  RemoveRigidPart(shape, area, &one);
  RemoveRigidPart(shape, area, &other);
  EXPECT_LT((one - other).norm(), 1e-12);
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero(), moment = momentum;
  for (int v = 0; v < 7; ++v) {
    momentum += area(v) * one.col(v);
    moment += area(v) * shape.col(v).cross(one.col(v));
  }
  EXPECT_LT(momentum.norm(), 1e-12);
  EXPECT_LT(moment.norm(), 1e-12);
  RemoveRigidPart(shape, area, &(other = one));
  EXPECT_LT((one - other).norm(), 1e-12);
}

TEST(Permutations, AllOrdersAreEquallyLikely) {
  Permutations permutations(4, 3);
  std::map<std::vector<int>, int> counts;
  constexpr int kDrawn = 24000;
  for (int i = 0; i < kDrawn; ++i) ++counts[permutations.Next()];
  EXPECT_EQ(counts.size(), 24u);
  for (const auto& [order, count] : counts) {
    EXPECT_NEAR(count, kDrawn / 24, 200);  // more than six standard deviations
    std::vector<int> sorted = order;
    std::sort(sorted.begin(), sorted.end());
    EXPECT_EQ(sorted, (std::vector<int>{0, 1, 2, 3}));
  }
  Permutations same(4, 9), again(4, 9), other(4, 10);
  bool differs = false;
  for (int i = 0; i < 20; ++i) {
    const std::vector<int> next = same.Next();
    EXPECT_EQ(next, again.Next());
    differs = differs || next != other.Next();
  }
  EXPECT_TRUE(differs);
}

}  // namespace
}  // namespace shapespace::internal
