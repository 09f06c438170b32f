#ifndef SHAPESPACE_SOLVERS_OPTIMISE_HANDLE_TARGETS_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_HANDLE_TARGETS_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/shape.h>
#include <shapespace/solvers/handle.h>
#include <shapespace/solvers/optimise/free_end_preconditioner.h>

namespace shapespace::internal {

/// What the handles of a deformation ask for, vertex by vertex. Where handles share a vertex, hard
/// ones go before soft ones, and among equals the vertex is asked to be at the (weighted) mean of
/// their targets.
class HandleTargets {
 public:
  /// `rest` is the mesh to deform, in the user's unit; targets are in units of `unit`, seen from
  /// `origin`. \throw InvalidOptions naming the handle and what is wrong with it.
  HandleTargets(const std::vector<Handle>& handles, const Shape& rest,
                const Eigen::Vector3d& origin, double unit);

  /// The vertices that a handle holds, rising.
  const std::vector<int>& Held() const { return held_; }
  /// Whether the place of Held()[i] is given in all shapes, or in the last.
  bool IsCarried(size_t i) const { return hold_[i] == Hold::kCarried; }
  bool IsGiven(size_t i) const { return hold_[i] != Hold::kSoft; }
  /// Of each of these, where it shall be at t: 3 x Held(). What is not given at t lies on the
  /// straight way, or the motion, there.
  Shape At(double t) const;

  /// A mesh that has `vertices` (rising) of this one, in which they have `areas`. Soft handles pull
  /// at their mean squared distance, weighted by area, so that the strength does not depend on how
  /// many vertices a handle has; and together as one, so that it does not depend on how many
  /// handles there are: sum_p pull_p |p - target|^2 = strength * mean over handles of the weight
  /// times that.
  Grip Restrict(const std::vector<int>& vertices, const Eigen::VectorXd& areas,
                double strength) const;

  /// The largest angle by which a handle turns, in radians.
  double GreatestTurn() const;

  /// So many of each handle's vertices, far from each other, that it keeps its form on a coarse
  /// mesh.
  std::vector<int> Pins() const;

  /// True if the same vertices are held in the same way, wherever to.
  bool HoldAlike(const HandleTargets& other) const;
  /// Of targets that hold alike: true if no angle differs by more than `most` radians, and on the
  /// way and at its end no place by more than `most`.
  bool IsNear(const HandleTargets& other, double most) const;

 private:
  enum class Hold { kSoft, kLanded, kCarried };
  struct Part {  // of what holds a vertex
    int handle, place;
    double weight;
  };

  Eigen::Vector3d Target(const Part& part, double t) const;

  std::vector<Handle> handles_;
  Shape rest_;  // in the user's unit
  Eigen::Vector3d origin_;
  double unit_;
  std::vector<int> held_;
  std::vector<Hold> hold_;                // of each held vertex
  std::vector<std::vector<Part>> parts_;  // likewise
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_HANDLE_TARGETS_H_
