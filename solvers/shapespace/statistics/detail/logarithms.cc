#include <shapespace/statistics/detail/logarithms.h>

#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/metric/internal/spin.h>

namespace shapespace::internal {

void RemoveRigidPart(const Shape& shape, const Eigen::VectorXd& vertex_area,
                     Tangent* displacement) {
  displacement->colwise() -= Centroid(*displacement, vertex_area);
  RemoveSpin(shape, SpinOf(shape, vertex_area, *displacement), displacement);
}

Logarithms::Logarithms(const FeatureMap& map, const FeatureChart& chart, const Shape& shape)
    : chart_(chart),
      shape_(shape),
      values_(map.Values(shape)),
      vertex_area_(map.GetMetric().vertex_area),
      connectivity_(map.GetMetric().connectivity),
      derivative_(map.Derivative(shape)) {
  solver_.Factor(derivative_);
  solver_.UseDoublePrecision();
}

Tangent Logarithms::Of(const Eigen::VectorXd& relative) const {
  Tangent displacement =
      solver_.Approximate(derivative_.TransposeTimes(chart_.ChangeAt(values_, relative)));
  RemoveRigidPart(shape_, vertex_area_, &displacement);
  connectivity_->CopyToTwins(&displacement);
  return displacement;
}

}  // namespace shapespace::internal
