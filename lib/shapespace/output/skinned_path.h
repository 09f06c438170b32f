#ifndef SHAPESPACE_OUTPUT_SKINNED_PATH_H_
#define SHAPESPACE_OUTPUT_SKINNED_PATH_H_

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/appearance.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// A joint of a skeleton and the bone that begins there, in the rest pose.
struct Joint {
  std::string name;
  int parent = -1;  ///< a joint listed earlier; -1 for the root, which is the first
  Eigen::Vector3d pivot = Eigen::Vector3d::Zero();     ///< its place, in the user's frame
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();  ///< a rotation; its columns are the axes
                                                       ///< along which the bone is scaled
};

/// What one bone does to points x of the rest pose, in one shape:
/// x -> rotation axes diag(scale) axes^T (x - pivot) + place, with its joint's axes and pivot.
struct JointMotion {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d scale = Eigen::Vector3d::Ones();
  Eigen::Vector3d place = Eigen::Vector3d::Zero();  ///< where the pivot is

  /// The columns of the linear part, and as the last one the translation.
  Eigen::Matrix<double, 3, 4> Matrix(const Joint& joint) const;
};

/// A motion given by bones: in every shape, a vertex lies at the mean of the places to which its
/// bones move its rest position, weighted by its weights (linear blend skinning).
struct SkinnedPath {
  std::shared_ptr<const Connectivity> connectivity;
  Shape rest;                        ///< the rest pose, 3 x m, in the user's frame and unit
  std::vector<double> parameters;    ///< one per shape, ascending, those of the path it was made of
  std::vector<Joint> joints;         ///< parents before their children
  std::vector<JointMotion> motions;  ///< of joint b in shape i: motions[i * joints.size() + b]

  /// k x m: the bones that move each vertex, and their weights, in descending order. Weights are
  /// not negative and have sum 1, no bone is there twice, and entries that are not needed have
  /// weight 0 and bone 0.
  Eigen::MatrixXi bones;
  Eigen::MatrixXd weights;

  std::string provenance;  ///< the program and the inputs from which it was made
  Appearance appearance;   ///< of the connectivity's polygons: for outputs

  int NumJoints() const { return static_cast<int>(joints.size()); }
  int NumShapes() const { return static_cast<int>(parameters.size()); }

  /// \throw MeshError if there is no joint or no shape, sizes do not fit together, parameters do
  ///        not ascend, a joint comes before its parent, weights are negative or do not have sum 1,
  ///        a vertex has a bone twice, or a number is not finite.
  void Validate() const;

  /// Shape i as the bones make it, in the user's frame and unit.
  Shape Skinned(int i) const;
};

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_SKINNED_PATH_H_
