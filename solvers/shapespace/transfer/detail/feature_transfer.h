#ifndef SHAPESPACE_TRANSFER_DETAIL_FEATURE_TRANSFER_H_
#define SHAPESPACE_TRANSFER_DETAIL_FEATURE_TRANSFER_H_

#include <functional>
#include <memory>

#include <Eigen/Core>

#include <shapespace/exponential/internal/metric_solver.h>
#include <shapespace/exponential/internal/nearest_shape.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/metric/metric.h>
#include <shapespace/transfer/detail/gradient_transfer.h>

namespace shapespace::internal {

/// Deformation transfer in feature space (docs/mathematics.md, section 11). The features of source
/// and target belong to the same elements, and feature space is a vector space: the change of the
/// source's features is added to the target's. Positions and the initial guess are those of
/// `GradientTransfer`. Shapes are found independently of each other.
class FeatureTransfer {
 public:
  /// `source` and `target` as for `GradientTransfer`, in the metric's unit.
  FeatureTransfer(std::shared_ptr<const Metric> metric, const Shape& source, const Shape& target);

  /// The target's shape that corresponds to the source's shape `deformed`. `tolerance` is a share
  /// of the squared change of all features except positions.
  /// \throw SolverError if the metric is not definite.
  NearestShape operator()(const Shape& deformed, double tolerance, int max_iterations,
                          const std::function<void()>& check_cancelled);

 private:
  // The features that the target should have.
  Eigen::VectorXd Wanted(const Shape& deformed, const Shape& placed) const;

  const std::shared_ptr<const Metric> metric_;
  const FeatureMap map_;
  const Eigen::VectorXd source_, target_;  // Phi
  const GradientTransfer gradients_;
  MetricSolver solver_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_TRANSFER_DETAIL_FEATURE_TRANSFER_H_
