#include <algorithm>
#include <cmath>
#include <numeric>

#include <ceres/gradient_problem.h>
#include <ceres/gradient_problem_solver.h>

#include <shapespace/base/error.h>
#include <shapespace/minimise/internal/keep_going.h>
#include <shapespace/minimise/internal/minimise.h>
#include <shapespace/minimise/internal/preconditioned_energy.h>

namespace shapespace::internal {
namespace {

// Ends the solve when the remaining gain is small relative to the gain so far (MinimiseOptions).
class EnoughGained final : public ceres::IterationCallback {
 public:
  /// `start` is the energy at the very start, in units of that at the start of these iterations.
  EnoughGained(double enough, double start) : enough_(enough), start_(start) {}
  ceres::CallbackReturnType operator()(const ceres::IterationSummary& summary) override {
    const double left = 0.5 * summary.gradient_norm * summary.gradient_norm;
    const double gained = start_ - summary.cost;
    return left <= enough_ * gained ? ceres::SOLVER_TERMINATE_SUCCESSFULLY : ceres::SOLVER_CONTINUE;
  }

 private:
  const double enough_, start_;
};

ceres::GradientProblemSolver::Options CeresOptions(const MinimiseOptions& options,
                                                   double tolerance) {
  ceres::GradientProblemSolver::Options result;
  result.line_search_direction_type = ceres::LBFGS;
  result.line_search_type = ceres::WOLFE;
  result.max_lbfgs_rank = options.rank;
  result.max_num_iterations = options.max_iterations;
  result.function_tolerance = tolerance;
  result.gradient_tolerance = 1e-14;
  result.parameter_tolerance = 0;
  result.logging_type = ceres::SILENT;
  return result;
}

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

  // As long as the remaining decrease contradicts convergence, iterates on with smaller tolerances.
  for (double tolerance = options.tolerance;; tolerance *= kMoreAccurate) {
    const double before = result.energy;
    auto* const function =
        new PreconditionedEnergy(energy, variables, *unknowns, before, &result.evaluations);
    const ceres::GradientProblem problem(function);  // owns it
    std::vector<double> y(variables->Size(), 0.0);
    KeepGoing keep_going(options.keep_going);
    EnoughGained enough_gained(options.enough, unit / before);
    ceres::GradientProblemSolver::Options ceres_options = CeresOptions(options, tolerance);
    ceres_options.max_num_iterations -= result.iterations;
    ceres_options.callbacks.push_back(&keep_going);
    if (options.enough > 0) ceres_options.callbacks.push_back(&enough_gained);
    ceres::GradientProblemSolver::Summary summary;
    ceres::Solve(ceres_options, problem, y.data(), &summary);

    *unknowns = function->Unknowns(y.data());
    result.energy = summary.final_cost * before;
    result.iterations += static_cast<int>(summary.iterations.size()) - 1;
    result.remaining = RemainingDecrease(energy, variables, *unknowns);
    // If a line search finds no decrease at a point with nothing left to gain, the solve has
    // converged to rounding; otherwise it has stalled.
    if (keep_going.Stopped()) {
      result.termination = Termination::kCancelled;
    } else if (summary.termination_type == ceres::USER_SUCCESS ||
               result.remaining < options.tolerance * 1e-3) {
      result.termination = Termination::kConverged;
    } else if (summary.termination_type == ceres::NO_CONVERGENCE) {
      result.termination = Termination::kMaxIterations;
    } else if (summary.termination_type == ceres::CONVERGENCE) {
      if (result.remaining <= options.trusted_remaining * options.tolerance) {
        result.termination = Termination::kConverged;
      } else if (options.enough == 0 && result.energy < before) {
        continue;
      }
    }
    return result;
  }
}

}  // namespace shapespace::internal
