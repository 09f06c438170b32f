#ifndef SHAPESPACE_EXPONENTIAL_INTERNAL_NEAREST_SHAPE_H_
#define SHAPESPACE_EXPONENTIAL_INTERNAL_NEAREST_SHAPE_H_

#include <functional>

#include <Eigen/Core>

#include <shapespace/exponential/internal/metric_solver.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/summary/termination.h>

namespace shapespace::internal {

/// Options of `FindNearestShape`.
struct NearestShapeOptions {
  /// Converged when the decrease of the squared distance in an iteration, predicted or actual, is
  /// not more than this.
  double tolerance = 0;
  int max_iterations = 0;
};

struct NearestShape {
  Shape shape;
  double squared_distance = 0;  ///< |Phi(shape) - target|^2
  int iterations = 0;
  Termination termination = Termination::kMaxIterations;  ///< kStalled: no step gained anything
  bool Converged() const { return termination == Termination::kConverged; }
};

/// The shape whose features are nearest to `target`, argmin |Phi(P) - target|^2, by the
/// Gauss-Newton method from `start`. Steps lead along screws, which turn a body without distorting
/// it, so that its place is found at any cost of position. `solver` factors the metric in each
/// iteration and keeps the last factor. `check_cancelled` is called before every iteration, and may
/// throw.
/// \throw SolverError if the metric is not definite at a shape on the way.
NearestShape FindNearestShape(const FeatureMap& map, const Eigen::VectorXd& target,
                              const Shape& start, const NearestShapeOptions& options,
                              const std::function<void()>& check_cancelled, MetricSolver* solver);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_EXPONENTIAL_INTERNAL_NEAREST_SHAPE_H_
