#include <shapespace/metric/triangle_strain.h>

#include <cmath>
#include <random>
#include <vector>

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

// Relative to the equilateral triangle, unless there are other numbers.
Eigen::Vector3d Values(const Corners& corners,
                       const Eigen::Vector4d& numbers = TriangleStrain::UsualNumbers(),
                       const TriangleStrain& strain = {}) {
  Eigen::Matrix<double, TriangleStrain::kInputs, 1> x;
  x << corners.reshaped(), numbers;
  Eigen::Vector3d value;
  strain(x.data(), value.data());
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
    const Eigen::Vector4d numbers(2 + normal(random), normal(random) / 2, normal(random) / 2,
                                  2 + normal(random));
    const Eigen::Vector3d value = Values(corners, numbers, strain);
    const auto squared = strain.SquaredSides(value.data(), numbers.data());
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

// Strains of a metric's only triangle in its poses.
std::vector<Eigen::Vector3d> StrainsIn(const std::vector<Corners>& poses) {
  MetricOptions options;
  options.lambda = 0;
  const auto triangle = Connectivity::Make(3, {0, 3}, {0, 1, 2});
  const auto metric = FreezeMetric(options, triangle, {poses.begin(), poses.end()});
  std::vector<Eigen::Vector3d> strains;
  for (const Corners& pose : poses) {
    strains.push_back(Values(pose / metric->unit, testing::Get<TriangleStrain>(*metric).numbers,
                             testing::Get<TriangleStrain>(*metric)));
  }
  return strains;
}

Corners RandomCorners(std::mt19937* random, double height) {
  std::normal_distribution<double> normal;
  Corners corners = Corners::NullaryExpr([&] { return normal(*random); });
  corners.row(1) *= height;
  return corners;
}

TEST(TriangleStrain, OfOnePoseIsThatOfItsAreaAlone) {
  std::mt19937 random(6);
  for (const double height : {1.0, 1e-1, 1e-3, 1e-5}) {
    for (int trial = 0; trial < 10; ++trial) {
      Corners corners = RandomCorners(&random, height);
      corners.row(2) *= height;
      const Eigen::Vector3d strain = StrainsIn({corners})[0];
      EXPECT_LT(strain.tail<2>().norm(), 1e-15 / (height * height) + 1e-12) << height;
    }
  }
}

// The metric of symmetric positive matrices g that no linear map changes, tr((g^-1 g')^2), has the
// distance |log of the eigenvalues of g0^-1 g1|, and knows nothing of a triangle at rest.
TEST(TriangleStrain, TheDistanceOfTwoPosesIsThatOfTheAffineInvariantMetric) {
  std::mt19937 random(7);
  for (const double height : {1.0, 1e-1, 1e-2}) {
    for (int trial = 0; trial < 20; ++trial) {
      const std::vector<Corners> poses = {RandomCorners(&random, height),
                                          RandomCorners(&random, height)};
      const auto strains = StrainsIn(poses);
      const auto form = [](const Corners& corners) {
        const Eigen::Matrix<double, 3, 2> edges = corners.rightCols<2>().colwise() - corners.col(0);
        return Eigen::Matrix2d(edges.transpose() * edges);
      };
      const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::Matrix2d> eigen(form(poses[1]),
                                                                            form(poses[0]));
      const Eigen::Array2d logarithms = eigen.eigenvalues().array().log() / 2;
      // The mean square over all directions of a strain with these eigenvalues.
      const double expected =
          std::sqrt((logarithms.square().sum() + std::pow(logarithms.sum(), 2) / 2) / 4);
      EXPECT_NEAR((strains[1] - strains[0]).norm() / expected, 1, 1e-10 / (height * height));
    }
  }
}

// As seen from any corner.
TEST(TriangleStrain, NoCornerIsTheFirst) {
  std::mt19937 random(8);
  for (int trial = 0; trial < 20; ++trial) {
    std::vector<Corners> poses, turned;
    for (int i = 0; i < 3; ++i) {
      poses.push_back(RandomCorners(&random, 0.2));
      turned.emplace_back();
      turned[i] << poses[i].col(1), poses[i].col(2), poses[i].col(0);
    }
    const auto strains = StrainsIn(poses), others = StrainsIn(turned);
    for (int i = 0; i < 2; ++i) {
      const Eigen::Vector3d change = strains[i + 1] - strains[i], other = others[i + 1] - others[i];
      // The strain has turned with the triangle, by 120 degrees.
      EXPECT_NEAR(change(0), other(0), 1e-12);
      const Eigen::Rotation2Dd turn(2 * M_PI / 3);
      EXPECT_LT((turn * change.tail<2>() - other.tail<2>()).norm(), 1e-10);
    }
  }
}

TEST(TriangleStrain, CollapsedTrianglesHaveFiniteValues) {
  TriangleStrain strain;
  strain.epsilon_squared = 1e-16;
  Corners point = Corners::Zero(), line = Corners::Zero();
  line(0, 1) = 1;
  line(0, 2) = 2;
  for (const Corners& corners : {point, line}) {
    const Eigen::Vector3d value = Values(corners, TriangleStrain::UsualNumbers(), strain);
    EXPECT_TRUE(value.allFinite()) << value.transpose();
    // In all poses: there is no triangle at rest then.
    MetricOptions options;
    const auto two = Connectivity::Make(6, {0, 3, 6}, {0, 1, 2, 3, 4, 5});
    Shape pose(3, 6);
    pose << corners, WithStrain(Eigen::Matrix2d::Zero());
    const auto metric = FreezeMetric(options, two, {pose});
    EXPECT_EQ(testing::Get<TriangleStrain>(*metric).numbers.col(0), TriangleStrain::UsualNumbers());
    EXPECT_TRUE(FeatureMap(metric).Values(pose / metric->unit).allFinite());
  }
}

}  // namespace
}  // namespace shapespace
