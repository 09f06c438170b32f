#include <shapespace/exponential/internal/metric_solver.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Dense>

#include <shapespace/base/internal/stopwatch.h>

namespace shapespace::internal {

void MetricSolver::Factor(const FeatureDerivative& at) {
  const Stopwatch stopwatch;
  if (!factor_) {
    matrix_ = at.MetricMatrix();
    factor_.emplace(matrix_);
  } else {
    at.UpdateMetricMatrix(&matrix_);
    factor_->Update(matrix_);
  }
  ++factorisations_;
  factor_seconds_ += stopwatch.Seconds();
}

void MetricSolver::HalfSolve(bool transposed, Eigen::VectorXd* x) const {
  const Eigen::Index size = x->size();
  x->conservativeResize(factor_->WorkRows());
  if (transposed) {
    factor_->SolveUpper(x->data());
  } else {
    factor_->SolveLower(x->data());
  }
  x->conservativeResize(size);
}

Eigen::VectorXd MetricSolver::Permuted(const Tangent& b) const {
  const std::vector<int>& permutation = factor_->Permutation();
  Eigen::VectorXd x(b.size());
  for (int i = 0; i < x.size(); ++i) x(i) = b.data()[permutation[i]];
  return x;
}

Tangent MetricSolver::Unpermuted(const Eigen::VectorXd& x) const {
  const std::vector<int>& permutation = factor_->Permutation();
  Tangent b(3, x.size() / 3);
  for (int i = 0; i < x.size(); ++i) b.data()[permutation[i]] = x(i);
  return b;
}

double MetricSolver::DualNorm(const Tangent& b) const {
  Eigen::VectorXd x = Permuted(b);
  HalfSolve(false, &x);
  return x.norm();
}

MetricSolver::Result MetricSolver::Solve(const FeatureDerivative& left,
                                         const FeatureDerivative& right, const Tangent& b,
                                         double tolerance, int max_iterations, Tangent* x) const {
  // Preconditioned from both sides, C^{-1} left^T right C^{-T}, so that norms are those of the
  // metric.
  const auto apply = [&](Eigen::VectorXd y) {
    HalfSolve(true, &y);
    Eigen::VectorXd z = Permuted(left.TransposeTimes(right.Times(Unpermuted(y))));
    HalfSolve(false, &z);
    return z;
  };
  Eigen::VectorXd start = Permuted(b);
  HalfSolve(false, &start);
  const double length = start.norm();
  Result result;
  *x = Tangent::Zero(3, b.cols());
  if (length == 0) return result;

  std::vector<Eigen::VectorXd> basis = {start / length};
  Eigen::MatrixXd hessenberg = Eigen::MatrixXd::Zero(max_iterations + 1, max_iterations);
  Eigen::VectorXd coefficients;
  result.residual = 1;
  while (result.iterations < max_iterations && result.residual > tolerance) {
    const int k = result.iterations++;
    Eigen::VectorXd next = apply(basis[k]);
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
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(start.size());
  for (int i = 0; i < coefficients.size(); ++i) sum += length * coefficients(i) * basis[i];
  HalfSolve(true, &sum);
  *x = Unpermuted(sum);
  return result;
}

}  // namespace shapespace::internal
