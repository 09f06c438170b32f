#include <shapespace/bodies/detail/skeleton.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace::internal {
namespace {

/// Half of the width of the strip about the plane of symmetry in which the skin follows the limbs
/// of both sides.
constexpr double kMiddle = 0.06;

Eigen::Vector3d Direction(const Bone& bone) { return (bone.end - bone.begin).normalized(); }

/// Normal of the plane that separates the points before a joint from those behind it.
Eigen::Vector3d JointNormal(const Skeleton& skeleton, const Bone& bone) {
  const Bone& parent = skeleton.bones[bone.parent];
  // A limb's first bone is attached to the trunk, whose direction is unrelated to the limb's.
  if (bone.limb != parent.limb) return Direction(bone);
  return (Direction(bone) + Direction(parent)).normalized();
}

/// Per bone, the share of the point that is behind its joint.
Eigen::VectorXd Masks(const Skeleton& skeleton, const std::vector<std::vector<RoundCone>>& limbs,
                      const Eigen::Vector3d& point) {
  std::vector<double> near_limb;
  for (size_t i = 0; i < limbs.size(); ++i) {
    const Limb& limb = skeleton.limbs[i];
    const double away = std::max(0.0, Evaluate(limbs[i], point).value) / limb.reach;
    const double own_side =
        limb.side == 0 ? 1 : SmoothStep(0.5 + limb.side * point.y() / (2 * kMiddle));
    near_limb.push_back((1 - SmoothStep(away)) * own_side);
  }
  Eigen::VectorXd masks = Eigen::VectorXd::Ones(skeleton.bones.size());
  for (size_t j = 1; j < skeleton.bones.size(); ++j) {
    const Bone& bone = skeleton.bones[j];
    const double along = JointNormal(skeleton, bone).dot(point - bone.begin);
    masks(j) = SmoothStep(0.5 + along / (2 * bone.reach));
    if (bone.limb >= 0) masks(j) *= near_limb[bone.limb];
  }
  return masks;
}

/// The weights of all bones at a point, with sum 1: behind a joint its bone replaces the parent.
Eigen::VectorXd Shares(const Skeleton& skeleton, const Eigen::VectorXd& masks) {
  Eigen::VectorXd reached = masks, shares = masks;
  for (int j = 1; j < masks.size(); ++j) {
    reached(j) *= reached(skeleton.bones[j].parent);
    shares(j) = reached(j);
  }
  for (int j = 1; j < masks.size(); ++j) shares(skeleton.bones[j].parent) *= 1 - masks(j);
  return shares / shares.sum();
}

/// Applies a bone's scales to a vector in its neighbourhood.
Eigen::Vector3d Scaled(const Bone& bone, const Eigen::Vector3d& vector) {
  const Eigen::Vector3d direction = Direction(bone);
  return bone.girth_scale * vector +
         (bone.length_scale - bone.girth_scale) * direction.dot(vector) * direction;
}

Eigen::Matrix3d PartialTurn(const Eigen::Vector3d& rotation, double part) {
  const double angle = rotation.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(part * angle, rotation / angle).toRotationMatrix();
}

}  // namespace

int Skeleton::Find(const std::string& name) const {
  for (size_t j = 0; j < bones.size(); ++j) {
    if (bones[j].name == name) return static_cast<int>(j);
  }
  throw InvalidOptions("bone", "none is called '" + name + "'");
}

std::vector<RoundCone> Skeleton::Cones() const {
  std::vector<RoundCone> cones;
  for (const Flesh& part : flesh) cones.push_back(part.cone);
  return cones;
}

Skin::Skin(Skeleton skeleton, const Eigen::Matrix3Xd& points) : skeleton_(std::move(skeleton)) {
  const std::vector<Bone>& bones = skeleton_.bones;
  begins_.resize(3, bones.size());
  begins_.col(0) = bones[0].begin;
  for (size_t j = 1; j < bones.size(); ++j) {
    const int parent = bones[j].parent;
    begins_.col(j) =
        begins_.col(parent) + Scaled(bones[parent], bones[j].begin - bones[parent].begin);
  }
  const auto scaled_with = [&](int j, const Eigen::Vector3d& point) -> Eigen::Vector3d {
    return begins_.col(j) + Scaled(bones[j], point - bones[j].begin);
  };

  std::vector<std::vector<RoundCone>> limbs(skeleton_.limbs.size());
  for (const auto& [bone, cone] : skeleton_.flesh) {
    if (bones[bone].limb >= 0) limbs[bones[bone].limb].push_back(cone);
  }

  masks_.resize(bones.size(), points.cols());
  rest_.resize(3, points.cols());
  ParallelFor(static_cast<int>(points.cols()), [&](int v) {
    masks_.col(v) = Masks(skeleton_, limbs, points.col(v));
    const Eigen::VectorXd shares = Shares(skeleton_, masks_.col(v));
    rest_.col(v).setZero();
    for (int j = 0; j < shares.size(); ++j) {
      if (shares(j) > 0) rest_.col(v) += shares(j) * scaled_with(j, points.col(v));
    }
  });
}

Shape Skin::Pose(const Rotations& rotations) const {
  const std::vector<Bone>& bones = skeleton_.bones;
  // Joints are listed from the trunk to the tips; joints nearer to a tip are applied first.
  std::vector<int> turned;
  for (int j = static_cast<int>(bones.size()) - 1; j >= 0; --j) {
    if (rotations[j] != Eigen::Vector3d::Zero()) turned.push_back(j);
  }
  Shape shape(3, rest_.cols());
  ParallelFor(static_cast<int>(shape.cols()), [&](int v) {
    Eigen::Vector3d point = rest_.col(v);
    for (int j : turned) {
      if (masks_(j, v) == 0) continue;
      point = begins_.col(j) + PartialTurn(rotations[j], masks_(j, v)) * (point - begins_.col(j));
    }
    shape.col(v) = point;
  });
  shape.row(2).array() -= shape.row(2).minCoeff();
  return shape;
}

}  // namespace shapespace::internal
