#ifndef SHAPESPACE_SOLVERS_OPTIMISE_STEP_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_STEP_H_

#include <functional>
#include <memory>

#include <Eigen/Core>

#include <shapespace/metric/feature_map.h>
#include <shapespace/solvers/exponential.h>
#include <shapespace/solvers/optimise/metric_solver.h>

namespace shapespace::internal {

/// Along a geodesic the speed is constant but for the discretisation's error: what changes it by
/// more than this share has lost the geodesic.
inline constexpr double kSpeedChange = 0.1;

/// Where a step starts from: a shape, and either the shape before it, one step earlier, or, at the
/// start of a geodesic, its velocity per step.
struct Departure {
  Shape shape;
  Shape previous;    ///< empty: there is a velocity
  Tangent velocity;  ///< empty: there is a previous shape
  double speed = 0;  ///< of the geodesic where it began, a step being the unit of time; 0: unknown
};

/// One step of the variational integrator on one mesh: finds P with
///   J(P_i)^T [Phi(P) - Phi(P_i) - change] = 0,
/// where `change` is Phi(P_i) - Phi(P_{i-1}), or J(P_i) X for a start with velocity X: the discrete
/// Legendre transform, whose inverse the logarithm is.
class Step {
 public:
  /// `map` and `solver` are kept by reference; the solver factors the metric at the departure.
  /// `check_cancelled` is called before every iteration, and may throw to end the step. \throw
  /// SolverError if the metric is not definite there.
  Step(const FeatureMap& map, MetricSolver* solver, const Departure& departure,
       const std::function<void()>& check_cancelled);

  /// The root that belongs to the departure: the end of the curve of roots P(load), load from 0 to
  /// 1, of the same equation with load * change in place of change. Newton's method first tries to
  /// reach P(1) at once; where it would wander off, the load is increased bit by bit.
  /// row->increments tells in how many. A root whose segment is much longer or shorter in the
  /// metric than the geodesic's is another geodesic's, and does not count.
  /// \return false, with `*shape` as it was, if there is none; otherwise row->converged is true.
  bool Solve(const ExponentialOptions& options, ExponentialSummary::Step* row, Shape* shape) const;

  /// The residual of any shape, as a share of the step.
  double Residual(const Shape& shape) const {
    return solver_.DualNorm(derivative_.TransposeTimes(map_.Values(shape) - current_ - change_)) /
           speed_;
  }

  /// Whether the segment to a root under `load` is as long in the metric as the segment before, and
  /// as the geodesic's first one if that is known, but for a tenth.
  bool HasTheGeodesicsSpeed(const Shape& root, double load) const;

  /// The shape nearest in feature space to what the step asks for: argmin |Phi(P) - Phi(P_i) -
  /// change|^2, by Gauss-Newton from the departure. Of first order only.
  /// \throw SolverError if that is the departure's own: the motion would stand still from here on.
  Shape Nearest(ExponentialSummary::Step* row) const;

 private:
  // The root under one load, from `*shape`, by `iterations` of Newton's method at most.
  bool FindRoot(double load, int iterations, const ExponentialOptions& options,
                ExponentialSummary::Step* row, Shape* shape) const;
  bool SolveWithNewton(double load, int iterations, double tolerance, ExponentialSummary::Step* row,
                       Shape* shape) const;

  const FeatureMap& map_;
  MetricSolver& solver_;
  const Departure& departure_;
  const std::function<void()>& check_cancelled_;
  Eigen::VectorXd current_;  // Phi(P_i)
  Eigen::VectorXd change_;
  double speed_ = 0;     // |change|
  double rounding_ = 0;  // of Phi(P_i), for want of digits in P_i
  FeatureDerivative derivative_;
};

/// Solves G(P) x = b as exactly as rounding allows, the solver's factor being of G at P.
/// \throw SolverError if it does not get there.
Tangent SolveMetric(const MetricSolver& solver, const FeatureDerivative& derivative,
                    const Tangent& b);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_STEP_H_
