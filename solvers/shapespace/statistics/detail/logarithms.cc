#include <shapespace/statistics/detail/logarithms.h>

#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/metric/rigid.h>

namespace shapespace::internal {

void RemoveRigidPart(const Shape& shape, const Eigen::VectorXd& vertex_area,
                     Tangent* displacement) {
  displacement->colwise() -= Centroid(*displacement, vertex_area);
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (Eigen::Index v = 0; v < shape.cols(); ++v) {
    const Eigen::Vector3d x = shape.col(v);
    inertia += vertex_area(v) * (x.squaredNorm() * Eigen::Matrix3d::Identity() - x * x.transpose());
    moment += vertex_area(v) * x.cross(displacement->col(v));
  }
  const Eigen::Vector3d turn = AngularVelocity(inertia, moment);
  for (Eigen::Index v = 0; v < shape.cols(); ++v) {
    displacement->col(v) -= turn.cross(shape.col(v));
  }
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
