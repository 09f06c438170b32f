#include <shapespace/geodesic/internal/residual_blocks.h>

#include <cmath>

#include <ceres/autodiff_cost_function.h>
#include <ceres/solver.h>

#include <shapespace/minimise/internal/keep_going.h>
#include <shapespace/sparse/internal/one_thread.h>

namespace shapespace::internal {
namespace {

// The residual root_weight (p - target).
struct PenaltyResidual {
  double root_weight;
  Eigen::Vector3d target;

  template <typename T>
  bool operator()(const T* p, T* residual) const {
    for (int k = 0; k < 3; ++k) residual[k] = root_weight * (p[k] - target(k));
    return true;
  }
};

}  // namespace

void ResidualBlocks::AddPathEnergy(const Metric& metric, double quartic_weight,
                                   std::vector<Shape>* shapes) {
  cost::AddPathEnergy(metric, shapes, &problem_, &motions_, quartic_weight);
}

void ResidualBlocks::AddPenalty(double weight, const Eigen::Vector3d& target, double* vertex) {
  problem_.AddResidualBlock(new ceres::AutoDiffCostFunction<PenaltyResidual, 3, 3>(
                                new PenaltyResidual{std::sqrt(0.5 * weight), target}),
                            nullptr, vertex);
}

void ResidualBlocks::Fix(double* vertex) { problem_.SetParameterBlockConstant(vertex); }

MinimiseResult ResidualBlocks::Minimise(const MinimiseOptions& options) {
  ceres::Solver::Options ceres_options;
  ceres_options.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  ceres_options.max_num_iterations = options.max_iterations;
  ceres_options.function_tolerance = options.tolerance;
  ceres_options.gradient_tolerance = 0;
  ceres_options.parameter_tolerance = 0;
  ceres_options.logging_type = ceres::SILENT;
  KeepGoing keep_going(options.keep_going);
  ceres_options.callbacks.push_back(&keep_going);
  ceres::Solver::Summary summary;
  const OneThread one_thread;
  ceres::Solve(ceres_options, &problem_, &summary);

  MinimiseResult result;
  result.iterations = static_cast<int>(summary.iterations.size()) - 1;
  result.evaluations = summary.num_residual_evaluations;
  result.initial_energy = 4 * summary.initial_cost;  // Ceres' cost is a quarter of the energy
  result.energy = 4 * summary.final_cost;
  if (keep_going.Stopped()) {
    result.termination = Termination::kCancelled;
  } else if (summary.termination_type == ceres::CONVERGENCE) {
    result.termination = Termination::kConverged;
  } else if (summary.termination_type == ceres::NO_CONVERGENCE) {
    result.termination = Termination::kMaxIterations;
  }
  return result;
}

MinimiseResult MinimiseTrustRegion(const Metric& metric, double quartic_weight,
                                   const MinimiseOptions& options, std::vector<Shape>* shapes) {
  ResidualBlocks blocks;
  blocks.AddPathEnergy(metric, quartic_weight, shapes);
  blocks.Fix(&shapes->front());
  blocks.Fix(&shapes->back());
  return blocks.Minimise(options);
}

}  // namespace shapespace::internal
