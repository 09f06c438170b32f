#include <shapespace/exponential/detail/step_ceres.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include <ceres/iteration_callback.h>
#include <ceres/problem.h>
#include <ceres/solver.h>
#include <Eigen/SparseCore>

#include <shapespace/base/error.h>
#include <shapespace/cost/euler_lagrange.h>
#include <shapespace/cost/first_integral.h>
#include <shapespace/cost/internal/refuse_sums.h>
#include <shapespace/cost/path_energy.h>
#include <shapespace/cost/transport_constraint.h>
#include <shapespace/sparse/internal/one_thread.h>

namespace shapespace::internal {
namespace {

constexpr double kEpsilon = std::numeric_limits<double>::epsilon();

class StopAtResidual final : public ceres::IterationCallback {
 public:
  explicit StopAtResidual(double norm) : norm_(norm) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    return std::sqrt(2 * summary.cost) <= norm_ ? ceres::SOLVER_TERMINATE_SUCCESSFULLY
                                                : ceres::SOLVER_CONTINUE;
  }

 private:
  double norm_;
};

// A solve ends by its number of iterations or a callback, because Ceres' own tolerances do not
// measure the residual.
ceres::Solver::Options SolverOptions(int max_iterations) {
  ceres::Solver::Options options;
  options.max_num_iterations = max_iterations;
  options.function_tolerance = options.gradient_tolerance = options.parameter_tolerance = 0;
  options.logging_type = ceres::SILENT;
  return options;
}

}  // namespace

StepResult SolveStepWithCeres(const FeatureMap& map, const Shape& at, const Eigen::VectorXd& target,
                              double tolerance, int max_iterations, Shape* shape) {
  const Metric& metric = map.GetMetric();
  cost::RefuseDenseRows(metric);
  const FeatureDerivative derivative = map.Derivative(at);
  const auto residual = [&](const Shape& p) {
    return derivative.TransposeTimes(map.Values(p) - target).norm();
  };
  const double unit = residual(at);
  StepResult result;
  if (unit == 0) {
    *shape = at;
    result.converged = true;
    return result;
  }
  if (!std::isfinite(unit) || !std::isfinite(residual(*shape))) {
    throw SolverError("a step of the geodesic has no finite residual where it starts");
  }

  // In units of the residual at `at`, so that all numbers are of moderate size, as Ceres' absolute
  // limits (on the diagonal, on the scaling of columns) require.
  const cost::EulerLagrange equation(metric, at, target, 1 / unit);
  ceres::Problem problem;
  std::vector<double> sums;
  equation.AddTo(shape, &sums, &problem);
  const double enough = std::max(tolerance, equation.Rounding());
  // With the weights of the sums, the true residual of k sums is at most sqrt(1 + k) times Ceres'.
  StopAtResidual stop(enough / std::sqrt(1.0 + sums.size()));

  ceres::Solver::Options options = SolverOptions(max_iterations);
  options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  // Newton's method without damping as long as it reduces the residual. The damping of a trust
  // region radius is relative to the squared derivative, which differs between soft and stiff
  // motions by up to 1e16. With the radius 1e12 convergence is linear (60 iterations are not enough
  // at 1000 vertices; this takes 3).
  options.initial_trust_region_radius = options.max_trust_region_radius;
  options.callbacks.push_back(&stop);
  ceres::Solver::Summary summary;
  const OneThread one_thread;
  ceres::Solve(options, &problem, &summary);

  result.iterations = std::max(0, static_cast<int>(summary.iterations.size()) - 1);
  result.residual = residual(*shape) / unit;
  result.converged = result.residual <= enough;
  return result;
}

StepResult SolveFirstIntegral(const FeatureMap& map, const Shape& at, const Tangent& constants,
                              FirstIntegralSolver solver, double tolerance, int max_iterations,
                              Tangent* velocity) {
  cost::RefuseSums(map.GetMetric(), 0,
                   "the first integral (7) cannot take it; use another integrator");
  const int num_vertices = static_cast<int>(at.cols());
  StepResult result;
  const double norm = 2 * constants.norm();
  if (norm == 0) {  // all terms of <x, G x> are zero
    velocity->setZero(3, num_vertices);
    result.converged = true;
    return result;
  }
  const Eigen::SparseMatrix<double> lower = map.Derivative(at).MetricMatrix();
  const Eigen::SparseMatrix<double> matrix = lower.selfadjointView<Eigen::Lower>();
  const auto residual = [&](const Tangent& x) {
    const Eigen::VectorXd momentum = matrix * x.reshaped();
    const Eigen::VectorXd rows = constants.reshaped() - x.reshaped().cwiseProduct(momentum);
    return 2 * rows.norm() / norm;
  };
  if (!std::isfinite(residual(*velocity))) {
    throw SolverError("the first integral (7) has no finite residual where it starts");
  }

  // Ceres' absolute limits require numbers of moderate size: velocities in units of `unit`,
  // residuals in units of their norm at velocity zero.
  const double trace = matrix.diagonal().sum();
  const double unit = trace > 0 ? std::sqrt(constants.lpNorm<1>() / trace) : 1;
  Tangent unknowns = *velocity / unit;
  ceres::Problem problem;
  cost::AddFirstIntegral(unit * unit * matrix, constants, 1 / norm, &unknowns, &problem);

  StopAtResidual stop(tolerance);
  ceres::Solver::Options options = SolverOptions(max_iterations);
  if (solver == FirstIntegralSolver::kLbfgs) {
    options.minimizer_type = ceres::LINE_SEARCH;
    options.line_search_direction_type = ceres::LBFGS;
  } else {
    options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  }
  options.callbacks.push_back(&stop);
  ceres::Solver::Summary summary;
  const OneThread one_thread;
  ceres::Solve(options, &problem, &summary);

  result.iterations = std::max(0, static_cast<int>(summary.iterations.size()) - 1);
  // Scaling and back is not exact, and a start that is a root must stay unchanged.
  if (result.iterations > 0) *velocity = unit * unknowns;
  result.residual = residual(*velocity);
  result.converged = result.residual <= tolerance;
  return result;
}

Tangent ProjectOntoConstraint(const Tangent& x, const Tangent& normal, double constant) {
  // Weight of the constraint relative to the distance. The remaining error of the constraint is one
  // part in the weight's square, and that square still leaves half of the digits.
  constexpr double kWeight = 1e4;
  const double norm = normal.norm();
  const double least = std::abs(constant) / norm;  // least norm on the constraint
  const double length = x.norm();
  if (!(norm > 0) || !std::isfinite(least) || (length > 0 && kEpsilon * least > length)) {
    throw SolverError(
        "the constraint's normal, the metric times the path's velocity, vanishes: a vector that "
        "satisfies the constraint would have nothing of the given one left");
  }
  // Scaled to size one because of Ceres' absolute limits.
  const double unit = std::max(length, least);
  if (unit == 0) return x;
  Tangent y = x / unit;
  const Tangent direction = normal / norm;
  double bound = constant / norm / unit;

  ceres::Problem problem;
  cost::AddTransportConstraint(direction, kWeight, &bound, &y, &problem);

  // The problem is linear, and its gradient at x is an eigenvector of its matrix, the identity plus
  // a multiple of n n^T. So one step of conjugate gradients without preconditioner solves it; the
  // next iterations remove rounding errors.
  ceres::Solver::Options options = SolverOptions(3);
  options.linear_solver_type = ceres::CGNR;
  options.preconditioner_type = ceres::IDENTITY;
  options.max_linear_solver_iterations = 1;
  options.jacobi_scaling = false;
  options.initial_trust_region_radius = options.max_trust_region_radius;
  ceres::Solver::Summary summary;
  const OneThread one_thread;
  ceres::Solve(options, &problem, &summary);
  if (!summary.IsSolutionUsable()) {
    throw SolverError("the constraint cannot be met: " + summary.message);
  }
  return unit * y;
}

}  // namespace shapespace::internal
