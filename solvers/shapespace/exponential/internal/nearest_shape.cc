#include <shapespace/exponential/internal/nearest_shape.h>

#include <utility>

namespace shapespace::internal {
namespace {

// A step is shortened until it gains this share of its predicted decrease.
constexpr double kSufficient = 1e-4;
constexpr int kMaxHalvings = 8;

}  // namespace

NearestShape FindNearestShape(const FeatureMap& map, const Eigen::VectorXd& target,
                              const Shape& start, const NearestShapeOptions& options,
                              const std::function<void()>& check_cancelled, MetricSolver* solver) {
  NearestShape result;
  result.shape = start;
  Eigen::VectorXd distance = map.Values(start) - target;
  result.squared_distance = distance.squaredNorm();
  if (result.squared_distance <= options.tolerance) result.termination = Termination::kConverged;
  while (!result.Converged() && result.iterations < options.max_iterations) {
    check_cancelled();
    ++result.iterations;
    const FeatureDerivative derivative = map.Derivative(result.shape);
    solver->Factor(derivative);
    const Tangent gradient = derivative.TransposeTimes(distance);
    const Tangent step = solver->Approximate(gradient);
    const double promise = step.cwiseProduct(gradient).sum();
    if (promise <= options.tolerance) {
      result.termination = Termination::kConverged;
      break;
    }
    bool lowered = false;
    double factor = 1;
    for (int halving = 0; !lowered && halving <= kMaxHalvings; ++halving, factor *= 0.5) {
      Shape trial = result.shape - factor * step;
      Eigen::VectorXd left = map.Values(trial) - target;
      const double gain = result.squared_distance - left.squaredNorm();
      if (!(gain >= kSufficient * factor * promise)) continue;
      lowered = true;
      if (halving == 0 && gain <= options.tolerance) result.termination = Termination::kConverged;
      result.shape = std::move(trial);
      distance = std::move(left);
      result.squared_distance = distance.squaredNorm();
    }
    if (!lowered && !solver->UseDoublePrecision()) {
      result.termination = Termination::kStalled;
      break;
    }
  }
  map.GetMetric().connectivity->CopyToTwins(&result.shape);
  return result;
}

}  // namespace shapespace::internal
