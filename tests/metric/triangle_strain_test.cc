#include <shapespace/metric/triangle_strain.h>

#include <cmath>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/metric/metric.h>

#include "support/features.h"

namespace shapespace {
namespace {

using Corners = Eigen::Matrix3d;  // of a triangle, one a column

Eigen::Vector3d Values(const Corners& corners) {
  Eigen::Vector3d value;
  TriangleStrain()(corners.data(), value.data());
  return value;
}

const Eigen::Matrix2d kEquilateral{{1, 0.5}, {0, std::sqrt(0.75)}};

/// A triangle that has the strain L: its edges are E' = exp(L) E, since E'^T E' = E^T exp(2 L) E.
Corners WithStrain(const Eigen::Matrix2d& strain) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> eigen(strain);
  const Eigen::Matrix2d stretch = eigen.eigenvectors() *
                                  eigen.eigenvalues().array().exp().matrix().asDiagonal() *
                                  eigen.eigenvectors().transpose();
  Corners corners = Corners::Zero();
  corners.topRightCorner<2, 2>() = stretch * kEquilateral;
  return corners;
}

Eigen::Matrix2d StrainOf(const Eigen::Vector3d& value) {
  const double half = M_SQRT2 * value(1), side = M_SQRT2 * value(2);
  return Eigen::Matrix2d{{value(0) + half, side}, {side, value(0) - half}};
}

TEST(TriangleStrain, EveryThreeNumbersAreTheValuesOfATriangle) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (const double size : {1e-6, 1e-3, 0.03, 0.1, 1.0, 3.0}) {
    for (int trial = 0; trial < 50; ++trial) {
      const Eigen::Vector3d wanted =
          size * Eigen::Vector3d(normal(random), normal(random), normal(random));
      const Eigen::Vector3d found = Values(WithStrain(StrainOf(wanted)));
      EXPECT_LT((found - wanted).norm(), 1e-13 * (1 + std::exp(2 * wanted.norm())))
          << wanted.transpose() << " became " << found.transpose();
    }
  }
}

TEST(TriangleStrain, GivesTheSidesOfTheTriangleThatHasItsValues) {
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  TriangleStrain strain;
  strain.epsilon_squared = 1e-3;
  for (int i = 0; i < 20; ++i) {
    Corners corners;
    for (double& x : corners.reshaped()) x = normal(random);
    Eigen::Vector3d value;
    strain(corners.data(), value.data());
    const auto squared = strain.SquaredSides(value.data());
    for (int k = 0; k < 3; ++k) {
      const double side = (corners.col((k + 1) % 3) - corners.col((k + 2) % 3)).squaredNorm();
      EXPECT_NEAR(squared[k], side, 1e-10 * (1 + side));
    }
  }
}

TEST(TriangleStrain, ItsSquareIsTheMeanOverAllDirections) {
  const Eigen::Vector3d value(0.3, -0.2, 0.5);
  const Eigen::Matrix2d strain = StrainOf(value);
  double mean = 0;
  constexpr int kDirections = 100;
  for (int i = 0; i < kDirections; ++i) {
    const double angle = M_PI * i / kDirections;
    const Eigen::Vector2d n(std::cos(angle), std::sin(angle));
    mean += std::pow(n.dot(strain * n), 2) / kDirections;
  }
  EXPECT_NEAR(value.squaredNorm(), mean, 1e-14);
}

TEST(TriangleStrain, DoesNotSeeRigidMotionAndAddsUpUnderScaling) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(2, Eigen::Vector3d(1, 2, 3).normalized()));
  for (int trial = 0; trial < 20; ++trial) {
    const Corners corners = Corners::NullaryExpr([&] { return normal(random); });
    const Eigen::Vector3d value = Values(corners);
    const Corners moved = (turn * corners).colwise() + Eigen::Vector3d(3, -2, 5);
    EXPECT_LT((Values(moved) - value).norm(), 1e-11);
    EXPECT_LT((Values(1000 * corners) - value - Eigen::Vector3d(std::log(1000), 0, 0)).norm(),
              1e-12);
  }
}

TEST(TriangleStrain, IsTheStrainOfEdgesWhereTrianglesAreEquilateralAndStrainsSmall) {
  // The mean over the directions of an equilateral triangle's three edges equals the mean over all
  // directions.
  const auto triangle = Connectivity::Make(3, {0, 3}, {0, 1, 2});
  const Corners still = WithStrain(Eigen::Matrix2d::Zero());
  MetricOptions edges = MetricOptions::Isometric(), triangles;
  edges.lambda = triangles.lambda = 0;
  const auto cost = [&](const MetricOptions& options, const Corners& moved) {
    const auto metric = FreezeMetric(options, triangle, {Shape(still)});
    const FeatureMap map(metric);
    return (map.Values(moved / metric->unit) - map.Values(still / metric->unit)).squaredNorm();
  };
  for (const Eigen::Vector3d& way :
       {Eigen::Vector3d(1, 0, 0), Eigen::Vector3d(0, 1, 0), Eigen::Vector3d(0.3, -0.5, 0.8)}) {
    const Corners moved = WithStrain(StrainOf(1e-5 * way));
    EXPECT_NEAR(cost(triangles, moved) / cost(edges, moved), 1, 1e-4) << way.transpose();
  }
}

TEST(TriangleStrain, HoldsEdgesWithoutTrianglesByTheirOwnStrain) {
  Shape shape(3, 4);
  shape << 0, 1, 0, 2, 0, 0, 1, 0, 0, 0, 0, 0;
  const auto graph = Connectivity::Make(4, {0}, {}, {{0, 1}, {1, 2}, {1, 3}});
  const auto sticks = FreezeMetric(MetricOptions::Strain(), graph, {shape});
  ASSERT_TRUE(sticks->features[0]->As<LogLength>() != nullptr);
  EXPECT_TRUE(testing::Get<LogLength>(*sticks).weights.isApprox(sticks->edge_area));
  const auto flag = Connectivity::Make(4, {0, 3}, {0, 1, 2}, {{1, 3}});
  const auto both = FreezeMetric(MetricOptions::Strain(), flag, {shape});
  ASSERT_TRUE(both->features[0]->As<TriangleStrain>() != nullptr);
  ASSERT_TRUE(both->features[1]->As<LogLength>() != nullptr);
  EXPECT_EQ(testing::Get<LogLength>(*both).stencils, Eigen::Matrix2Xi(flag->Edges().rightCols(1)));
}

TEST(TriangleStrain, CollapsedTrianglesHaveFiniteValues) {
  TriangleStrain strain;
  strain.epsilon_squared = 1e-16;
  Corners point = Corners::Zero(), line = Corners::Zero();
  line(0, 1) = 1;
  line(0, 2) = 2;
  for (const Corners& corners : {point, line}) {
    Eigen::Vector3d value;
    strain(corners.data(), value.data());
    EXPECT_TRUE(value.allFinite()) << value.transpose();
  }
}

}  // namespace
}  // namespace shapespace
