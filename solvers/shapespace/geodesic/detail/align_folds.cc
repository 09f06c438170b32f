#include <shapespace/geodesic/detail/align_folds.h>

#include <shapespace/geodesic/detail/turning_motion.h>
#include <shapespace/mesh/rigid_motion.h>

namespace shapespace::internal {
namespace {

// An orientation is nearly as good if the mean square distance of the vertices is not greater than
// the least by more than this factor.
constexpr double kNearlyAsGood = 1.1;

// The rotation that aligns `last` with the shape half-way, which is aligned with `first`.
Eigen::Matrix3d ByWayOfHalf(const Metric& metric, const Shape& first, const Shape& last) {
  const Shape half = TurningMotion(*metric.connectivity, first, last).At(0.5);
  const Shape aligned = FitRigidMotion(half, first, metric.vertex_area)(half);
  return FitRigidMotion(last, aligned, metric.vertex_area).rotation;
}

double Distance(const Metric& metric, const Shape& a, const Shape& b) {
  return (b - a).colwise().squaredNorm().dot(metric.vertex_area);
}

}  // namespace

AlignedPoses AlignFolds(const Metric& metric, AlignedPoses poses) {
  Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
  for (size_t i = 1; i < poses.shapes.size(); ++i) {
    const Shape& before = poses.shapes[i - 1];
    Shape shape = turned * poses.shapes[i];
    if (HasFolds(*metric.connectivity, before, shape)) {
      const Eigen::Matrix3d by_half = ByWayOfHalf(metric, before, shape);
      const Shape other = by_half * shape;
      if (Distance(metric, before, other) <= kNearlyAsGood * Distance(metric, before, shape)) {
        shape = other;
        turned = by_half * turned;
      }
    }
    poses.shapes[i] = shape;
    poses.motions[i].rotation *= turned.transpose();
  }
  return poses;
}

}  // namespace shapespace::internal
