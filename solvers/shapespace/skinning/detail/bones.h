#ifndef SHAPESPACE_SKINNING_DETAIL_BONES_H_
#define SHAPESPACE_SKINNING_DETAIL_BONES_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/output/skinned_path.h>
#include <shapespace/skinning/detail/moving_points.h>

namespace shapespace::internal {

/// Bones without a hierarchy, and what they do in every shape, in the frame of `MovingPoints`.
struct Bones {
  int shapes = 0;
  std::vector<Joint> joints;  ///< pivots and axes alone are used; a pivot is the bone's centroid
  std::vector<JointMotion> motions;  ///< of bone b in shape i: motions[b * shapes + i]
  Eigen::MatrixXd matrices;          ///< 3 s x 4 b: of bone b in shape i at (3 i, 4 b)

  int Count() const { return static_cast<int>(joints.size()); }
  auto MatricesOf(int bone) const { return matrices.middleCols<4>(4 * bone); }

  /// Appends a bone that does not move.
  void Append();
  /// Sets the matrices of a bone from its joint and motions.
  void UpdateMatrices(int bone);
  /// Keeps the bones of these numbers, in this order.
  void Select(const std::vector<int>& kept);
  /// Keeps those that are used, in their order. Returns the new number of each; 0 for the others.
  std::vector<int> Keep(const std::vector<char>& is_used);
};

/// Makes a bone move as the points of `part` do, by the rigid motion that is the nearest in the
/// least-squares sense in every shape (Procrustes), about their centroid. There must be a point.
void FitBone(const MovingPoints& points, const std::vector<int>& part, int bone, Bones* bones);

/// Describes the motions of a bone by another pivot, without changing them; in the rest pose it is
/// where it is.
void MovePivot(const Eigen::Vector3d& pivot, int bone, int rest, Bones* bones);

/// Gives each bone the principal axes of its part, the points for which `bone_of` has its number.
void SetPrincipalAxes(const MovingPoints& points, const std::vector<int>& bone_of, Bones* bones);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SKINNING_DETAIL_BONES_H_
