#include <shapespace/output/skinned_path.h>

#include <cmath>
#include <cstddef>

#include <shapespace/base/error.h>

namespace shapespace {
namespace {

// How far the sum of a vertex's weights may be from 1: far more than rounding errors of double
// precision, and less than those of the bytes into which they may have been rounded by others.
constexpr double kWeightSum = 1e-6;

void CheckSkinned(bool fits, const std::string& problem) {
  if (!fits) throw MeshError("the skinned path is not valid: " + problem);
}

void CheckJoints(const SkinnedPath& path) {
  CheckSkinned(!path.joints.empty(), "it has no joint");
  for (int b = 0; b < path.NumJoints(); ++b) {
    const Joint& joint = path.joints[b];
    const std::string name = "joint " + std::to_string(b);
    CheckSkinned(b == 0 ? joint.parent == -1 : joint.parent >= 0 && joint.parent < b,
                 name + " is not listed after its parent");
    CheckSkinned(joint.pivot.allFinite() && joint.axes.allFinite(), name + " is not finite");
  }
  CheckSkinned(path.motions.size() == path.joints.size() * path.parameters.size(),
               "there is not one motion for each joint in each shape");
  for (size_t i = 0; i < path.motions.size(); ++i) {
    const JointMotion& motion = path.motions[i];
    CheckSkinned(
        motion.rotation.allFinite() && motion.scale.allFinite() && motion.place.allFinite(),
        "the motion of joint " + std::to_string(i % path.joints.size()) + " in shape " +
            std::to_string(i / path.joints.size()) + " is not finite");
  }
}

bool HasBoneTwice(const SkinnedPath& path, Eigen::Index v) {
  for (Eigen::Index k = 0; k < path.weights.rows(); ++k) {
    for (Eigen::Index l = 0; l < k; ++l) {
      const bool both = path.weights(k, v) > 0 && path.weights(l, v) > 0;
      if (both && path.bones(k, v) == path.bones(l, v)) return true;
    }
  }
  return false;
}

void CheckWeights(const SkinnedPath& path) {
  const Eigen::Index vertices = path.connectivity->NumVertices();
  CheckSkinned(path.bones.cols() == vertices && path.weights.cols() == vertices &&
                   path.bones.rows() == path.weights.rows() && path.weights.rows() > 0,
               "there are not as many weights as vertices, or not as many bones as weights");
  for (Eigen::Index v = 0; v < vertices; ++v) {
    const auto bones = path.bones.col(v);
    const auto weights = path.weights.col(v);
    CheckSkinned(bones.minCoeff() >= 0 && bones.maxCoeff() < path.NumJoints() &&
                     (weights.array() >= 0).all() && std::abs(weights.sum() - 1) <= kWeightSum,
                 "the weights of vertex " + std::to_string(v) +
                     " are negative, do not have sum 1, or belong to no joint");
    CheckSkinned(!HasBoneTwice(path, v), "vertex " + std::to_string(v) + " has a bone twice");
  }
}

}  // namespace

Eigen::Matrix<double, 3, 4> JointMotion::Matrix(const Joint& joint) const {
  Eigen::Matrix<double, 3, 4> matrix;
  matrix.leftCols<3>() = rotation * joint.axes * scale.asDiagonal() * joint.axes.transpose();
  matrix.col(3) = place - matrix.leftCols<3>() * joint.pivot;
  return matrix;
}

void SkinnedPath::Validate() const {
  CheckSkinned(connectivity != nullptr && rest.cols() == connectivity->NumVertices(),
               "its rest pose does not have the connectivity's vertices");
  CheckSkinned(rest.allFinite(), "its rest pose is not finite");
  CheckSkinned(!parameters.empty(), "it has no shape");
  for (size_t i = 0; i < parameters.size(); ++i) {
    CheckSkinned(std::isfinite(parameters[i]) && (i == 0 || parameters[i] > parameters[i - 1]),
                 "its parameters do not ascend");
  }
  CheckJoints(*this);
  CheckWeights(*this);
}

Shape SkinnedPath::Skinned(int i) const {
  Shape shape = Shape::Zero(3, rest.cols());
  std::vector<Eigen::Matrix3d> linear;
  linear.reserve(joints.size());
  for (size_t b = 0; b < joints.size(); ++b) {
    const JointMotion& motion = motions[i * joints.size() + b];
    linear.push_back(motion.Matrix(joints[b]).leftCols<3>());
  }
  for (Eigen::Index v = 0; v < rest.cols(); ++v) {
    for (Eigen::Index k = 0; k < weights.rows(); ++k) {
      if (weights(k, v) == 0) continue;
      const int b = bones(k, v);
      // Relative to the pivot, so that it is accurate far from the origin.
      shape.col(v) += weights(k, v) * (linear[b] * (rest.col(v) - joints[b].pivot) +
                                       motions[i * joints.size() + b].place);
    }
  }
  return shape;
}

}  // namespace shapespace
