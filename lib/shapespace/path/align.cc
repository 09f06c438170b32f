#include <shapespace/path/align.h>

#include <utility>

namespace shapespace {

AlignedPoses AlignPoses(const Metric& metric, const std::vector<Shape>& poses) {
  AlignedPoses aligned;
  for (const Shape& pose : poses) {
    const Eigen::Vector3d centre = Centroid(pose, metric.vertex_area);
    Shape shape = (pose.colwise() - centre) / metric.unit;
    RigidMotion motion;
    motion.translation = centre;
    if (!aligned.shapes.empty()) {
      const RigidMotion turn = FitRigidMotion(shape, aligned.shapes.back(), metric.vertex_area);
      shape = turn.rotation * shape;
      motion.rotation = turn.rotation.transpose();
    }
    metric.connectivity->CopyToTwins(&shape);
    aligned.shapes.push_back(std::move(shape));
    aligned.motions.push_back(motion);
  }
  return aligned;
}

}  // namespace shapespace
