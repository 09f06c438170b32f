#include <shapespace/exponential/internal/nearest_shape.h>

#include <utility>

#include <Eigen/Geometry>

#include <shapespace/metric/internal/spin.h>

namespace shapespace::internal {
namespace {

// A step is shortened until it gains this share of its predicted decrease.
constexpr double kSufficient = 1e-4;
constexpr int kMaxHalvings = 8;

// A step of which the rotation is carried out as one. It costs position alone, which may cost next
// to nothing; then rounding makes it large, and along straight lines it would distort the shape.
class ScrewStep {
 public:
  ScrewStep(const Shape& from, Tangent step) : from_(from), rest_(std::move(step)) {
    const Shape arms = from.colwise() - Eigen::Vector3d(from.rowwise().mean());
    spin_ = SpinOf(arms, Eigen::VectorXd::Ones(arms.cols()), rest_);
    RemoveSpin(arms, spin_, &rest_);
  }

  Shape Take(double factor) const {
    const Shape moved = from_ + factor * rest_;
    const Eigen::Vector3d centre = moved.rowwise().mean();
    const Eigen::AngleAxisd turn(factor * spin_.norm(), spin_.stableNormalized());
    return (turn.toRotationMatrix() * (moved.colwise() - centre)).colwise() + centre;
  }

 private:
  const Shape& from_;
  Tangent rest_;  // the step without its rotation
  Eigen::Vector3d spin_;
};

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
    const double predicted_decrease = step.cwiseProduct(gradient).sum();
    if (predicted_decrease <= options.tolerance) {
      result.termination = Termination::kConverged;
      break;
    }
    const ScrewStep motion(result.shape, -step);
    bool lowered = false;
    double factor = 1;
    for (int halving = 0; !lowered && halving <= kMaxHalvings; ++halving, factor *= 0.5) {
      Shape trial = motion.Take(factor);
      Eigen::VectorXd left = map.Values(trial) - target;
      const double gain = result.squared_distance - left.squaredNorm();
      if (!(gain >= kSufficient * factor * predicted_decrease)) continue;
      lowered = true;
      if (halving == 0 && gain <= options.tolerance) result.termination = Termination::kConverged;
      result.shape = std::move(trial);
      distance = std::move(left);
      result.squared_distance = distance.squaredNorm();
    }
    if (!lowered) {
      result.termination = Termination::kStalled;
      break;
    }
  }
  map.GetMetric().connectivity->CopyToTwins(&result.shape);
  return result;
}

}  // namespace shapespace::internal
