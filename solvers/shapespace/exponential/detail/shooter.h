#ifndef SHAPESPACE_EXPONENTIAL_DETAIL_SHOOTER_H_
#define SHAPESPACE_EXPONENTIAL_DETAIL_SHOOTER_H_

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <shapespace/exponential/exponential.h>
#include <shapespace/exponential/internal/metric_solver.h>
#include <shapespace/exponential/internal/step.h>
#include <shapespace/hierarchy/hierarchy.h>
#include <shapespace/metric/feature_map.h>

namespace shapespace::internal {

/// The variational integrator on a mesh and, where the step has no root on it, on coarser meshes.
///
/// Between real poses some edges shrink by large factors and some triangles nearly collapse. If
/// they continued at constant speed, their edges would violate the triangle inequality; then the
/// step's equation has no root because of a few triangles out of thousands. Decimated meshes have
/// well-shaped triangles in all poses. So the step is solved on the next coarser mesh and lifted
/// with detail (Kilian et al. 2007, Figure 4), which rotates with the coarse mesh. The result is
/// used as a better initial guess; if there is still no root, it is used as the result of the step.
class Shooter {
 public:
  /// `known` are shapes of `metric`'s mesh, in its unit, that are decimated together.
  /// `check_cancelled` is called regularly during a step, and may throw to end it.
  Shooter(std::shared_ptr<const Metric> metric, std::vector<Shape> known,
          const ExponentialOptions& options, std::function<void()> check_cancelled);

  /// The shape after the initial state.
  /// \throw SolverError if there is no solution on any resolution.
  Shape Next(const InitialState& initial_state, ExponentialSummary::Step* row);

  /// The state from which a geodesic of this `speed` goes on after a `shape` that was not solved on
  /// the mesh itself. Its lifted detail did not move as on a geodesic; used as a momentum, this
  /// motion would grow from step to step. Therefore only the projection of the change since
  /// `before` onto the velocities at the new shape is kept, scaled to the speed.
  InitialState Restart(const Shape& before, const Shape& shape, double speed);

  int NumFactorisations() const;
  double FactorSeconds() const;

 private:
  struct Level {
    explicit Level(std::shared_ptr<const Metric> own) : metric(std::move(own)), map(metric) {}
    std::shared_ptr<const Metric> metric;
    FeatureMap map;
    MetricSolver solver;
  };

  Shape NextOn(int level, const InitialState& initial_state, ExponentialSummary::Step* row);
  void Decimate();

  const ExponentialOptions options_;
  const std::function<void()> check_cancelled_;
  std::vector<Shape> known_;
  std::optional<Hierarchy> hierarchy_;          // computed when first needed
  std::vector<std::unique_ptr<Level>> levels_;  // the finest last
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_EXPONENTIAL_DETAIL_SHOOTER_H_
