#include <shapespace/exploration/embedding.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>

#include "support/message_of.h"

namespace shapespace {
namespace {

using testing::MessageOf;

Eigen::MatrixXd RandomPoints(int dimensions, int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> uniform(-1, 1);
  return Eigen::MatrixXd::NullaryExpr(dimensions, count, [&] { return uniform(random); });
}

Eigen::MatrixXd DistancesOf(const Eigen::MatrixXd& points) {
  Eigen::MatrixXd distances(points.cols(), points.cols());
  for (int i = 0; i < points.cols(); ++i) {
    for (int j = 0; j < points.cols(); ++j) {
      distances(i, j) = (points.col(i) - points.col(j)).norm();
    }
  }
  return distances;
}

double StressOf(const Eigen::MatrixXd& points, const Eigen::MatrixXd& distances) {
  return (DistancesOf(points) - distances).norm() / distances.norm();
}

TEST(EmbeddingTest, PointsOfThePlaneAreFoundAgain) {
  const Eigen::MatrixXd distances = DistancesOf(RandomPoints(2, 12));
  const Embedding embedding = Embed(distances);
  EXPECT_TRUE(embedding.converged);
  EXPECT_LT((DistancesOf(embedding.points) - distances).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_LT(embedding.stress, 1e-9);
}

TEST(EmbeddingTest, PointsOfALineLieOnTheFirstAxis) {
  const Eigen::MatrixXd distances = DistancesOf(Eigen::RowVectorXd::LinSpaced(5, 0, 4));
  const Embedding embedding = Embed(distances);
  EXPECT_LT(embedding.points.row(1).cwiseAbs().maxCoeff(), 1e-7);
  EXPECT_NEAR(embedding.points.row(0).maxCoeff() - embedding.points.row(0).minCoeff(), 4, 1e-9);
}

TEST(EmbeddingTest, StressNeverRisesAndEndsAtAMinimum) {
  const Eigen::MatrixXd distances = DistancesOf(RandomPoints(9, 15));
  const Embedding embedding = Embed(distances);
  ASSERT_GT(embedding.stresses.size(), 3u);
  for (size_t i = 1; i < embedding.stresses.size(); ++i) {
    EXPECT_LE(embedding.stresses[i], embedding.stresses[i - 1]);
  }
  EXPECT_LT(embedding.stress, 0.99 * embedding.stresses.front());
  EXPECT_NEAR(embedding.stress, StressOf(embedding.points, distances), 1e-12);
  EXPECT_TRUE(embedding.converged);
  // No change of a coordinate reduces the stress.
  for (int k = 0; k < embedding.points.size(); ++k) {
    for (double step : {-1e-2, 1e-2}) {
      Eigen::MatrixXd moved = embedding.points;
      moved(k) += step;
      EXPECT_GT(StressOf(moved, distances), embedding.stress);
    }
  }
}

Eigen::MatrixXd EqualDistances(int count) {
  return Eigen::MatrixXd::Ones(count, count) - Eigen::MatrixXd::Identity(count, count);
}

// Four points at distance 1 from each other: on a plane, the square is best.
TEST(EmbeddingTest, ATetrahedronBecomesASquare) {
  const Eigen::MatrixXd distances = EqualDistances(4);
  // Sides a and diagonals sqrt(2) a: 4 (a - 1)^2 + 2 (sqrt(2) a - 1)^2 is least at
  // a = (4 + 2 sqrt(2)) / 8.
  const double a = (4 + 2 * std::sqrt(2.0)) / 8;
  const double least =
      std::sqrt((4 * (a - 1) * (a - 1) + 2 * std::pow(std::sqrt(2.0) * a - 1, 2)) / 6);
  EXPECT_NEAR(Embed(distances).stress, least, 1e-6);
}

// Stress majorisation from classical scaling alone ends in local minima.
TEST(EmbeddingTest, NoRandomStartEndsWithLessStress) {
  std::mt19937 random(11);
  std::normal_distribution<double> normal;
  // From points in order and in other orders; the least stress of majorisation from 30 starts.
  std::vector<Eigen::MatrixXd> all;
  for (const int count : {4, 5, 6, 7, 8, 10}) all.push_back(EqualDistances(count));
  all.push_back(DistancesOf(RandomPoints(8, 8)));
  // Corners of a cube in four dimensions.
  Eigen::MatrixXd corners(4, 16);
  for (int i = 0; i < 16; ++i) corners.col(i) << i % 2, i / 2 % 2, i / 4 % 2, i / 8;
  all.push_back(DistancesOf(corners));
  for (const Eigen::MatrixXd& distances : all) {
    const auto n = distances.rows();
    double least = 1;
    for (int start = 0; start < 30; ++start) {
      Eigen::MatrixXd points = Eigen::MatrixXd::NullaryExpr(2, n, [&] { return normal(random); });
      for (int i = 0; i < 200; ++i) {
        Eigen::MatrixXd next = Eigen::MatrixXd::Zero(2, n);
        for (int a = 0; a < n; ++a) {
          for (int b = 0; b < n; ++b) {
            const Eigen::Vector2d way = points.col(a) - points.col(b);
            if (a != b) next.col(a) += distances(a, b) / way.norm() * way;
          }
        }
        points = next / static_cast<double>(n);
      }
      least = std::min(least, StressOf(points, distances));
    }
    const Embedding embedding = Embed(distances);
    EXPECT_TRUE(embedding.converged);
    EXPECT_LT(embedding.stress, least * (1 + 1e-5)) << n;
    const Embedding reversed = Embed(distances.reverse());
    EXPECT_NEAR(reversed.stress, embedding.stress, 1e-5 * embedding.stress) << n;
  }
}

TEST(EmbeddingTest, ScalesWithTheDistancesAndFollowsTheirOrder) {
  const Eigen::MatrixXd points = RandomPoints(4, 6);
  const Embedding embedding = Embed(DistancesOf(points));
  const Embedding scaled = Embed(1e6 * DistancesOf(points));
  EXPECT_LT((scaled.points - 1e6 * embedding.points).cwiseAbs().maxCoeff(), 1);
  EXPECT_NEAR(scaled.stress, embedding.stress, 1e-9);
  EXPECT_NEAR(Embed(1e200 * DistancesOf(points)).points(0, 0) / 1e200, embedding.points(0, 0),
              1e-6);
  const Embedding reversed = Embed(DistancesOf(points.rowwise().reverse()));
  EXPECT_LT((reversed.points.rowwise().reverse() - embedding.points).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(EmbeddingTest, OneAndTwoPointsAndCopiesArePlaced) {
  EXPECT_EQ(Embed(Eigen::MatrixXd::Zero(1, 1)).points.cols(), 1);
  const Eigen::Matrix2d two = (Eigen::Matrix2d() << 0, 3, 3, 0).finished();
  EXPECT_NEAR((Embed(two).points.col(0) - Embed(two).points.col(1)).norm(), 3, 1e-12);
  const Embedding copies = Embed(Eigen::MatrixXd::Zero(3, 3));
  EXPECT_TRUE(copies.points.isZero(0));
  EXPECT_EQ(copies.stress, 0);
}

TEST(EmbeddingTest, IterationsThatRunOutAreToldOf) {
  EmbeddingOptions options;
  options.max_iterations = 1;
  EXPECT_FALSE(Embed(DistancesOf(RandomPoints(9, 15)), options).converged);
}

TEST(EmbeddingTest, WhatIsNoMatrixOfDistancesIsRefused) {
  const auto message = [](const Eigen::MatrixXd& distances) {
    return MessageOf<InvalidOptions>([&] { Embed(distances); });
  };
  Eigen::MatrixXd distances = DistancesOf(RandomPoints(2, 3));
  EXPECT_EQ(message(distances), "nothing was thrown");
  EXPECT_NE(message(distances.leftCols(2)).find("distances"), std::string::npos);
  EXPECT_NE(message(-distances).find("distances"), std::string::npos);
  EXPECT_NE(message(Eigen::MatrixXd(0, 0)).find("distances"), std::string::npos);
  distances(0, 1) += 1;
  EXPECT_NE(message(distances).find("symmetric"), std::string::npos);
  distances.setConstant(std::numeric_limits<double>::quiet_NaN());
  EXPECT_NE(message(distances).find("finite"), std::string::npos);
  EmbeddingOptions options;
  options.tolerance = 0;
  EXPECT_THROW(options.Validate(), InvalidOptions);
}

}  // namespace
}  // namespace shapespace
