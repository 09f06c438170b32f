#include <shapespace/sparse/detail/dense.h>

#include <Eigen/Cholesky>
#include <Eigen/Core>

// By Eigen's kernels, where there is no BLAS.

namespace shapespace::internal {
namespace {

using Matrix = Eigen::Map<Eigen::MatrixXd, 0, Eigen::OuterStride<>>;
using ConstMatrix = Eigen::Map<const Eigen::MatrixXd, 0, Eigen::OuterStride<>>;

}  // namespace

bool FactorDense(int n, double* a, int lda) {
  Matrix matrix(a, n, n, Eigen::OuterStride<>(lda));
  const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(matrix);
  return factor.info() == Eigen::Success && matrix.diagonal().allFinite();
}

void SolveDenseTransposed(int m, int n, const double* l, int ldl, double* b, int ldb) {
  const ConstMatrix factor(l, n, n, Eigen::OuterStride<>(ldl));
  Matrix rows(b, m, n, Eigen::OuterStride<>(ldb));
  factor.triangularView<Eigen::Lower>().transpose().solveInPlace<Eigen::OnTheRight>(rows);
}

void SubtractSquare(int n, int k, const double* a, int lda, double* c, int ldc) {
  const ConstMatrix factor(a, n, k, Eigen::OuterStride<>(lda));
  Matrix result(c, n, n, Eigen::OuterStride<>(ldc));
  result.selfadjointView<Eigen::Lower>().rankUpdate(factor, -1);
}

void SubtractProduct(int m, int n, int k, const double* a, int lda, const double* b, int ldb,
                     double* c, int ldc) {
  const ConstMatrix left(a, m, k, Eigen::OuterStride<>(lda));
  const ConstMatrix right(b, n, k, Eigen::OuterStride<>(ldb));
  Matrix(c, m, n, Eigen::OuterStride<>(ldc)).noalias() -= left * right.transpose();
}

}  // namespace shapespace::internal
