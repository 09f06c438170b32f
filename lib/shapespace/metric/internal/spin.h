#ifndef SHAPESPACE_METRIC_INTERNAL_SPIN_H_
#define SHAPESPACE_METRIC_INTERNAL_SPIN_H_

#include <shapespace/mesh/shape.h>
#include <shapespace/metric/rigid.h>

namespace shapespace::internal {

/// The angular velocity c of a centred shape's rotation that is nearest to a displacement: the
/// minimum of sum_v w_v |displacement_v - c x shape_v|^2.
inline Eigen::Vector3d SpinOf(const Shape& shape, const Eigen::VectorXd& weights,
                              const Tangent& displacement) {
  Eigen::Matrix3d inertia = Eigen::Matrix3d::Zero();
  Eigen::Vector3d moment = Eigen::Vector3d::Zero();
  for (Eigen::Index v = 0; v < shape.cols(); ++v) {
    const Eigen::Vector3d x = shape.col(v);
    inertia += weights(v) * (x.squaredNorm() * Eigen::Matrix3d::Identity() - x * x.transpose());
    moment += weights(v) * x.cross(displacement.col(v));
  }
  return AngularVelocity(inertia, moment);
}

/// Takes the rotation with this angular velocity out of a displacement.
inline void RemoveSpin(const Shape& shape, const Eigen::Vector3d& spin, Tangent* displacement) {
  for (Eigen::Index v = 0; v < shape.cols(); ++v) displacement->col(v) -= spin.cross(shape.col(v));
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_METRIC_INTERNAL_SPIN_H_
