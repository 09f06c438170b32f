#include <shapespace/solvers/handle.h>

#include <Eigen/Geometry>

namespace shapespace {

Eigen::Vector3d ScrewMotion::At(double t, const Eigen::Vector3d& x) const {
  return point + t * translation + Eigen::AngleAxisd(t * angle, axis.normalized()) * (x - point);
}

}  // namespace shapespace
