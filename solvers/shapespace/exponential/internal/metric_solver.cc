#include <shapespace/exponential/internal/metric_solver.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include <shapespace/base/internal/stopwatch.h>

namespace shapespace::internal {
namespace {

// The least tolerance of one run of GMRES with half solves in single precision.
constexpr double kRough = 1e-4;
// Residuals below this may be due to the rounding of the right-hand side.
constexpr double kRounding = 1e-10;

}  // namespace

void MetricSolver::Factor(const FeatureDerivative& at) {
  const Stopwatch stopwatch;
  factored_.resize(3, 0);
  if (!single_ && !double_) {
    matrix_ = at.MetricMatrix();
    single_.emplace(matrix_, 3);
  } else {
    at.UpdateMetricMatrix(&matrix_);
    double_ ? double_->Update(matrix_) : single_->Update(matrix_);
  }
  sum_rows_ = at.SumRows();
  FactorSums();
  ++factorisations_;
  factor_seconds_ += stopwatch.Seconds();
}

void MetricSolver::FactorAt(const Shape& shape, const FeatureDerivative& at) {
  if (factored_.cols() == shape.cols() && factored_ == shape) return;
  Factor(at);
  factored_ = shape;
}

bool MetricSolver::UseDoublePrecision() {
  if (double_) return false;
  const Stopwatch stopwatch;
  double_.emplace(*single_, matrix_);
  single_.reset();
  FactorSums();
  ++factorisations_;
  factor_seconds_ += stopwatch.Seconds();
  return true;
}

void MetricSolver::FactorSums() {
  if (sum_rows_.empty()) return;
  Eigen::MatrixXd columns(matrix_.rows(), sum_rows_.size());
  for (size_t k = 0; k < sum_rows_.size(); ++k) columns.col(k) = SparseDual(sum_rows_[k]);
  const Eigen::JacobiSVD<Eigen::MatrixXd, Eigen::HouseholderQRPreconditioner> svd(
      columns, Eigen::ComputeThinU);
  sum_basis_ = svd.matrixU();
  sum_shares_ = 1 - (1 + svd.singularValues().array().square()).rsqrt();
}

void MetricSolver::ApplySums(Eigen::VectorXd* y) const {
  if (sum_rows_.empty()) return;
  *y -= sum_basis_ * sum_shares_.cwiseProduct(sum_basis_.transpose() * *y);
}

void MetricSolver::HalfSolve(bool transposed, Eigen::VectorXd* x) const {
  const auto solve = [&](const auto& factor, auto* y) {
    transposed ? factor.SolveUpper(y->data()) : factor.SolveLower(y->data());
  };
  const Eigen::Index size = x->size();
  if (double_) {
    x->conservativeResize(double_->WorkRows());
    solve(*double_, x);
    x->conservativeResize(size);
    return;
  }
  const double scale = x->cwiseAbs().maxCoeff();  // the range of single precision is small, too
  if (!(scale > 0)) return;
  Eigen::VectorXf single(single_->WorkRows());
  single.head(size) = (*x / scale).cast<float>();
  solve(*single_, &single);
  *x = scale * single.head(size).cast<double>();
}

Eigen::VectorXd MetricSolver::Dual(const Tangent& b) const {
  Eigen::VectorXd y = SparseDual(b);
  ApplySums(&y);
  return y;
}

Eigen::VectorXd MetricSolver::SparseDual(const Tangent& b) const {
  const std::vector<int>& permutation = Permutation();
  Eigen::VectorXd y(b.size());
  for (int i = 0; i < y.size(); ++i) y(i) = b.data()[permutation[i]];
  HalfSolve(false, &y);
  return y;
}

Tangent MetricSolver::FromDual(const Eigen::VectorXd& y) const {
  const std::vector<int>& permutation = Permutation();
  Eigen::VectorXd solved = y;
  ApplySums(&solved);
  HalfSolve(true, &solved);
  Tangent x(3, y.size() / 3);
  for (int i = 0; i < y.size(); ++i) x.data()[permutation[i]] = solved(i);
  return x;
}

MetricSolver::Result MetricSolver::Solve(const FeatureDerivative& left,
                                         const FeatureDerivative& right, const Tangent& b,
                                         double tolerance, int max_iterations, Tangent* x) const {
  Result result;
  *x = Tangent::Zero(3, b.cols());
  Eigen::VectorXd dual = Dual(b);
  const double length = dual.norm();
  if (length == 0) return result;
  // Iterative refinement: the residual of each rough solution is computed in double precision.
  result.residual = 1;
  while (result.residual > tolerance && result.iterations < max_iterations) {
    Tangent correction;
    const Result rough = SolveDual(left, right, dual, std::max(tolerance / result.residual, kRough),
                                   max_iterations - result.iterations, &correction);
    result.iterations += rough.iterations;
    *x += correction;
    if (result.residual == 1 && tolerance >= kRough) {
      result.residual = rough.residual;
      break;
    }
    dual = Dual(b - left.TransposeTimes(right.Times(*x)));
    const double left_over = dual.norm() / length;
    const bool stalled = !(left_over < 0.5 * result.residual);
    result.residual = left_over;
    if (stalled) break;
  }
  return result;
}

MetricSolver::Result MetricSolver::SolveInEitherPrecision(const FeatureDerivative& left,
                                                          const FeatureDerivative& right,
                                                          const Tangent& b, double tolerance,
                                                          int max_iterations, Tangent* x) {
  const Result result = Solve(left, right, b, tolerance, max_iterations, x);
  if (result.residual <= std::max(tolerance, kRounding) || !UseDoublePrecision()) return result;
  return Solve(left, right, b, tolerance, max_iterations, x);
}

MetricSolver::Result MetricSolver::SolveDual(const FeatureDerivative& left,
                                             const FeatureDerivative& right,
                                             const Eigen::VectorXd& dual, double tolerance,
                                             int max_iterations, Tangent* x) const {
  // Preconditioned from both sides, F^{-1} left^T right F^{-T}, so that norms are those of the
  // metric.
  const double length = dual.norm();
  std::vector<Eigen::VectorXd> basis = {dual / length};
  std::vector<Tangent> images;  // F^{-T} of the basis
  Eigen::MatrixXd hessenberg = Eigen::MatrixXd::Zero(max_iterations + 1, max_iterations);
  Eigen::VectorXd coefficients;
  Result result;
  result.residual = 1;
  while (result.iterations < max_iterations && result.residual > tolerance) {
    const int k = result.iterations++;
    images.push_back(FromDual(basis[k]));
    Eigen::VectorXd next = Dual(left.TransposeTimes(right.Times(images[k])));
    // Orthogonalised twice, which keeps the basis orthogonal up to rounding.
    for (int round = 0; round < 2; ++round) {
      for (int i = 0; i <= k; ++i) {
        const double share = basis[i].dot(next);
        hessenberg(i, k) += share;
        next -= share * basis[i];
      }
    }
    hessenberg(k + 1, k) = next.norm();
    // The best combination so far solves a small least squares problem.
    const auto small = hessenberg.topLeftCorner(k + 2, k + 1);
    Eigen::VectorXd target = Eigen::VectorXd::Zero(k + 2);
    target(0) = 1;
    coefficients = small.householderQr().solve(target);
    result.residual = (small * coefficients - target).norm();
    basis.push_back(next / hessenberg(k + 1, k));
  }
  *x = Tangent::Zero(3, dual.size() / 3);
  for (int i = 0; i < coefficients.size(); ++i) *x += length * coefficients(i) * images[i];
  return result;
}

}  // namespace shapespace::internal
