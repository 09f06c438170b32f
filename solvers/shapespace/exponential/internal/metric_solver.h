#ifndef SHAPESPACE_EXPONENTIAL_INTERNAL_METRIC_SOLVER_H_
#define SHAPESPACE_EXPONENTIAL_INTERNAL_METRIC_SOLVER_H_

#include <optional>
#include <vector>

#include <Eigen/SparseCore>

#include <shapespace/mesh/shape.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/sparse/internal/cholesky.h>

namespace shapespace::internal {

/// Solves linear systems with the metric's matrix J^T J, or with J_a^T J_b for two neighbouring
/// shapes of a path, which is not symmetric. GMRES (Saad and Schultz, 1986) is preconditioned by a
/// factor F F^T of the metric at one of the shapes. With S S^T the metric without sum features, of
/// which S is a sparse factor, and W = S^{-1} U for the columns U of sum features, which are few,
///   F = S (1 + W W^T)^(1/2)
/// (Woodbury's formula, as a product of two halves). With a factor at the same shape it takes
/// two or three iterations for two digits; with the previous step's factor, on real meshes, a
/// hundred, because soft motions depend on the surface's orientation. Therefore every step factors
/// again; the elimination order is computed once.
///
/// S is stored and applied in single precision, in half the memory and time. Where shapes
/// are so distorted that this does not suffice, the caller may choose double precision from then
/// on.
class MetricSolver {
 public:
  /// Takes the matrix of the metric at a shape, given by the derivative there.
  /// \throw SolverError if it is not definite (lambda 0, or a shape that has degenerated).
  void Factor(const FeatureDerivative& at);
  /// The same, unless the last factor is that of this `shape`, whose derivative is `at`.
  void FactorAt(const Shape& shape, const FeatureDerivative& at);

  /// Solves left^T right x = b until the residual is at most `tolerance` times |b|, both measured
  /// in the factored metric. The initial guess is zero.
  struct Result {
    int iterations = 0;
    double residual = 0;  ///< relative to |b|
  };
  Result Solve(const FeatureDerivative& left, const FeatureDerivative& right, const Tangent& b,
               double tolerance, int max_iterations, Tangent* x) const;
  /// The same, in double precision if single precision does not suffice.
  Result SolveInEitherPrecision(const FeatureDerivative& left, const FeatureDerivative& right,
                                const Tangent& b, double tolerance, int max_iterations, Tangent* x);

  /// `Solve` for a given Dual(b), in one run of GMRES: to a tolerance that single precision can
  /// reach, 1e-4 or more.
  Result SolveDual(const FeatureDerivative& left, const FeatureDerivative& right,
                   const Eigen::VectorXd& dual, double tolerance, int max_iterations,
                   Tangent* x) const;

  /// Stores the factor in double precision from now on. \return false if it did so before.
  bool UseDoublePrecision();

  /// G^{-1} b at the factored shape, up to the rounding of the factor.
  Tangent Approximate(const Tangent& b) const { return FromDual(Dual(b)); }

  /// F^{-1} b, in the factor's order. Its norm is that of a tangent whose image under G is `b`:
  /// sqrt(<b, G^{-1} b>).
  Eigen::VectorXd Dual(const Tangent& b) const;
  double DualNorm(const Tangent& b) const { return Dual(b).norm(); }

  int NumFactorisations() const { return factorisations_; }
  double FactorSeconds() const { return factor_seconds_; }

 private:
  const std::vector<int>& Permutation() const {
    return double_ ? double_->Permutation() : single_->Permutation();
  }
  // S^{-1} b, in the factor's order.
  Eigen::VectorXd SparseDual(const Tangent& b) const;
  // y <- S^{-1} y, or S^{-T} y, in the factor's order.
  void HalfSolve(bool transposed, Eigen::VectorXd* y) const;
  // y <- (1 + W W^T)^(-1/2) y.
  void ApplySums(Eigen::VectorXd* y) const;
  // Of W W^T, from `sum_rows_` and the sparse factor.
  void FactorSums();
  // F^{-T} y.
  Tangent FromDual(const Eigen::VectorXd& y) const;

  Eigen::SparseMatrix<double> matrix_;
  std::vector<Tangent> sum_rows_;  // the columns of U
  // An orthonormal basis of W's columns, of eigenvectors of W W^T, and the shares that
  // (1 + W W^T)^(-1/2) takes from them.
  Eigen::MatrixXd sum_basis_;
  Eigen::VectorXd sum_shares_;
  // One of these at a time.
  std::optional<CholeskyFactor<float>> single_;
  std::optional<Cholesky> double_;
  Shape factored_;  // the shape of the factor; empty if it is not known
  int factorisations_ = 0;
  double factor_seconds_ = 0;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_EXPONENTIAL_INTERNAL_METRIC_SOLVER_H_
