#ifndef SHAPESPACE_DEFORMATION_DETAIL_HANDLE_TARGETS_H_
#define SHAPESPACE_DEFORMATION_DETAIL_HANDLE_TARGETS_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/deformation/detail/free_end_preconditioner.h>
#include <shapespace/deformation/handle.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// The constraints and penalties of a deformation's handles, per vertex. If handles share a vertex,
/// hard handles take precedence over soft ones, and between handles of one kind the target is the
/// (weighted) mean.
class HandleTargets {
 public:
  /// `rest` is the mesh to deform, in the user's unit; targets are relative to `origin`, in units
  /// of `unit`.
  /// \throw InvalidOptions naming the handle and the error in it.
  HandleTargets(const std::vector<DeformationHandle>& handles, const Shape& rest,
                const Eigen::Vector3d& origin, double unit);

  /// The vertices that belong to a handle, in ascending order.
  const std::vector<int>& Held() const { return held_; }
  /// Whether the position of Held()[i] is prescribed in all shapes, or in the last.
  bool IsCarried(size_t i) const { return hold_[i] == Hold::kPrescribed; }
  bool IsGiven(size_t i) const { return hold_[i] != Hold::kSoft; }
  /// Targets of these vertices at time t: 3 x Held(). For positions that are not prescribed at t,
  /// the target lies on the straight line or on the motion to the final target.
  Shape At(double t) const;

  /// The constraints on a mesh that has `vertices` (ascending) of this one, whose areas are
  /// `areas`. A soft handle is a penalty on the area-weighted mean squared distance, which is
  /// independent of its number of vertices; the penalties of several handles are averaged, so that
  /// the total is independent of their number: sum_p pull_p |p - target|^2 = strength * mean over
  /// soft handles of weight * mean squared distance.
  PositionConstraints Restrict(const std::vector<int>& vertices, const Eigen::VectorXd& areas,
                               double strength) const;

  /// The largest angle by which a handle turns, in radians.
  double GreatestTurn() const;

  /// Vertices of each handle that are far from each other and numerous enough to preserve its shape
  /// on a coarse mesh.
  std::vector<int> Pins() const;

  /// True if the same vertices are held in the same way, with whatever targets. The others may have
  /// more or fewer handles, as long as these hold no vertex by themselves.
  bool HoldAlike(const HandleTargets& other) const;
  /// For targets that hold alike: true if no angle differs by more than `most` radians, and no
  /// target half way or at the end by more than `most`.
  bool IsNear(const HandleTargets& other, double most) const;

 private:
  enum class Hold { kSoft, kPrescribedLast, kPrescribed };
  struct Part {  // of a handle that holds a vertex
    int handle, place;
    double weight;
  };

  Eigen::Vector3d Target(const Part& part, double t) const;

  std::vector<DeformationHandle> handles_;
  Shape rest_;  // in the user's unit
  Eigen::Vector3d origin_;
  double unit_;
  std::vector<int> held_;
  std::vector<Hold> hold_;                // per held vertex
  std::vector<std::vector<Part>> parts_;  // per held vertex
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_DEFORMATION_DETAIL_HANDLE_TARGETS_H_
