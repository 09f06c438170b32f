#include <shapespace/geodesic/internal/align_folds.h>

#include <shapespace/geodesic/internal/turning_motion.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/numerics/internal/triangle_pose.h>

namespace shapespace::internal {
namespace {

// An orientation is nearly as good if the mean square distance of the vertices is not greater than
// the least by more than this factor.
constexpr double kNearlyAsGood = 1.1;

// The rotation of `last` after which triangles turn by zero in the mean.
Eigen::Matrix3d TurnBack(const Connectivity& connectivity, const Shape& first, const Shape& last) {
  const Turns turns = FindTurns(connectivity, first, last);
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  double area = 0;
  for (int f = 0; f < connectivity.NumTriangles(); ++f) {
    const double own = TriangleArea(first, connectivity.Triangles().col(f)) +
                       TriangleArea(last, connectivity.Triangles().col(f));
    sum += own * turns.of_triangles.col(f);
    area += own;
  }
  return (Exp(Eigen::Vector3d(-sum / area)) * turns.whole.conjugate()).toRotationMatrix();
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
      const Eigen::Matrix3d back = TurnBack(*metric.connectivity, before, shape);
      const Shape other = back * shape;
      if (Distance(metric, before, other) <= kNearlyAsGood * Distance(metric, before, shape)) {
        shape = other;
        turned = back * turned;
      }
    }
    poses.shapes[i] = shape;
    poses.motions[i].rotation *= turned.transpose();
  }
  return poses;
}

}  // namespace shapespace::internal
