#ifndef SHAPESPACE_SOLVERS_OPTIMISE_METRIC_SOLVER_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_METRIC_SOLVER_H_

#include <optional>
#include <vector>

#include <Eigen/SparseCore>

#include <shapespace/mesh/shape.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/solvers/optimise/cholesky.h>

namespace shapespace::internal {

/// Solves linear systems whose matrix is the metric's, J^T J, or near it: J_a^T J_b of two shapes
/// that are neighbours on a path, which is not symmetric. A sparse factor of the metric at one of
/// the shapes preconditions GMRES (Saad and Schultz, 1986). Factored at the very shape it takes two
/// or three iterations for two digits; factored a step earlier, on real meshes, a hundred: soft
/// motions follow the surface's orientation. So every step factors anew; its order of elimination
/// is found once.
class MetricSolver {
 public:
  /// Takes the matrix of the metric at a shape, given by the derivative there.
  /// \throw SolverError if it is not definite (lambda 0, or a shape that has degenerated).
  void Factor(const FeatureDerivative& at);

  /// Solves left^T right x = b until the residual is at most `tolerance` times |b|, both measured
  /// by the factored metric. Starts from zero.
  struct Result {
    int iterations = 0;
    double residual = 0;  ///< that share
  };
  Result Solve(const FeatureDerivative& left, const FeatureDerivative& right, const Tangent& b,
               double tolerance, int max_iterations, Tangent* x) const;

  /// The length of a tangent whose image under G is `b`: sqrt(<b, G^{-1} b>).
  double DualNorm(const Tangent& b) const;

  int NumFactorisations() const { return factorisations_; }
  double FactorSeconds() const { return factor_seconds_; }

 private:
  // x <- C^{-1} x, or C^{-T} x, of one right-hand side, in the factor's order.
  void HalfSolve(bool transposed, Eigen::VectorXd* x) const;
  Eigen::VectorXd Permuted(const Tangent& b) const;
  Tangent Unpermuted(const Eigen::VectorXd& x) const;

  Eigen::SparseMatrix<double> matrix_;
  std::optional<Cholesky> factor_;
  int factorisations_ = 0;
  double factor_seconds_ = 0;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_METRIC_SOLVER_H_
