#ifndef SHAPESPACE_OUTPUT_DETAIL_JOINT_TRACKS_H_
#define SHAPESPACE_OUTPUT_DETAIL_JOINT_TRACKS_H_

#include <utility>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <shapespace/output/skinned_path.h>

namespace shapespace::internal {

/// The place of a joint relative to its parent's, as nodes of glTF have it, and the scale of its
/// bone.
struct JointPose {
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();
  Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
};

/// The rest pose of a joint; of the root, relative to `origin`.
JointPose RestPoseOf(const SkinnedPath& path, int joint, const Eigen::Vector3d& origin);

/// The poses of a joint at `points`, parameters of the path in any order within its range: linear
/// between shapes, and rotations at constant speed. Consecutive rotations have quaternions of
/// positive product, so that players, which interpolate them, take the shorter way.
std::vector<JointPose> PosesAt(const SkinnedPath& path, int joint, const Eigen::Vector3d& origin,
                               const std::vector<double>& points);

/// Indices of keys without which linear interpolation over `times` would be off by more than
/// `tolerance` at another one: the first and the last, and of the others as few as a greedy choice
/// leaves. `off(first, key, last)` is how far the interpolation between two keys is off at a third.
///
template <typename Off>
std::vector<int> ThinnedKeys(int count, double tolerance, const Off& off) {
  std::vector<int> kept = {0};
  const auto suffices = [&](int first, int last) {
    for (int key = first + 1; key < last; ++key) {
      if (!(off(first, key, last) <= tolerance)) return false;
    }
    return true;
  };
  while (kept.back() < count - 1) {
    int next = kept.back() + 1;
    while (next + 1 < count && suffices(kept.back(), next + 1)) ++next;
    kept.push_back(next);
  }
  return kept;
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_JOINT_TRACKS_H_
