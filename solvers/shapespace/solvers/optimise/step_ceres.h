#ifndef SHAPESPACE_SOLVERS_OPTIMISE_STEP_CERES_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_STEP_CERES_H_

#include <Eigen/Core>

#include <shapespace/mesh/shape.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/solvers/exponential.h>

namespace shapespace::internal {

// What Ceres solves for shooting and transport, on automatically differentiated cost functions
// (cost/). Shapes in the metric's unit.

struct StepResult {
  bool converged = false;
  int iterations = 0;
  double residual = 0;  ///< at the end, as the tolerance
};

/// Solves J(at)^T [Phi(P) - target] = 0 for P: one residual block a vertex, on the vertices that
/// share an element with it. Starts from `*shape` and leaves the result there, or the best that was
/// found. Done when the norm of the residual is at most `tolerance` times
/// |J(at)^T (target - Phi(at))|, or as small as rounding lets it be. Ceres factors the normal
/// equations, which square the condition number of the step: about 3 iterations up to 1000
/// vertices, 12 at 3000.
/// \throw InvalidOptions if the metric has a volume feature and more than cost::kMaxDenseVertices
///        vertices; SolverError if the residual is not finite at the start.
StepResult SolveStepWithCeres(const FeatureMap& map, const Shape& at, const Eigen::VectorXd& target,
                              double tolerance, int max_iterations, Shape* shape);

/// The paper's (7) at the shape `at`: x_j (G x)_j = a_j for every coordinate j of the velocity x,
/// as residuals F_0 - 2 x_j (G x)_j - C_j with F_0 the sum of all a_j and C_j = F_0 - 2 a_j.
/// `constants` holds a (3 x m). `solver` lowers the sum of the squared residuals, from `*velocity`,
/// and leaves there what it ends with. Converged when the norm of the residual is at most
/// `tolerance` times what it is at x = 0. There need be no root, and where there is one it often is
/// not found.
/// \throw InvalidOptions if the metric has a volume feature, which couples all rows; SolverError if
///        the residual is not finite at the start.
StepResult SolveFirstIntegral(const FeatureMap& map, const Shape& at, const Tangent& constants,
                              FirstIntegralSolver solver, double tolerance, int max_iterations,
                              Tangent* velocity);

/// The paper's transport (section 5): the Y nearest to `x` in the Euclidean sense with
/// <Y, normal> = constant; Ceres has no constraints, so it is a residual of great weight, and the
/// constraint is missed by 1e-8 of the way to it.
/// \throw SolverError if `normal` vanishes: is zero, or so small beside `constant` that the
///        rounding of Y would swallow `x`.
Tangent ProjectOntoConstraint(const Tangent& x, const Tangent& normal, double constant);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_STEP_CERES_H_
