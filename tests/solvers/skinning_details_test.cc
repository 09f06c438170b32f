#include <cmath>
#include <random>
#include <vector>

#include <gtest/gtest.h>
#include <Eigen/Cholesky>

#include <shapespace/skinning/detail/joint_tree.h>
#include <shapespace/skinning/detail/near_bones.h>
#include <shapespace/skinning/detail/simplex_minimum.h>
#include <shapespace/skinning/detail/vertex_weights.h>

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

// A row of ten points, and an eleventh by itself.
MovingPoints Row() {
  MovingPoints points;
  points.moved.resize(6, 11);
  std::vector<int> begin = {0}, items;
  for (int p = 0; p < 11; ++p) {
    points.moved.col(p) << p, 0, 0, p, std::sin(0.7 * p), std::cos(p);
    points.vertices.push_back(p);
    points.component_of.push_back(p / 10);
    if (p > 0 && p < 10) items.push_back(p - 1);
    if (p < 9) items.push_back(p + 1);
    begin.push_back(static_cast<int>(items.size()));
  }
  points.neighbours = {std::move(begin), std::move(items)};
  points.num_components = 2;
  return points;
}

TEST(NearBones, AreAtMostTwoRegionsAway) {
  const MovingPoints points = Row();
  // Bone b has points 2 b and 2 b + 1, bone 5 the last; bone 6 has none.
  VertexWeights weights = OneBoneEach({0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 5}, 2);
  weights.bones(1, 1) = 4;
  weights.weights.col(1) << 0.9, 0.1;
  const NearBones near(points, weights, 7);
  std::vector<int> bones;
  near.Find(0, &bones);
  EXPECT_EQ(bones, (std::vector<int>{0, 1, 2, 5, 6}));
  near.Find(1, &bones);  // moved by bone 4 already
  EXPECT_EQ(bones, (std::vector<int>{0, 1, 2, 4, 5, 6}));
  near.Find(5, &bones);
  EXPECT_EQ(bones, (std::vector<int>{0, 1, 2, 3, 4, 5, 6}));
  near.Find(9, &bones);
  EXPECT_EQ(bones, (std::vector<int>{2, 3, 4, 5, 6}));
}

TEST(FitWeights, LowersErrorsAndDifferencesTogether) {
  const MovingPoints points = Row();
  Bones bones;
  bones.shapes = 2;
  for (int b = 0; b < 4; ++b) {
    bones.Append();
    FitBone(points, {2 * b, 2 * b + 1, 2 * b + 2}, b, &bones);
  }
  for (const double smoothness : {0.0, 0.3, 1e3}) {
    VertexWeights weights = OneBoneEach({0, 1, 0, 1, 0, 1, 0, 1, 0, 1, 2}, 3);
    const auto objective = [&] {
      Eigen::MatrixXd dense = Eigen::MatrixXd::Zero(4, 11);
      for (int p = 0; p < 11; ++p) {
        for (int k = 0; k < 3; ++k) dense(weights.bones(k, p), p) += weights.weights(k, p);
      }
      return SquaredErrors(points, bones, weights).sum() +
             smoothness * (dense.middleCols(1, 9) - dense.leftCols(9)).squaredNorm();
    };
    double last = objective();
    const double first = last;
    for (int i = 0; i < 30; ++i) {
      FitWeights(points, bones, smoothness, &weights);
      const double now = objective();
      EXPECT_LE(now, last * (1 + 1e-12)) << smoothness << ", " << i;
      last = now;
    }
    EXPECT_LT(last, 0.9 * first);
  }
}

}  // namespace
}  // namespace shapespace::internal
