#ifndef SHAPESPACE_SOLVERS_OPTIMISE_FEATURE_TRANSFER_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_FEATURE_TRANSFER_H_

#include <functional>
#include <memory>

#include <Eigen/Core>

#include <shapespace/mesh/shape.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/metric/metric.h>
#include <shapespace/solvers/optimise/gradient_transfer.h>
#include <shapespace/solvers/optimise/metric_solver.h>
#include <shapespace/solvers/optimise/nearest_shape.h>

namespace shapespace::internal {

/// Deformation transfer in feature space (docs/mathematics.md, section 11). The features of source
/// and target belong to the same elements, and their space is flat: what is carried over is the
/// source's change of them as it is. Positions are those of `GradientTransfer`, where the search
/// for the shape begins too. Every shape is found on its own.
class FeatureTransfer {
 public:
  /// `source` and `target` as for `GradientTransfer`, in the metric's unit.
  FeatureTransfer(std::shared_ptr<const Metric> metric, const Shape& source, const Shape& target);

  /// What the target becomes as the source becomes `deformed`. `tolerance` is a share of the
  /// squared change of all features but positions. \throw SolverError if the metric is not
  /// definite.
  NearestShape operator()(const Shape& deformed, double tolerance, int max_iterations,
                          const std::function<void()>& check_cancelled);

 private:
  // What the target's features should become.
  Eigen::VectorXd Wanted(const Shape& deformed, const Shape& placed) const;

  const std::shared_ptr<const Metric> metric_;
  const FeatureMap map_;
  const Eigen::VectorXd source_, target_;  // Phi
  const GradientTransfer gradients_;
  MetricSolver solver_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_FEATURE_TRANSFER_H_
