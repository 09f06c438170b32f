#include <shapespace/matching/detail/spectrum.h>

#include <algorithm>
#include <random>

#include <Eigen/Eigenvalues>

#include <shapespace/base/internal/random.h>
#include <shapespace/sparse/internal/cholesky.h>
#include <shapespace/sparse/internal/solve.h>

namespace shapespace::internal {
namespace {

// Makes the matrix definite; small against the eigenvalues of a surface of area 1, which grow by
// about 4 pi from one to the next (H. Weyl).
constexpr double kShift = 0.5;
// Columns that are multiplied together: as many as the factor's kernels need at least. With more,
// more vectors would be needed.
constexpr int kBlock = Cholesky::kColumns;
// Vectors of the Krylov space for each eigenfunction, and besides. The residuals of the last of 100
// functions of bodies with 5000 vertices are then below 1e-8.
constexpr int kVectorsEach = 3, kVectorsMore = 20;

// The inverse of stiffness + shift areas in coordinates in which areas are 1. Its largest
// eigenvalues belong to the first eigenfunctions.
class ShiftedInverse {
 public:
  explicit ShiftedInverse(const Laplacian& laplacian)
      : roots_(laplacian.areas.cwiseSqrt()), factor_(Shifted(laplacian)) {}

  int Size() const { return static_cast<int>(roots_.size()); }
  const Eigen::VectorXd& Roots() const { return roots_; }
  Eigen::MatrixXd operator()(const Eigen::MatrixXd& x) const {
    return roots_.asDiagonal() * Solve(factor_, roots_.asDiagonal() * x);
  }

 private:
  static Eigen::SparseMatrix<double> Shifted(const Laplacian& laplacian) {
    Eigen::SparseMatrix<double> matrix = laplacian.stiffness;
    matrix.diagonal() += kShift * laplacian.areas;
    return matrix;
  }

  const Eigen::VectorXd roots_;
  const Cholesky factor_;
};

// Makes the columns orthonormal, in place. \return R with columns before = columns after * R. A
// column that depends on those before it becomes 0.
Eigen::MatrixXd Orthonormalise(Eigen::MatrixXd* columns) {
  constexpr double kDependent = 1e-12;
  const Eigen::Index count = columns->cols();
  Eigen::MatrixXd r = Eigen::MatrixXd::Zero(count, count);
  for (Eigen::Index j = 0; j < count; ++j) {
    auto column = columns->col(j);
    const double before = column.norm();
    for (int pass = 0; pass < 2; ++pass) {
      const Eigen::VectorXd shares = columns->leftCols(j).transpose() * column;
      column -= columns->leftCols(j) * shares;
      r.col(j).head(j) += shares;
    }
    r(j, j) = column.norm();
    if (r(j, j) > kDependent * before) {
      column /= r(j, j);
    } else {
      r(j, j) = 0;
      column.setZero();
    }
  }
  return r;
}

// An orthonormal basis of a subspace, and what the operator is in it.
struct Projection {
  Eigen::MatrixXd basis, matrix;
};

Projection Lanczos(const ShiftedInverse& inverse, int size) {
  Projection result;
  result.basis.resize(inverse.Size(), size);
  result.matrix = Eigen::MatrixXd::Zero(size, size);
  std::mt19937_64 random(1);
  Eigen::MatrixXd block =
      Eigen::MatrixXd::NullaryExpr(inverse.Size(), kBlock, [&] { return Uniform(&random) - 0.5; });
  Orthonormalise(&block);
  for (int done = 0; done < size; done += kBlock) {
    result.basis.middleCols(done, kBlock) = block;
    Eigen::MatrixXd next = inverse(block);
    // In exact arithmetic, the last two blocks alone are not orthogonal to it; what remains
    // after these are subtracted is rounding, for which the second pass suffices.
    const int near = std::max(0, done - kBlock), both = done + kBlock - near;
    const auto recent = result.basis.middleCols(near, both);
    const Eigen::MatrixXd shares = recent.transpose() * next;
    next -= recent * shares;
    result.matrix.block(near, done, both, kBlock) = shares;
    const auto all = result.basis.leftCols(done + kBlock);
    next -= all * (all.transpose() * next);
    const Eigen::MatrixXd r = Orthonormalise(&next);
    if (done + kBlock < size) result.matrix.block(done + kBlock, done, kBlock, kBlock) = r;
    block = next;
  }
  return result;
}

Projection Whole(const ShiftedInverse& inverse) {
  Projection result;
  result.basis = Eigen::MatrixXd::Identity(inverse.Size(), inverse.Size());
  result.matrix = inverse(result.basis);
  return result;
}

}  // namespace

Spectrum ComputeSpectrum(const Laplacian& laplacian, int count) {
  const ShiftedInverse inverse(laplacian);
  count = std::min(count, inverse.Size());
  const int wanted = kVectorsEach * count + kVectorsMore;
  const int size = (wanted + kBlock - 1) / kBlock * kBlock;
  const Projection projection = 2 * size < inverse.Size() ? Lanczos(inverse, size) : Whole(inverse);
  // Only the lower triangle is read.
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(projection.matrix);
  Spectrum spectrum;
  spectrum.values = solver.eigenvalues().tail(count).reverse().cwiseInverse().array() - kShift;
  spectrum.functions =
      inverse.Roots().cwiseInverse().asDiagonal() *
      (projection.basis * solver.eigenvectors().rightCols(count).rowwise().reverse());
  return spectrum;
}

}  // namespace shapespace::internal
