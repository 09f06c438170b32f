#ifndef SHAPESPACE_STATISTICS_DETAIL_LOGARITHMS_H_
#define SHAPESPACE_STATISTICS_DETAIL_LOGARITHMS_H_

#include <memory>

#include <Eigen/Core>

#include <shapespace/exponential/internal/metric_solver.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/feature_map.h>
#include <shapespace/statistics/detail/feature_chart.h>

namespace shapespace::internal {

/// Takes the rigid motions out of a displacement of a centred shape, in the area-weighted L2
/// product.
void RemoveRigidPart(const Shape& shape, const Eigen::VectorXd& vertex_area, Tangent* displacement);

/// The displacements of a shape that change its features, to first order, as wanted: flat
/// logarithms, of which one factor of the metric serves all.
class Logarithms {
 public:
  /// `chart` is kept by reference. \throw SolverError if the metric is not definite at `shape`.
  Logarithms(const FeatureMap& map, const FeatureChart& chart, const Shape& shape);

  /// G^-1 J^T of relative features (`FeatureChart::Log`), without rigid motion.
  Tangent Of(const Eigen::VectorXd& relative) const;

 private:
  const FeatureChart& chart_;
  const Shape shape_;
  const Eigen::VectorXd values_, vertex_area_;
  const std::shared_ptr<const Connectivity> connectivity_;
  const FeatureDerivative derivative_;
  MetricSolver solver_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_STATISTICS_DETAIL_LOGARITHMS_H_
