#ifndef SHAPESPACE_EXPONENTIAL_INTERNAL_STEP_H_
#define SHAPESPACE_EXPONENTIAL_INTERNAL_STEP_H_

#include <functional>
#include <memory>

#include <Eigen/Core>

#include <shapespace/exponential/exponential.h>
#include <shapespace/exponential/internal/metric_solver.h>
#include <shapespace/metric/feature_map.h>

namespace shapespace::internal {

/// Along a geodesic the speed is constant up to the discretisation's error. If a step changes it by
/// more than this share, its root belongs to another geodesic.
inline constexpr double kSpeedChange = 0.1;

/// The data from which a step starts: a shape, and either the shape before it, one step earlier,
/// or, at the beginning of a geodesic, its velocity per step.
struct InitialState {
  Shape shape;
  Shape previous;    ///< empty if there is a velocity
  Tangent velocity;  ///< empty if there is a previous shape
  double speed = 0;  ///< at the beginning of the geodesic, with a step as the unit of time; 0:
                     ///< unknown
};

/// One step of the variational integrator on one mesh: finds P with
///   J(P_i)^T [Phi(P) - Phi(P_i) - change] = 0,
/// where `change` is Phi(P_i) - Phi(P_{i-1}), or J(P_i) X for an initial velocity X. This is the
/// discrete Legendre transform; the logarithm is its inverse.
class Step {
 public:
  /// `map` and `solver` are kept by reference; the solver factors the metric at the initial state.
  /// `check_cancelled` is called before every iteration, and may throw to end the step. \throw
  /// SolverError if the metric is not definite there.
  Step(const FeatureMap& map, MetricSolver* solver, const InitialState& initial_state,
       const std::function<void()>& check_cancelled);

  /// Finds the root that belongs to the initial state: the end of the curve of roots P(load), for
  /// load from 0 to 1, of the same equation with load * change in place of change. Newton's method
  /// first tries load 1 directly; if it does not converge well, the load is increased in stages,
  /// whose number is row->increments. A root whose segment is much longer or shorter in the metric
  /// than the geodesic's segments belongs to another geodesic and is rejected. \return false, with
  /// `*shape` unchanged, if there is no such root; otherwise row->converged is true.
  bool Solve(const ExponentialOptions& options, ExponentialSummary::Step* row, Shape* shape) const;

  /// The residual of any shape, as a share of the step.
  double Residual(const Shape& shape) const {
    return solver_.DualNorm(derivative_.TransposeTimes(map_.Values(shape) - current_ - change_)) /
           speed_;
  }

  /// Whether the segment to a root under `load` has the length, in the metric, of the segment
  /// before it and, if known, of the geodesic's first one, up to a tenth.
  bool HasTheGeodesicsSpeed(const Shape& root, double load) const;

  /// The shape whose features are nearest to those that the step requires: argmin |Phi(P) -
  /// Phi(P_i) - change|^2, by Gauss-Newton from the initial state. Of first order only.
  /// \throw SolverError if that is the initial state's own shape, because all further steps would
  ///        then be zero.
  Shape Nearest(ExponentialSummary::Step* row) const;

 private:
  // Finds the root under one load, from `*shape`, by at most `iterations` of Newton's method.
  bool FindRoot(double load, int iterations, const ExponentialOptions& options,
                ExponentialSummary::Step* row, Shape* shape) const;
  bool SolveWithNewton(double load, int iterations, double tolerance, ExponentialSummary::Step* row,
                       Shape* shape) const;

  const FeatureMap& map_;
  MetricSolver& solver_;
  const InitialState& initial_state_;
  const std::function<void()>& check_cancelled_;
  Eigen::VectorXd current_;  // Phi(P_i)
  Eigen::VectorXd change_;
  double speed_ = 0;     // |change|
  double rounding_ = 0;  // error of Phi(P_i) due to the rounding of P_i
  FeatureDerivative derivative_;
};

/// Solves G(P) x = b to rounding accuracy, where the solver's factor is that of G at P, where the
/// derivative is given.
/// \throw SolverError if this fails.
Tangent SolveMetric(const FeatureDerivative& derivative, const Tangent& b, MetricSolver* solver);

/// G(P_1) V = J(P_1)^T [Phi(P_1) - Phi(P_0)]: the velocity per step at the end of a segment from
/// `other` to `at`; with sign -1, the velocity at the beginning of the segment from `at` to
/// `other`. The solver factors the metric at `at`. \throw SolverError if it is not definite there.
Tangent SegmentVelocity(const FeatureMap& map, const Shape& other, const Shape& at, double sign,
                        MetricSolver* solver);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_EXPONENTIAL_INTERNAL_STEP_H_
