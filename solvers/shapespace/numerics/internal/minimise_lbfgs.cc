#include <algorithm>
#include <cmath>
#include <numeric>

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <shapespace/base/error.h>
#include <shapespace/numerics/internal/keep_going.h>
#include <shapespace/numerics/internal/minimise.h>
#include <shapespace/numerics/internal/preconditioned_energy.h>

namespace shapespace::internal {
namespace {

// Ends the solve when the remaining gain is small relative to the gain so far (MinimiseOptions).
class EnoughGained final : public ceres::IterationCallback {
 public:
  explicit EnoughGained(double enough) : enough_(enough) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    const double left = 0.5 * summary.gradient_norm * summary.gradient_norm;
    const double gained = 1 - summary.cost;  // of the energy at the start, which is one
    return left <= enough_ * gained ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  const double enough_;
};

}  // namespace

double RemainingDecrease(const Objective& energy, ChangeOfVariables* variables,
                         const std::vector<double>& unknowns) {
  std::vector<double> gradient(unknowns.size());
  const double value = energy(unknowns.data(), gradient.data());
  if (value == 0) return 0;
  std::vector<double> y(variables->Size());
  variables->ApplyTranspose(gradient.data(), 1, y.data());
  return 0.5 * std::inner_product(y.begin(), y.end(), y.begin(), 0.0) / value;
}

MinimiseResult MinimiseLbfgs(const Objective& energy, ChangeOfVariables* variables,
                             const MinimiseOptions& options, std::vector<double>* unknowns) {
  MinimiseResult result;
  const double unit = energy(unknowns->data(), nullptr);
  if (!std::isfinite(unit)) throw SolverError("the energy of the path to start from is not finite");
  result.initial_energy = result.energy = unit;
  if (unit == 0) {
    result.termination = Termination::kConverged;
    return result;
  }

  auto* const function =
      new PreconditionedEnergy(energy, variables, *unknowns, unit, &result.evaluations);
  const ceres::GradientProblem problem(function);  // owns it
  std::vector<double> y(variables->Size(), 0.0);

  ceres::GradientProblemSolver::Options ceres_options;
  ceres_options.line_search_direction_type = ceres::LBFGS;
  ceres_options.line_search_type = ceres::WOLFE;
  ceres_options.max_lbfgs_rank = options.rank;
  ceres_options.max_num_iterations = options.max_iterations;
  ceres_options.function_tolerance = options.tolerance;
  ceres_options.gradient_tolerance = 1e-14;
  ceres_options.parameter_tolerance = 0;
  ceres_options.logging_type = ceres::SILENT;
  KeepGoing keep_going(options.keep_going);
  ceres_options.callbacks.push_back(&keep_going);
  EnoughGained enough_gained(options.enough);
  if (options.enough > 0) ceres_options.callbacks.push_back(&enough_gained);
  ceres::GradientProblemSolver::Summary summary;
  ceres::Solve(ceres_options, problem, y.data(), &summary);

  *unknowns = function->Unknowns(y.data());
  result.energy = summary.final_cost * unit;
  result.iterations = static_cast<int>(summary.iterations.size()) - 1;
  result.remaining = RemainingDecrease(energy, variables, *unknowns);
  // If a line search finds no decrease at a point with nothing left to gain, the solve has
  // converged to rounding; otherwise it has stalled.
  if (keep_going.Stopped()) {
    result.termination = Termination::kCancelled;
  } else if (summary.termination_type == ceres::CONVERGENCE ||
             summary.termination_type == ceres::USER_SUCCESS ||
             result.remaining < options.tolerance * 1e-3) {
    result.termination = Termination::kConverged;
  } else if (summary.termination_type == ceres::NO_CONVERGENCE) {
    result.termination = Termination::kMaxIterations;
  }
  return result;
}

}  // namespace shapespace::internal
