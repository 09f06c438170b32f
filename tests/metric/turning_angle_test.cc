#include <cmath>
#include <random>
#include <utility>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/bodies/bar.h>
#include <shapespace/metric/define_feature.h>
#include <shapespace/metric/metric.h>
#include <shapespace/metric/turning_angle.h>

namespace shapespace {
namespace {

using Segments = std::vector<std::pair<int, int>>;

Segments Polyline(int num_vertices) {
  Segments segments;
  for (int v = 0; v + 1 < num_vertices; ++v) segments.emplace_back(v, v + 1);
  return segments;
}

std::shared_ptr<const Connectivity> Curve(int num_vertices) {
  return Connectivity::Make(num_vertices, {0}, {}, Polyline(num_vertices));
}

/// `angle` of a circle of circumference `length` 2 pi / angle.
Shape Arc(int num_vertices, double length, double angle) {
  Shape arc(3, num_vertices);
  for (int v = 0; v < num_vertices; ++v) {
    const double at = static_cast<double>(v) / (num_vertices - 1);
    const double radius = length / angle;
    arc.col(v) << radius * std::sin(at * angle), radius * (1 - std::cos(at * angle)), 0;
  }
  return arc;
}

double Angle(const TurningAngle& feature, const Eigen::Matrix3d& x) {
  double value;
  feature(x.data(), &value);
  return value;
}

TEST(TurningAngle, IsThatBetweenTheSegmentsInAnyPlaceAndUnit) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  TurningAngle feature;
  for (int i = 0; i < 200; ++i) {
    const Eigen::Matrix3d x = Eigen::Matrix3d::NullaryExpr([&] { return normal(random); });
    const Eigen::Vector3d to = x.col(1) - x.col(0), on = x.col(2) - x.col(1);
    const double expected = std::acos(to.normalized().dot(on.normalized()));
    EXPECT_NEAR(Angle(feature, x), expected, 1e-9);
    const Eigen::Matrix3d turn(
        Eigen::AngleAxisd(normal(random), Eigen::Vector3d(1, 2, 3).normalized()));
    EXPECT_NEAR(Angle(feature, ((1e-3 * turn * x).colwise() + on).eval()), expected, 1e-9);
  }
}

TEST(TurningAngle, IsFiniteWithItsDerivativesWhereCurvesAreStraightOrCollapsed) {
  TurningAngle feature;
  feature.epsilon_squared = 1e-16;
  for (const double at : {0.5, 0.0, 1.0, 2.0}) {  // straight, collapsed, folded back
    const double x[9] = {0, 0, 0, at, 0, 0, 1, 0, 0};
    double value, derivative[9];
    internal::DeriveAutomatically(feature, x, &value, derivative);
    EXPECT_TRUE(std::isfinite(value)) << at;
    for (const double d : derivative) EXPECT_TRUE(std::isfinite(d)) << at;
    internal::LineJet jet[9], second;
    for (int k = 0; k < 9; ++k) jet[k] = {x[k], 0.1 * k, 0};
    feature(jet, &second);
    EXPECT_TRUE(std::isfinite(second.second)) << at;
  }
}

// The preconditioner's row is the derivative across the curve.
TEST(TurningAngle, HasTheRowOfAMotionAcrossTheCurve) {
  TurningAngle feature;
  feature.epsilon_squared = 1e-16;
  const double x[9] = {0, 0, 0, 0.7, 0, 0, 2, 1e-3, 0};
  double value, derivative[9], row[3];
  internal::DeriveAutomatically(feature, x, &value, derivative);
  const Eigen::Vector3d vertices[] = {{0, 0, 0}, {0.7, 0, 0}, {2, 1e-3, 0}};
  feature.ScalarRows(vertices, row);
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(row[k], derivative[3 * k + 1], 1e-2);
}

TEST(TurningAngle, IsOfVerticesWhereTwoSegmentsMeetAndNothingElse) {
  // A curve with a branch at vertex 2, and one that ends in a triangle.
  Segments segments = {{0, 1}, {1, 2}, {2, 3}, {2, 4}, {5, 6}, {6, 7}};
  const auto mesh = Connectivity::Make(10, {0, 3}, {7, 8, 9}, segments, {{0, 3}, {1, 4}});
  const Eigen::Matrix3Xi turns = Turns(*mesh);
  ASSERT_EQ(turns.cols(), 2);
  EXPECT_EQ(turns.col(0), Eigen::Vector3i(0, 1, 2));
  EXPECT_EQ(turns.col(1), Eigen::Vector3i(5, 6, 7));
  EXPECT_TRUE(Bends(*mesh));
  EXPECT_FALSE(Bends(*Connectivity::Make(4, {0}, {}, {{0, 1}, {0, 2}, {0, 3}})));
  const ShapeFamily bar = MakeBar(6, 1, 1, 4, 1, 1);
  EXPECT_EQ(Turns(*bar.connectivity).cols(), 0);
}

// Rolling a curve up costs 3 angle^2 / length, as often as it is divided, evenly or not.
TEST(TurningAngle, CostsTheSameForAnyDivision) {
  const double length = 5, angle = 2;
  for (const int n : {20, 80}) {
    std::mt19937 random(n);
    std::uniform_real_distribution<double> place(0.2, 1);
    for (const bool even : {true, false}) {
      Eigen::VectorXd at = Eigen::VectorXd::Zero(n);
      for (int v = 1; v < n; ++v) at(v) = at(v - 1) + (even ? 1 : place(random));
      at /= at(n - 1);
      Shape straight = Shape::Zero(3, n), bent = Shape::Zero(3, n);
      for (int v = 0; v < n; ++v) {
        straight(0, v) = length * at(v);
        bent.col(v) << std::sin(angle * at(v)), 1 - std::cos(angle * at(v)), 0;
        bent.col(v) *= length / angle;
      }
      const auto metric = FreezeMetric({}, Curve(n), {straight, bent});
      double cost = 0;
      for (const auto& feature : metric->features) {
        const auto* const turning = feature->As<TurningAngle>();
        if (turning == nullptr) continue;
        for (int i = 0; i < feature->NumElements(); ++i) {
          double x[9], before, after;
          GatherCoordinates(*turning, i, straight / metric->unit, x);
          (*turning)(x, &before);
          GatherCoordinates(*turning, i, bent / metric->unit, x);
          (*turning)(x, &after);
          cost += feature->Weight(i) * (after - before) * (after - before);
        }
      }
      EXPECT_NEAR(cost, 1e-5 * 3 * angle * angle, (even ? 1.5 : 3) / n * cost) << n << even;
    }
  }
}

TEST(TurningAngle, TakesTheBendingAndItsStiffness) {
  const auto curve = Curve(6);
  const Shape arc = Arc(6, 1, 1);
  const auto weights = [&](const MetricOptions& options) -> Eigen::VectorXd {
    const auto metric = FreezeMetric(options, curve, {arc});
    for (const auto& feature : metric->features) {
      if (feature->Name() == TurningAngle::kName) return feature->Weights();
    }
    return {};
  };
  MetricOptions options;
  const Eigen::VectorXd plain = weights(options);
  ASSERT_EQ(plain.size(), 4);
  options.bending *= 7;
  EXPECT_TRUE(weights(options).isApprox(7 * plain, 1e-14));
  options = {};
  options.bending_stiffness = Eigen::VectorXd::Ones(6);
  options.bending_stiffness(2) = 5;
  const Eigen::VectorXd stiff = weights(options);
  // Of vertex 2 both segments are stiffer, of its neighbours one.
  EXPECT_NEAR(stiff(1) / plain(1), 3, 1e-12);
  EXPECT_NEAR(stiff(0) / plain(0), 2, 1e-12);
  EXPECT_NEAR(stiff(2) / plain(2), 2, 1e-12);
  EXPECT_NEAR(stiff(3) / plain(3), 1, 1e-12);
  options = {};
  options.bending = 0;
  EXPECT_EQ(weights(options).size(), 0);
}

}  // namespace
}  // namespace shapespace
