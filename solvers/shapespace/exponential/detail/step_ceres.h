#ifndef SHAPESPACE_EXPONENTIAL_DETAIL_STEP_CERES_H_
#define SHAPESPACE_EXPONENTIAL_DETAIL_STEP_CERES_H_

#include <Eigen/Core>

#include <shapespace/exponential/exponential.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/feature_map.h>

namespace shapespace::internal {

// Problems of shooting and transport that are solved by Ceres, with automatically differentiated
// cost functions (cost/). Shapes are in the metric's unit.

struct StepResult {
  bool converged = false;
  int iterations = 0;
  double residual = 0;  ///< at the end, relative as the tolerance
};

/// Solves J(at)^T [Phi(P) - target] = 0 for P, with one residual block per vertex, which depends on
/// the vertices that share an element with it. `*shape` contains the initial guess and receives the
/// result, or the best iterate. Converged when the norm of the residual is at most `tolerance`
/// times |J(at)^T (target - Phi(at))|, or at the level of rounding. Ceres factors the normal
/// equations, which squares the condition number: about 3 iterations up to 1000 vertices, 12 at
/// 3000.
/// \throw InvalidOptions if the metric has a volume feature and more than cost::kMaxDenseVertices
///        vertices; SolverError if the residual is not finite at the start.
StepResult SolveStepWithCeres(const FeatureMap& map, const Shape& at, const Eigen::VectorXd& target,
                              double tolerance, int max_iterations, Shape* shape);

/// Solves the paper's (7) at the shape `at`: x_j (G x)_j = a_j for every coordinate j of the
/// velocity x, with residuals F_0 - 2 x_j (G x)_j - C_j, where F_0 is the sum of all a_j and C_j =
/// F_0 - 2 a_j. `constants` contains a (3 x m). `solver` minimises the sum of the squared
/// residuals, from `*velocity`, which receives the last iterate. Converged when the norm of the
/// residual is at most `tolerance` times its value at x = 0. A root need not exist, and an existing
/// root is often not found.
/// \throw InvalidOptions if the metric has a volume feature, which couples all rows; SolverError if
///        the residual is not finite at the start.
StepResult SolveFirstIntegral(const FeatureMap& map, const Shape& at, const Tangent& constants,
                              FirstIntegralSolver solver, double tolerance, int max_iterations,
                              Tangent* velocity);

/// The paper's transport (section 5): the Y nearest to `x` in the Euclidean sense with <Y, normal>
/// = constant. Ceres has no constraints, so the constraint is a residual of large weight, which
/// leaves 1e-8 of its initial error.
/// \throw SolverError if `normal` is zero, or so small relative to `constant` that `x` would be
///        lost in the rounding of Y.
Tangent ProjectOntoConstraint(const Tangent& x, const Tangent& normal, double constant);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_EXPONENTIAL_DETAIL_STEP_CERES_H_
