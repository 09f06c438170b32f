#include <shapespace/solvers/optimise/step.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <shapespace/base/error.h>
#include <shapespace/solvers/optimise/step_ceres.h>

namespace shapespace::internal {
namespace {

// Newton's method starts only from shapes that are not much worse an answer than to stay in place,
// whose residual is the whole step (1; roots were found from up to 1.1), and goes on only while
// each of its steps leaves at most so much of the residual: on real meshes it either converges
// within ten steps or never.
constexpr double kFarthestStart = 1.5, kLeastProgress = 0.8;
constexpr int kHalvings = 2;
// Where rounding ends Newton's method before the tolerance, the shape is a root all the same.
constexpr double kRoot = 1e-6;
// Linear systems are solved to two digits; Newton's method then gains as many a step. Near a root
// that takes up to eight iterations.
constexpr double kForcing = 1e-2;
constexpr int kMaxKrylov = 20;
// Of a path that rests, or moves rigidly, aligned shapes differ by a few roundings.
constexpr double kRest = 10;

constexpr int kMaxGaussNewton = 20, kGaussNewtonHalvings = 8;
constexpr double kGaussNewtonProgress = 1e-4;

// How far in feature space rounding of a shape's coordinates leads, with signs that have nothing to
// do with each other.
double RoundingOf(const Shape& shape, const FeatureDerivative& derivative) {
  Tangent rounding = std::numeric_limits<double>::epsilon() * shape.cwiseAbs();
  for (int i = 1; i < rounding.size(); i += 2) rounding.data()[i] *= -1;
  return derivative.Times(rounding).norm();
}

}  // namespace

Tangent SolveMetric(const MetricSolver& solver, const FeatureDerivative& derivative,
                    const Tangent& b) {
  Tangent x;
  // Without sum features the first iteration already is the answer but for rounding.
  const MetricSolver::Result result =
      solver.Solve(derivative, derivative, b, 1e-13, 2 * kMaxKrylov, &x);
  if (!(result.residual < 1e-8)) {
    throw SolverError("a linear system in the metric could not be solved: the shape degenerates");
  }
  return x;
}

Step::Step(const FeatureMap& map, MetricSolver* solver, const Departure& departure,
           const std::function<void()>& check_cancelled)
    : map_(map),
      solver_(*solver),
      departure_(departure),
      check_cancelled_(check_cancelled),
      current_(map.Values(departure.shape)),
      derivative_(map.Derivative(departure.shape)) {
  const Eigen::VectorXd change = departure.previous.size() > 0
                                     ? Eigen::VectorXd(current_ - map.Values(departure.previous))
                                     : derivative_.Times(departure.velocity);
  target_ = current_ + change;
  speed_ = change.norm();
  rounding_ = RoundingOf(departure.shape, derivative_);
  solver_.Factor(derivative_);
}

Shape Step::Predict() const {
  const bool discrete = departure_.previous.size() > 0;
  const Tangent velocity =
      discrete ? Tangent(departure_.shape - departure_.previous) : departure_.velocity;
  const Tangent acceleration = -solver_.ApplyInverse(
      derivative_.TransposeTimes(map_.SecondDerivative(departure_.shape, velocity)));
  // Seen from two shapes, the velocity is of half a step ago.
  return departure_.shape + velocity + (discrete ? 1 : 0.5) * acceleration;
}

bool Step::Solve(const ExponentialOptions& options, ExponentialSummary::Step* row,
                 Shape* shape) const {
  if (speed_ <= kRest * rounding_) {
    *shape = departure_.shape;
    row->converged = true;
    return true;
  }
  const double tolerance = std::max(options.tolerance, rounding_ / speed_);
  Shape root = *shape;
  bool found = false, converged = false;
  if (options.solver == StepSolver::kCeres) {
    const StepResult result = SolveStepWithCeres(map_, departure_.shape, target_, options.tolerance,
                                                 options.max_iterations, &root);
    row->iterations += result.iterations;
    row->residual = result.residual;
    found = converged = result.converged;
  } else {
    found = SolveWithNewton(tolerance, options.max_iterations, row, &root);
    converged = row->residual <= tolerance;
  }
  const double speed = (map_.Values(root) - current_).norm();
  if (!found || !(std::abs(speed / speed_ - 1) < kSpeedChange)) return false;
  row->converged = converged;
  *shape = root;
  return true;
}

bool Step::SolveWithNewton(double tolerance, int max_iterations, ExponentialSummary::Step* row,
                           Shape* shape) const {
  const auto residual_at = [&](const Shape& p) {
    return derivative_.TransposeTimes(map_.Values(p) - target_);
  };
  Tangent residual = residual_at(*shape);
  double size = solver_.DualNorm(residual) / speed_;
  row->residual = size;
  if (!(size < kFarthestStart)) return false;
  for (int iteration = 0; size > tolerance; ++iteration) {
    if (iteration == max_iterations) return size <= kRoot;
    check_cancelled_();
    ++row->iterations;
    Tangent step;
    const MetricSolver::Result linear =
        solver_.Solve(derivative_, map_.Derivative(*shape), residual, kForcing, kMaxKrylov, &step);
    row->krylov_iterations += linear.iterations;
    if (linear.residual > kForcing) return size <= kRoot;
    double factor = 1;
    for (int halving = 0;; ++halving, factor *= 0.5) {
      if (halving > kHalvings) return size <= kRoot;
      const Shape trial = *shape - factor * step;
      const Tangent left = residual_at(trial);
      const double left_size = solver_.DualNorm(left) / speed_;
      if (left_size < kLeastProgress * size || left_size <= tolerance) {
        *shape = trial;
        residual = left;
        size = left_size;
        break;
      }
    }
    row->residual = size;
  }
  return true;
}

Shape Step::Nearest(const Shape& start, ExponentialSummary::Step* row) const {
  Shape shape = start;
  Eigen::VectorXd distance = map_.Values(shape) - target_;
  if (!(distance.norm() < speed_)) {  // no better than to stay
    shape = departure_.shape;
    distance = current_ - target_;
  }
  bool progress = true;
  for (int iteration = 0; progress && iteration < kMaxGaussNewton; ++iteration) {
    check_cancelled_();
    ++row->iterations;
    const FeatureDerivative derivative = map_.Derivative(shape);
    solver_.Factor(derivative);
    const Tangent step = SolveMetric(solver_, derivative, derivative.TransposeTimes(distance));
    const double size = distance.norm();
    progress = false;
    double factor = 1;
    for (int halving = 0; !progress && halving <= kGaussNewtonHalvings; ++halving, factor *= 0.5) {
      const Shape trial = shape - factor * step;
      const Eigen::VectorXd left = map_.Values(trial) - target_;
      if (left.norm() < size * (1 - kGaussNewtonProgress)) {
        shape = trial;
        distance = left;
        progress = true;
      }
    }
  }
  solver_.Factor(derivative_);  // what residuals are measured by
  if (shape == departure_.shape) {
    throw SolverError("no shape near is any closer to where the motion leads: it comes to a halt");
  }
  return shape;
}

}  // namespace shapespace::internal
