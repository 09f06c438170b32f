#include <shapespace/output/detail/joint_tracks.h>

#include <algorithm>

namespace shapespace::internal {
namespace {

// A joint relative to its parent, or to `origin` without rotation, from their axes and places.
// `motions` are those of all joints in one shape.
JointPose Relative(const SkinnedPath& path, int joint, const Eigen::Vector3d& origin,
                   const JointMotion* motions) {
  const auto frame = [&](int b) -> Eigen::Matrix3d {
    return motions[b].rotation * path.joints[b].axes;
  };
  const int parent = path.joints[joint].parent;
  JointPose pose;
  if (parent < 0) {
    pose.rotation = Eigen::Quaterniond(frame(joint));
    pose.translation = motions[joint].place - origin;
  } else {
    const Eigen::Matrix3d back = frame(parent).transpose();
    pose.rotation = Eigen::Quaterniond((back * frame(joint)).eval());
    pose.translation = back * (motions[joint].place - motions[parent].place);
  }
  pose.rotation.normalize();
  pose.scale = motions[joint].scale;
  return pose;
}

JointPose Between(const JointPose& first, const JointPose& last, double part) {
  JointPose pose;
  pose.translation = first.translation + part * (last.translation - first.translation);
  pose.rotation = first.rotation.slerp(part, last.rotation);
  pose.scale = first.scale + part * (last.scale - first.scale);
  return pose;
}

}  // namespace

JointPose RestPoseOf(const SkinnedPath& path, int joint, const Eigen::Vector3d& origin) {
  std::vector<JointMotion> motions(path.joints.size());
  for (size_t b = 0; b < motions.size(); ++b) motions[b].place = path.joints[b].pivot;
  return Relative(path, joint, origin, motions.data());
}

std::vector<JointPose> PosesAt(const SkinnedPath& path, int joint, const Eigen::Vector3d& origin,
                               const std::vector<double>& points) {
  const size_t joints = path.joints.size();
  std::vector<JointPose> of_shapes;
  for (int i = 0; i < path.NumShapes(); ++i) {
    of_shapes.push_back(Relative(path, joint, origin, &path.motions[i * joints]));
  }
  const std::vector<double>& parameters = path.parameters;
  std::vector<JointPose> poses;
  for (const double point : points) {
    const auto after = std::lower_bound(parameters.begin(), parameters.end(), point);
    const size_t next = std::min<size_t>(after - parameters.begin(), parameters.size() - 1);
    if (next == 0 || parameters[next] <= point) {
      poses.push_back(of_shapes[next]);
    } else {
      const double part =
          (point - parameters[next - 1]) / (parameters[next] - parameters[next - 1]);
      poses.push_back(Between(of_shapes[next - 1], of_shapes[next], part));
    }
    if (poses.size() > 1 && poses.back().rotation.dot(poses[poses.size() - 2].rotation) < 0) {
      poses.back().rotation.coeffs() = -poses.back().rotation.coeffs();
    }
  }
  return poses;
}

}  // namespace shapespace::internal
