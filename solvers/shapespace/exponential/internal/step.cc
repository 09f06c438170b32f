#include <shapespace/exponential/internal/step.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <shapespace/base/error.h>
#include <shapespace/exponential/detail/step_ceres.h>
#include <shapespace/exponential/internal/nearest_shape.h>

namespace shapespace::internal {
namespace {

// Newton's method continues only while each of its iterations reduces the residual at least to this
// share. On real meshes it either converges fast or moves away, often to the root of another
// geodesic, on which a thin triangle has turned over.
constexpr double kContraction = 0.5;
// Least increment of the load.
constexpr double kMinIncrement = 1.0 / 64;
// Linear systems are solved to two digits, so that an iteration of Newton's method gains two
// digits. Near a root that takes up to eight iterations.
constexpr double kForcing = 1e-2;
constexpr int kMaxKrylov = 20;
// Accuracy limited by rounding; two iterations reach it.
constexpr double kExact = 1e-13;

// For the nearest shape in feature space, which is an approximation of first order only.
constexpr int kMaxGaussNewton = 20;
constexpr double kNearestTolerance = 1e-4;

// The change in feature space due to the rounding of a shape's coordinates, with alternating signs.
double RoundingOf(const Shape& shape, const FeatureDerivative& derivative) {
  Tangent rounding = std::numeric_limits<double>::epsilon() * shape.cwiseAbs();
  for (int i = 1; i < rounding.size(); i += 2) rounding.data()[i] *= -1;
  return derivative.Times(rounding).norm();
}

}  // namespace

Tangent SegmentVelocity(const FeatureMap& map, const Shape& other, const Shape& at, double sign,
                        MetricSolver* solver) {
  const FeatureDerivative derivative = map.Derivative(at);
  solver->FactorAt(at, derivative);
  Tangent velocity = SolveMetric(
      derivative, derivative.TransposeTimes(sign * (map.Values(at) - map.Values(other))), solver);
  map.GetMetric().connectivity->CopyToTwins(&velocity);
  return velocity;
}

Tangent SolveMetric(const FeatureDerivative& derivative, const Tangent& b, MetricSolver* solver) {
  Tangent x;
  const MetricSolver::Result result =
      solver->SolveInEitherPrecision(derivative, derivative, b, kExact, 2 * kMaxKrylov, &x);
  if (!(result.residual < 1e-8)) {
    throw SolverError("a linear system in the metric could not be solved: the shape degenerates");
  }
  return x;
}

Step::Step(const FeatureMap& map, MetricSolver* solver, const InitialState& initial_state,
           const std::function<void()>& check_cancelled)
    : map_(map),
      solver_(*solver),
      initial_state_(initial_state),
      check_cancelled_(check_cancelled),
      current_(map.Values(initial_state.shape)),
      derivative_(map.Derivative(initial_state.shape)) {
  change_ = initial_state.previous.size() > 0
                ? Eigen::VectorXd(current_ - map.Values(initial_state.previous))
                : derivative_.Times(initial_state.velocity);
  speed_ = change_.norm();
  rounding_ = RoundingOf(initial_state.shape, derivative_);
  solver_.FactorAt(initial_state.shape, derivative_);
}

bool Step::Solve(const ExponentialOptions& options, ExponentialSummary::Step* row,
                 Shape* shape) const {
  if (speed_ <= rounding_) {  // a path that rests, or moves rigidly
    *shape = initial_state_.shape;
    row->converged = true;
    row->residual = 0;
    return true;
  }
  // P(load) to second order. The velocity is found as a correction of one that is known or near,
  // because the factor's rounding along soft motions, such as translations, would hardly count in
  // the residual and therefore remain.
  Tangent velocity, acceleration;
  const auto expand = [&] {
    velocity = initial_state_.velocity;
    if (velocity.size() == 0) {
      velocity = initial_state_.shape - initial_state_.previous;
      velocity +=
          solver_.Approximate(derivative_.TransposeTimes(change_ - derivative_.Times(velocity)));
    }
    acceleration = -solver_.Approximate(
        derivative_.TransposeTimes(map_.SecondDerivative(initial_state_.shape, velocity)));
  };
  expand();
  const auto expansion = [&](double load) -> Shape {
    return initial_state_.shape + load * velocity + 0.5 * load * load * acceleration;
  };

  const int last_iteration = row->iterations + options.max_iterations;
  Shape reached = initial_state_.shape;
  double load = 0, increment = 1;
  while (load < 1) {
    if (row->iterations == last_iteration) return false;
    const double next = std::min(1.0, load + increment);
    // The previous error of the expansion is added as a correction.
    Shape root = reached + expansion(next) - expansion(load);
    ++row->increments;
    if (FindRoot(next, last_iteration - row->iterations, options, row, &root)) {
      reached = root;
      load = next;
    } else if (load == 0 && increment == 1 && solver_.UseDoublePrecision()) {
      --row->increments;  // the same again
      expand();
    } else {
      increment = 0.5 * (next - load);
      if (increment < kMinIncrement) return false;
    }
  }
  *shape = reached;
  return true;
}

bool Step::FindRoot(double load, int iterations, const ExponentialOptions& options,
                    ExponentialSummary::Step* row, Shape* shape) const {
  row->converged = false;
  Shape root = *shape;
  bool found = false;
  if (options.solver == StepSolver::kCeres) {
    const StepResult result =
        SolveStepWithCeres(map_, initial_state_.shape, current_ + load * change_, options.tolerance,
                           iterations, &root);
    row->iterations += result.iterations;
    row->residual = result.residual;
    found = result.converged;
  } else {
    const double tolerance = std::max(options.tolerance, rounding_ / speed_);
    found = SolveWithNewton(load, iterations, tolerance, row, &root);
  }
  if (!found || !HasTheGeodesicsSpeed(root, load)) return false;
  row->converged = load == 1;
  *shape = root;
  return true;
}

bool Step::HasTheGeodesicsSpeed(const Shape& shape, double load) const {
  const double speed = (map_.Values(shape) - current_).norm() / load;
  const auto agrees = [&](double other) { return std::abs(speed / other - 1) < kSpeedChange; };
  return agrees(speed_) && (initial_state_.speed == 0 || agrees(initial_state_.speed));
}

bool Step::SolveWithNewton(double load, int iterations, double tolerance,
                           ExponentialSummary::Step* row, Shape* shape) const {
  const Eigen::VectorXd target = current_ + load * change_;
  const auto dual_residual = [&](const Shape& at) {
    return solver_.Dual(derivative_.TransposeTimes(map_.Values(at) - target));
  };
  Eigen::VectorXd residual = dual_residual(*shape);
  row->residual = residual.norm() / speed_;
  for (; !(row->residual <= tolerance); --iterations) {
    if (iterations == 0) return false;
    check_cancelled_();
    ++row->iterations;
    Tangent step;
    const MetricSolver::Result linear = solver_.SolveDual(derivative_, map_.Derivative(*shape),
                                                          residual, kForcing, kMaxKrylov, &step);
    row->krylov_iterations += linear.iterations;
    if (!(linear.residual <= kForcing)) return false;
    const Shape next = *shape - step;
    residual = dual_residual(next);
    const double left = residual.norm() / speed_;
    if (!(left < kContraction * row->residual || left <= tolerance)) return false;
    *shape = next;
    row->residual = left;
  }
  return true;
}

Shape Step::Nearest(ExponentialSummary::Step* row) const {
  const NearestShape nearest = FindNearestShape(
      map_, current_ + change_, initial_state_.shape,
      {kNearestTolerance * speed_ * speed_, kMaxGaussNewton}, check_cancelled_, &solver_);
  row->iterations += nearest.iterations;
  const Shape& shape = nearest.shape;
  solver_.FactorAt(initial_state_.shape, derivative_);  // by which residuals are measured
  if (shape == initial_state_.shape) {
    throw SolverError(
        "no nearby shape is closer to the one that the step requires: the motion comes to a halt");
  }
  return shape;
}

}  // namespace shapespace::internal
