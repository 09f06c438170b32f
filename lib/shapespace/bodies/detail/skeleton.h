#ifndef SHAPESPACE_BODIES_DETAIL_SKELETON_H_
#define SHAPESPACE_BODIES_DETAIL_SKELETON_H_

#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/bodies/detail/implicit.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// A part of the body that moves separately from its neighbourhood, such as a leg.
struct Limb {
  double reach = 0;  ///< distance from it up to which the skin follows it
  int side = 0;      ///< 1: y > 0, -1: y < 0; a limb does not move the other side's skin
};

/// A bone and the joint at its beginning. At rest all rotations are zero.
struct Bone {
  std::string name;
  int parent = -1;  ///< a bone listed earlier; -1 for the first
  Eigen::Vector3d begin, end;
  double reach = 0;  ///< the joint bends the skin from this distance before it to this distance
                     ///< behind it
  int limb = -1;     ///< index into the limbs; -1: the trunk
  double length_scale = 1, girth_scale = 1;
};

/// One bone's part of a body.
struct Flesh {
  int bone;
  RoundCone cone;
};

struct Skeleton {
  std::vector<Bone> bones;
  std::vector<Limb> limbs;
  std::vector<Flesh> flesh;

  /// \throw InvalidOptions if no bone has that name.
  int Find(const std::string& name) const;

  std::vector<RoundCone> Cones() const;
};

/// A rotation vector (axis times angle, in radians) for every bone, about its beginning, in the
/// axes of the body at rest; the bones attached to it rotate with it.
using Rotations = std::vector<Eigen::Vector3d>;

/// A skin with bones, in any pose.
///
/// Every joint has a smooth mask on the skin, 0 before it and 1 behind it, and rotates a point by
/// its angle times the mask; joints act in order from the tips of the limbs to the trunk. Since
/// rotations are not averaged, the skin does not collapse: a joint's region is free of folds while
/// its angle times 15/16 of the radius is less than half the region's width.
class Skin {
 public:
  /// `points` are the skin at rest, before the bones' scales are applied, which stretch every
  /// bone's neighbourhood along and across the bone.
  Skin(Skeleton skeleton, const Eigen::Matrix3Xd& points);

  /// The skin with these rotations, translated vertically so that its lowest point has z = 0.
  Shape Pose(const Rotations& rotations) const;

 private:
  Skeleton skeleton_;
  Eigen::MatrixXd masks_;    // bones x points
  Shape rest_;               // scaled, not posed
  Eigen::Matrix3Xd begins_;  // the scaled bones' joints
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BODIES_DETAIL_SKELETON_H_
