#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include <shapespace/skinning/detail/joint_tree.h>
#include <shapespace/skinning/detail/simplex_minimum.h>

#include "solvers/skinning_bodies.h"

namespace shapespace::internal {
namespace {

// The Gram matrix of random residuals: `rows` of them, so that it is singular with more columns.
Eigen::MatrixXd RandomGram(int rows, int columns, unsigned seed) {
  std::mt19937 random(seed);
  Eigen::MatrixXd residuals(rows, columns);
  for (double& entry : residuals.reshaped()) entry = random() / 2147483648.0 - 0.7;
  return residuals.transpose() * residuals;
}

// The minimum over the simplex, by a solve on each of its faces.
double LeastByFaces(const Eigen::MatrixXd& gram, int most) {
  double least = HUGE_VAL;
  const int n = static_cast<int>(gram.rows());
  for (int face = 1; face < 1 << n; ++face) {
    std::vector<int> support;
    for (int i = 0; i < n; ++i) {
      if ((face >> i & 1) != 0) support.push_back(i);
    }
    if (static_cast<int>(support.size()) > most) continue;
    const Eigen::MatrixXd part = gram(support, support);
    const Eigen::VectorXd w = part.ldlt().solve(Eigen::VectorXd::Ones(support.size()));
    const Eigen::VectorXd weights = w / w.sum();
    if ((weights.array() >= 0).all()) least = std::min(least, weights.dot(part * weights));
  }
  return least;
}

void ExpectInSimplex(const SimplexPoint& point) {
  double sum = 0;
  for (int i = 0; i < point.count; ++i) {
    EXPECT_GE(point.weight[i], 0);
    sum += point.weight[i];
  }
  EXPECT_NEAR(sum, 1, 1e-12);
}

TEST(SimplexMinimum, IsTheLeastOverAllFaces) {
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const Eigen::MatrixXd gram = RandomGram(12, 7, seed);
    SimplexPoint point;
    point.Append(static_cast<int>(seed % 7), 1);
    Eigen::VectorXd gradient;
    MinimiseOnSimplex(gram, &point, &gradient);
    ExpectInSimplex(point);
    const double least = LeastByFaces(gram, 7);
    EXPECT_NEAR(ValueAt(gram, point), least, 1e-4 * least) << seed;
  }
}

TEST(SimplexMinimum, FewerCoordinatesCostLittleMoreThanTheLeast) {
  double ratio = 0;
  for (unsigned seed = 1; seed <= 40; ++seed) {
    const Eigen::MatrixXd gram = RandomGram(12, 7, seed);
    SimplexPoint point;
    point.Append(0, 1);
    Eigen::VectorXd gradient;
    MinimiseOnSimplex(gram, &point, &gradient);
    RemoveLeastUseful(gram, 2, &point);
    EXPECT_LE(point.count, 2);
    ExpectInSimplex(point);
    ratio += ValueAt(gram, point) / LeastByFaces(gram, 2) / 40;
  }
  EXPECT_GE(ratio, 1 - 1e-9);
  EXPECT_LT(ratio, 1.02);
}

TEST(SimplexMinimum, SharesBetweenEqualBones) {
  // Two equal columns and a worse one; more columns than residuals have dimensions.
  Eigen::MatrixXd gram = Eigen::MatrixXd::Constant(3, 3, 1);
  gram(2, 2) = 4;
  SimplexPoint point;
  point.Append(0, 0.25);
  point.Append(1, 0.5);
  point.Append(2, 0.25);
  MinimiseOnSupport(gram, &point);
  ExpectInSimplex(point);
  EXPECT_NEAR(ValueAt(gram, point), 1, 1e-12);
  const Eigen::MatrixXd singular = RandomGram(3, 30, 5);
  SimplexPoint start;
  start.Append(3, 1);
  Eigen::VectorXd gradient;
  MinimiseOnSimplex(singular, &start, &gradient);
  ExpectInSimplex(start);
  EXPECT_LT(ValueAt(singular, start), singular(3, 3));
}

// Of bones that together fit nearly exactly, what the value is lowered by is rounding errors.
TEST(SimplexMinimum, EndsWhereNothingIsLeftToGain) {
  for (unsigned seed = 1; seed <= 5000; ++seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> number(-1, 1);
    Eigen::MatrixXd residuals(8, 16);
    for (double& entry : residuals.reshaped()) entry = number(random);
    for (int row = 0; row < residuals.rows(); ++row) residuals.row(row) *= std::pow(0.08, row);
    const Eigen::MatrixXd gram = 9 * residuals.transpose() * residuals;
    SimplexPoint point;
    point.Append(static_cast<int>(seed % 16), 1);
    Eigen::VectorXd gradient;
    MinimiseOnSimplex(gram, &point, &gradient);
    ExpectInSimplex(point);
    EXPECT_LE(ValueAt(gram, point), gram(seed % 16, seed % 16));
  }
}

TEST(SimplexMinimum, RemovesOneCoordinateAndKeepsTheSum) {
  SimplexPoint point;
  point.Append(4, 0.5);
  point.Append(2, 0.5);
  point.Append(7, 0);
  point.Remove(0);
  EXPECT_EQ(point.index[0], 2);
  EXPECT_EQ(point.weight[0], 1);
  point.Remove(0);
  EXPECT_EQ(point.index[0], 7);
  EXPECT_EQ(point.weight[0], 1);
}

}  // namespace
}  // namespace shapespace::internal
