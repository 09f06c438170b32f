#include <shapespace/minimise/internal/preconditioner.h>

#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>
#include <limits>
#include <numeric>
#include <random>
#include <string>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/bodies/sheet.h>
#include <shapespace/sparse/detail/dense.h>

#include "support/message_of.h"
#include "support/paths.h"

namespace shapespace::internal {
namespace {

using testing::MessageOf;
using testing::Names;

Eigen::SparseMatrix<double> Matrix(const ShapeFamily& body) {
  const std::vector<Shape> poses = {body.pose(0), body.pose(40)};
  const auto metric = FreezeMetric({}, body.connectivity, poses);
  return ScalarMetric(*metric, {poses[0] / metric->unit, poses[1] / metric->unit}, 0);
}

// The matrix of a random graph with edges from each vertex to `degree` others. Such a graph has no
// small separators, so that in any order of elimination most of the factor is dense.
Eigen::SparseMatrix<double> SparseWithDenseFactor(int size, int degree) {
  std::mt19937 random(1);
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < size; ++i) {
    entries.emplace_back(i, i, 2 * size);
    for (int k = 0; k < degree / 2; ++k) {
      const int j = static_cast<int>(random() % size);
      if (j != i) entries.emplace_back(std::max(i, j), std::min(i, j), 1);
    }
  }
  Eigen::SparseMatrix<double> matrix(size, size);
  matrix.setFromTriplets(entries.begin(), entries.end());
  return matrix;
}

TEST(FactorDense, RefusesWhatIsNotFiniteOrNotDefinite) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  for (const int size : {1, 2, 5, 70}) {
    const Eigen::MatrixXd definite =
        Eigen::MatrixXd::Constant(size, size, 0.5) + size * Eigen::MatrixXd::Identity(size, size);
    Eigen::MatrixXd matrix = definite;
    EXPECT_TRUE(FactorDense(size, matrix.data(), size));
    for (const double wrong : {kNan, kInfinity, -kInfinity, -10.0 * size}) {
      for (int column = 0; column < size; column += 1 + size / 4) {
        for (int row = column; row < size; row += 1 + size / 3) {
          matrix = definite;
          matrix(row, column) = wrong;
          EXPECT_FALSE(FactorDense(size, matrix.data(), size))
              << wrong << " at " << row << ", " << column << " of " << size;
        }
      }
    }
  }
}

TEST(Cholesky, RefusesWhatIsNotANumber) {
  Eigen::SparseMatrix<double> matrix = Matrix(MakeBar(6, 1, 1, 6, 1, 1));
  for (const Eigen::Index at : {Eigen::Index{0}, matrix.nonZeros() / 2, matrix.nonZeros() - 1}) {
    const double before = matrix.valuePtr()[at];
    matrix.valuePtr()[at] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(Cholesky{matrix}, SolverError) << at;
    matrix.valuePtr()[at] = before;
  }
  EXPECT_NO_THROW(Cholesky{matrix});
}

// A large matrix and few columns, for which branches are solved in parallel.
TEST(Cholesky, SolvesAsItsMatrixSays) {
  for (int cells : {4, 16}) {
    const Eigen::SparseMatrix<double> matrix = Matrix(MakeBar(6, 1, 1, 6 * cells, cells, cells));
    const Cholesky factor(matrix);
    const int size = factor.Size();
    if (cells == 16) {
      EXPECT_GT(factor.WorkRows(), size);
    }
    for (int width : {4, 8, 12, 24, 48, 96, 100}) {
      using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
      const RowMajor right = RowMajor::Random(size, width);
      RowMajor x(factor.WorkRows(), width), solution(size, width);
      for (int i = 0; i < size; ++i) x.row(i) = right.row(factor.Permutation()[i]);
      factor.SolveLower(x.data(), width);
      factor.SolveUpper(x.data(), width);
      for (int i = 0; i < size; ++i) solution.row(factor.Permutation()[i]) = x.row(i);
      const RowMajor back = matrix.selfadjointView<Eigen::Lower>() * solution;
      EXPECT_LT((back - right).cwiseAbs().maxCoeff(), 1e-7);
    }
  }
}

TEST(Cholesky, SolvesInSinglePrecisionToItsRounding) {
  const Cholesky factor(Matrix(MakeBar(6, 1, 1, 24, 4, 4)));
  const CholeskyFactor<float> single(factor);
  const int size = factor.WorkRows();
  for (int width : {8, 16, 24, 40, 48, 96, 104}) {
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    using RowMajorSingle = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    RowMajor x = RowMajor::Random(size, width);
    RowMajorSingle y = x.cast<float>();
    factor.SolveLower(x.data(), width);
    single.SolveLower(y.data(), width);
    EXPECT_LT((x - y.cast<double>()).cwiseAbs().maxCoeff(), 1e-4 * x.cwiseAbs().maxCoeff());
    factor.SolveUpper(x.data(), width);
    single.SolveUpper(y.data(), width);
    EXPECT_LT((x - y.cast<double>()).cwiseAbs().maxCoeff(), 1e-3 * x.cwiseAbs().maxCoeff());
  }
}

// In branches of the elimination tree and without them, and with supernodes of all widths.
TEST(Cholesky, SolvesOneVectorAsItSolvesSeveral) {
  for (int cells : {1, 4, 16}) {
    const Cholesky factor(Matrix(MakeBar(6, 1, 1, 6 * cells, cells, cells)));
    const CholeskyFactor<float> single(factor);
    const int rows = factor.WorkRows(), width = Cholesky::kColumns;
    using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
    RowMajor several = RowMajor::Random(rows, width);
    Eigen::VectorXd one = several.col(1);
    Eigen::VectorXf rounded = one.cast<float>();
    const auto check = [&] {
      const Eigen::VectorXd expected = several.col(1).head(factor.Size());
      const double scale = expected.cwiseAbs().maxCoeff();
      EXPECT_LT((one.head(factor.Size()) - expected).cwiseAbs().maxCoeff(), 1e-10 * scale);
      EXPECT_LT((rounded.head(factor.Size()).cast<double>() - expected).cwiseAbs().maxCoeff(),
                1e-3 * scale);
    };
    factor.SolveLower(several.data(), width);
    factor.SolveLower(one.data());
    single.SolveLower(rounded.data());
    check();
    factor.SolveUpper(several.data(), width);
    factor.SolveUpper(one.data());
    single.SolveUpper(rounded.data());
    check();
  }
}

// G^{-1} b by a factor, for one vector.
template <typename Scalar>
Eigen::VectorXd SolveWith(const CholeskyFactor<Scalar>& factor, const Eigen::VectorXd& b) {
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> x(factor.WorkRows());
  for (int i = 0; i < b.size(); ++i) x(i) = static_cast<Scalar>(b(factor.Permutation()[i]));
  factor.SolveLower(x.data());
  factor.SolveUpper(x.data());
  Eigen::VectorXd result(b.size());
  for (int i = 0; i < b.size(); ++i) {
    result(factor.Permutation()[i]) = static_cast<double>(x(i));
  }
  return result;
}

// Fronts of several tiles, of which the last ones are narrower, in the trunk.
TEST(Cholesky, FactorsLargeFronts) {
  const Eigen::SparseMatrix<double> matrix = SparseWithDenseFactor(1500, 24);
  const Cholesky factor(matrix);
  EXPECT_GT(factor.NumNonzeros(), 500 * 500);
  const Eigen::VectorXd x = Eigen::VectorXd::Random(1500);
  const Eigen::VectorXd found = SolveWith(factor, matrix.selfadjointView<Eigen::Lower>() * x);
  EXPECT_LT((found - x).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Cholesky, UpdatesToAnotherMatrixOfItsPattern) {
  Eigen::SparseMatrix<double> matrix = Matrix(MakeBar(6, 1, 1, 24, 4, 4));
  Cholesky factor(matrix);
  CholeskyFactor<float> single(matrix);
  matrix.coeffs() *= 3;
  matrix.diagonal() *= 2;
  factor.Update(matrix);
  single.Update(matrix);
  const Eigen::VectorXd x = Eigen::VectorXd::Random(matrix.rows());
  const Eigen::VectorXd b = matrix.selfadjointView<Eigen::Lower>() * x;
  EXPECT_LT((SolveWith(factor, b) - x).cwiseAbs().maxCoeff(), 1e-10);
  EXPECT_LT((SolveWith(single, b) - x).cwiseAbs().maxCoeff(), 1e-3);
}

// A factor in the order of groups of unknowns solves the same systems, and is not much larger.
TEST(Cholesky, EliminatesGroupsOfUnknownsTogether) {
  const Eigen::SparseMatrix<double> scalar = Matrix(MakeBar(6, 1, 1, 24, 4, 4));
  std::vector<Eigen::Triplet<double>> entries;
  for (int column = 0; column < scalar.cols(); ++column) {
    for (Eigen::SparseMatrix<double>::InnerIterator it(scalar, column); it; ++it) {
      for (int a = 0; a < 3; ++a) {
        for (int b = 0; b < 3; ++b) {
          const int row = 3 * static_cast<int>(it.row()) + a;
          if (row < 3 * column + b) continue;
          entries.emplace_back(row, 3 * column + b, a == b ? it.value() : 0.1 * it.value());
        }
      }
    }
  }
  Eigen::SparseMatrix<double> matrix(3 * scalar.rows(), 3 * scalar.cols());
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Cholesky grouped(matrix, 3), single(matrix);
  EXPECT_LT(grouped.NumNonzeros(), 1.2 * single.NumNonzeros());
  for (size_t i = 0; i < grouped.Permutation().size(); i += 3) {
    EXPECT_EQ(grouped.Permutation()[i] / 3, grouped.Permutation()[i + 2] / 3);
  }
  const Eigen::VectorXd x = Eigen::VectorXd::Random(matrix.rows());
  const Eigen::VectorXd b = matrix.selfadjointView<Eigen::Lower>() * x;
  EXPECT_LT((SolveWith(grouped, b) - x).cwiseAbs().maxCoeff(), 1e-9);
}

TEST(Cholesky, RefusesAnIndefiniteMatrix) {
  Eigen::SparseMatrix<double> matrix(3, 3);
  matrix.insert(0, 0) = 1;
  matrix.insert(1, 1) = -1;
  matrix.insert(2, 2) = 1;
  matrix.makeCompressed();
  const std::string message = MessageOf<SolverError>([&] { Cholesky factor(matrix); });
  EXPECT_TRUE(Names(message, {"positive definite"}));
}

// An allocation that fails, whatever the machine has. Sanitizers reserve more address space than
// this.
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
TEST(Cholesky, SaysThatMemoryRanOut) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  const auto factor_without_memory = [] {
    const Eigen::SparseMatrix<double> matrix = SparseWithDenseFactor(56000, 48);
    rlimit limit = {};
    limit.rlim_cur = limit.rlim_max = rlim_t{8} << 30;
    setrlimit(RLIMIT_AS, &limit);
    std::cerr << MessageOf<SolverError>([&] { Cholesky factor(matrix); });
    std::exit(0);
  };
  // Its factor has more than 2^31 numbers of 8 bytes each.
  EXPECT_EXIT(factor_without_memory(), ::testing::ExitedWithCode(0),
              "memory ran out .* 56000 unknowns, which needs (1[7-9]|2[0-9])... MB");
}
#endif

TEST(ScalarMetric, CostsNothingForTranslationsButForThePositionTerm) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 12, 2, 2);
  const auto metric = FreezeMetric({}, bar.connectivity, {bar.pose(0)});
  const Eigen::SparseMatrix<double> matrix = ScalarMetric(*metric, {bar.pose(0) / metric->unit}, 0);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(matrix.rows());
  const double cost = ones.dot(matrix.selfadjointView<Eigen::Lower>() * ones);
  EXPECT_NEAR(cost, 4 * 1e-4 * 1.01, 1e-10);  // 4 lambda, regularised
}

// On more elements than are computed at a time.
TEST(ScalarMetric, IsTheSumOverAllElements) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 180, 20, 20);
  ASSERT_GT(bar.connectivity->NumHinges(), 40000);
  MetricOptions options;
  options.isometric = 1;
  options.rigid = 0.1;
  const auto metric = FreezeMetric(options, bar.connectivity, {bar.pose(0), bar.pose(40)});
  const std::vector<Shape> poses = {bar.pose(0) / metric->unit, bar.pose(40) / metric->unit};
  const Eigen::SparseMatrix<double> matrix = ScalarMetric(*metric, poses, 0);
  const int num_vertices = bar.connectivity->NumVertices();
  ASSERT_EQ(matrix.rows(), num_vertices);
  std::srand(1);
  const Eigen::VectorXd y = Eigen::VectorXd::Random(num_vertices);
  double expected = 0;
  for (int v = 0; v < num_vertices; ++v) {
    expected += 4 * (1e-6 * metric->vertex_area(v) + metric->rigid.weights(v)) * y(v) * y(v);
  }
  for (const auto& feature : metric->features) {
    const int corners = feature->VerticesPerElement();
    for (int e = 0; e < feature->NumElements(); ++e) {
      double shares = 0, traces = 1;  // products of the poses' traces
      for (const Shape& pose : poses) {
        double own = 0, trace = 0;
        double x[Feature::kMaxInputs];
        double rows[Feature::kMaxVertices * 3 * Feature::kMaxValues];
        feature->GatherCoordinates(e, e + 1, pose, x);
        feature->ScalarRows(1, x, rows);
        for (int row = 0; row < feature->NumScalarRows(); ++row) {
          double product = 0;
          for (int k = 0; k < corners; ++k) {
            product += rows[corners * row + k] * y(feature->Element(e)[k]);
            trace += rows[corners * row + k] * rows[corners * row + k];
          }
          own += product * product;
        }
        shares += own / trace / 2;
        traces *= trace;
      }
      expected += 4 * feature->Weight(e) * std::sqrt(traces) * shares;
    }
  }
  EXPECT_NEAR(y.dot(matrix.selfadjointView<Eigen::Lower>() * y), expected, 1e-10 * expected);
  for (int c = 0; c < matrix.outerSize(); ++c) {
    int before = c - 1;  // rows of the lower triangle rise, and each occurs once
    for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, c); entry; ++entry) {
      ASSERT_GT(entry.row(), before);
      before = static_cast<int>(entry.row());
    }
  }
}

TEST(ChangeOfVariables, TransposeIsTheTranspose) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 12, 2, 2);
  const auto metric = FreezeMetric({}, bar.connectivity, {bar.pose(0), bar.pose(40)});
  const Cholesky factor(ScalarMetric(*metric, {bar.pose(0) / metric->unit}, 0));
  for (int inner : {1, 4, 15}) {
    PathEnergy energy(metric, inner);
    ChangeOfVariables variables(factor, energy);
    const Eigen::VectorXd y = Eigen::VectorXd::Random(variables.Size());
    const std::vector<double> origin(energy.Size(), 0.0);
    std::vector<double> x(energy.Size()), g(energy.Size());
    variables.Apply(y.data(), origin.data(), 0.7, x.data());
    // A gradient with zero padding.
    std::vector<Shape> random(inner + 2, Shape::Zero(3, factor.Size()));
    for (int i = 1; i <= inner; ++i) random[i] = testing::Noise(factor.Size(), 1, i);
    energy.Load(random, g.data());
    Eigen::VectorXd back(variables.Size());
    variables.ApplyTranspose(g.data(), 0.7, back.data());
    const double forward = std::inner_product(x.begin(), x.end(), g.begin(), 0.0);
    EXPECT_NEAR(forward, y.dot(back), 1e-10 * y.norm() * back.norm());
  }
}

TEST(Preconditioner, IsBothHalvesOfTheChangeOfVariables) {
  const ShapeFamily bar = MakeBar(6, 1, 1, 12, 2, 2);
  const auto metric = FreezeMetric({}, bar.connectivity, {bar.pose(0), bar.pose(40)});
  const Cholesky factor(ScalarMetric(*metric, {bar.pose(0) / metric->unit}, 0));
  const CholeskyFactor<float> single(factor);
  for (int inner : {1, 4, 15}) {
    PathEnergy energy(metric, inner);
    ChangeOfVariables variables(factor, energy);
    Preconditioner preconditioner(single, energy);
    std::vector<Shape> random(inner + 2, Shape::Zero(3, factor.Size()));
    for (int i = 1; i <= inner; ++i) random[i] = testing::Noise(factor.Size(), 1, i);
    std::vector<double> g(energy.Size()), x(energy.Size()), y(variables.Size());
    const std::vector<double> origin(energy.Size(), 0.0);
    energy.Load(random, g.data());
    variables.ApplyTranspose(g.data(), 1, y.data());
    variables.Apply(y.data(), origin.data(), 1, x.data());
    double largest = 0;
    for (double value : x) largest = std::max(largest, std::abs(value));
    // Also for gradients far outside of the range of a float; in place; the padding remains zero.
    for (double scale : {1.0, 1e-60}) {
      std::vector<double> z = g;
      for (double& value : z) value *= scale;
      if (inner != energy.Stride()) z[inner] = 7;
      preconditioner.Apply(z.data(), scale, z.data());
      if (inner != energy.Stride()) {
        EXPECT_EQ(z[inner], 0);
      }
      for (size_t i = 0; i < z.size(); ++i) EXPECT_NEAR(z[i] / scale, x[i], 1e-3 * largest);
    }
  }
}

// In a flat metric the preconditioner is the inverse Hessian: one step from anywhere reaches the
// minimum.
TEST(ChangeOfVariables, MakesTheHessianOfAFlatMetricTheIdentity) {
  const ShapeFamily sheet = MakeSheet(1, 1, 6, 6);
  MetricOptions options;
  options.strain = options.bending = 0;
  options.lambda = 1;
  const auto metric = FreezeMetric(options, sheet.connectivity, {sheet.pose(0)});
  const Cholesky factor(ScalarMetric(*metric, {sheet.pose(0) / metric->unit}, 0));
  PathEnergy energy(metric, 5);
  ChangeOfVariables variables(factor, energy);
  const std::vector<Shape> shapes =
      testing::NoisyBlend(sheet.pose(0) / metric->unit, sheet.pose(0) / metric->unit, 5, 0.1);
  std::vector<double> x(energy.Size()), gradient(energy.Size()), y(variables.Size());
  energy.Load(shapes, x.data());
  const double before = energy.Evaluate(x.data(), gradient.data());
  variables.ApplyTranspose(gradient.data(), 1, y.data());
  std::vector<double> stepped(energy.Size());
  variables.Apply(y.data(), x.data(), -1, stepped.data());
  EXPECT_LT(energy.Evaluate(stepped.data(), nullptr), 1e-9 * before);
}

}  // namespace
}  // namespace shapespace::internal
