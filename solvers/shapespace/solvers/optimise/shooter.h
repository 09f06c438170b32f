#ifndef SHAPESPACE_SOLVERS_OPTIMISE_SHOOTER_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_SHOOTER_H_

#include <functional>
#include <memory>
#include <optional>
#include <vector>

#include <shapespace/hierarchy/hierarchy.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/solvers/exponential.h>
#include <shapespace/solvers/optimise/metric_solver.h>
#include <shapespace/solvers/optimise/step.h>

namespace shapespace::internal {

/// The variational integrator on a mesh and, where that has no root, on coarser ones.
///
/// Between real poses some edges shrink manyfold and some triangles nearly collapse. Going on at
/// constant speed would give them lengths that no triangle has: the step's equation then has no
/// root, for the sake of a few triangles out of thousands. Decimated meshes have good triangles in
/// all poses. So the step is made on the next coarser mesh, and its detail carried along (Kilian et
/// al. 2007, Figure 4), each neighbourhood turning as the coarse mesh under it does. That serves as
/// a better start; where even from there no root is found, as the answer.
class Shooter {
 public:
  /// `known` are shapes of `metric`'s mesh, in its unit: what is decimated. `check_cancelled` is
  /// called every now and then while a step is made, and may throw to end it.
  Shooter(std::shared_ptr<const Metric> metric, std::vector<Shape> known,
          const ExponentialOptions& options, std::function<void()> check_cancelled);

  /// The shape after the departure. \throw SolverError if no resolution has an answer.
  Shape Next(const Departure& departure, ExponentialSummary::Step* row);

  int NumFactorisations() const;
  double FactorSeconds() const;

 private:
  struct Level {
    explicit Level(std::shared_ptr<const Metric> own) : metric(std::move(own)), map(metric) {}
    std::shared_ptr<const Metric> metric;
    FeatureMap map;
    MetricSolver solver;
  };

  Shape NextOn(int level, const Departure& departure, ExponentialSummary::Step* row);
  void Decimate();

  const ExponentialOptions options_;
  const std::function<void()> check_cancelled_;
  std::vector<Shape> known_;
  std::optional<Hierarchy> hierarchy_;          // once it is needed
  std::vector<std::unique_ptr<Level>> levels_;  // the finest last
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_SHOOTER_H_
