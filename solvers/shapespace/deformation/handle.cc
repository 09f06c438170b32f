#include <shapespace/deformation/handle.h>

#include <Eigen/Geometry>

namespace shapespace {

Eigen::Vector3d ScrewMotion::At(double t, const Eigen::Vector3d& x) const {
  const Eigen::AngleAxisd turn(t * angle, axis.stableNormalized());
  return point + t * translation + turn * (x - point);
}

Eigen::Vector3d DeformationHandle::Target(int place, double t, const Eigen::Vector3d& from) const {
  if (!positions) return motion.At(t, from);
  return (1 - t) * from + t * positions->col(place);
}

}  // namespace shapespace
