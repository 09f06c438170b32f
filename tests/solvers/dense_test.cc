#include <shapespace/sparse/detail/dense.h>

#include <cmath>

#include <gtest/gtest.h>
#include <Eigen/Core>

namespace shapespace::internal {
namespace {

// A part of a larger matrix, as fronts are: columns are farther apart than they are long.
struct Part {
  Part(int rows, int columns, int seed) : rows(rows), all(rows + 3, columns) {
    for (int k = 0; k < all.size(); ++k) all(k) = std::sin(1.7 * k + seed);
  }
  Eigen::MatrixXd Matrix() const { return all.topRows(rows); }
  double* Data() { return all.data(); }
  int Stride() const { return static_cast<int>(all.rows()); }

  int rows;
  Eigen::MatrixXd all;
};

void ExpectBelow(const Part& part, const Eigen::MatrixXd& before) {
  const Eigen::Index below = part.all.rows() - part.rows;
  EXPECT_EQ(part.all.bottomRows(below), before.bottomRows(below));
}

Eigen::MatrixXd Lower(const Eigen::MatrixXd& matrix) {
  return matrix.triangularView<Eigen::Lower>();
}

TEST(Dense, ProductsAreSubtracted) {
  Part a(4, 3, 1), b(5, 3, 2), c(4, 5, 3);
  const Eigen::MatrixXd before = c.all, expected = c.Matrix() - a.Matrix() * b.Matrix().transpose();
  SubtractProduct(4, 5, 3, a.Data(), a.Stride(), b.Data(), b.Stride(), c.Data(), c.Stride());
  EXPECT_LT((c.Matrix() - expected).norm(), 1e-14);
  ExpectBelow(c, before);

  Part square(4, 4, 4);
  const Eigen::MatrixXd kept = square.all;
  const Eigen::MatrixXd rest = square.Matrix() - a.Matrix() * a.Matrix().transpose();
  SubtractSquare(4, 3, a.Data(), a.Stride(), square.Data(), square.Stride());
  EXPECT_LT((Lower(square.Matrix()) - Lower(rest)).norm(), 1e-14);
  EXPECT_EQ(Lower(square.Matrix().transpose()).diagonal(-1),
            Lower(kept.topRows(4).transpose()).diagonal(-1));
  ExpectBelow(square, kept);
}

TEST(Dense, FactorsAreThoseOfCholeskyAndAreSolvedWith) {
  Part a(4, 4, 5);
  const Eigen::MatrixXd root = a.Matrix();
  const Eigen::MatrixXd square = root * root.transpose() + Eigen::MatrixXd::Identity(4, 4);
  a.all.topRows(4) = square;
  const Eigen::MatrixXd before = a.all;
  ASSERT_TRUE(FactorDense(4, a.Data(), a.Stride()));
  const Eigen::MatrixXd factor = Lower(a.Matrix());
  EXPECT_LT((factor * factor.transpose() - square).norm(), 1e-13);
  ExpectBelow(a, before);

  Part b(3, 4, 6);
  const Eigen::MatrixXd right = b.Matrix();
  SolveDenseTransposed(3, 4, a.Data(), a.Stride(), b.Data(), b.Stride());
  EXPECT_LT((b.Matrix() * factor.transpose() - right).norm(), 1e-13);

  a.all.topRows(4) = square - 10 * Eigen::MatrixXd::Identity(4, 4);
  EXPECT_FALSE(FactorDense(4, a.Data(), a.Stride()));
}

}  // namespace
}  // namespace shapespace::internal
