#ifndef SHAPESPACE_BODIES_DETAIL_IMPLICIT_H_
#define SHAPESPACE_BODIES_DETAIL_IMPLICIT_H_

#include <vector>

#include <Eigen/Core>

namespace shapespace::internal {

/// The convex hull of two spheres, flattened along one direction.
struct RoundCone {
  Eigen::Vector3d begin, end;
  double begin_radius, end_radius;
  double blend = 0;  ///< width of the fillet where it joins the previous ones of a list
  Eigen::Vector3d flat = Eigen::Vector3d::UnitY();  ///< unit vector
  double flatness = 1;                              ///< in (0, 1]; 1: round
};

/// The value of an implicit surface's function, negative inside.
struct ImplicitValue {
  double value;
  Eigen::Vector3d gradient;
  double radius;  ///< local thickness: the radius of the parts near the point, blended in the same
                  ///< way
};

ImplicitValue Evaluate(const RoundCone& cone, const Eigen::Vector3d& point);

/// The union of a list's cones, each joined to those before it by a smooth minimum (cubic, so
/// twice differentiable); `cones` is not empty.
ImplicitValue Evaluate(const std::vector<RoundCone>& cones, const Eigen::Vector3d& point);

/// Moves `point` to the surface near it, by at most four Newton steps along the gradient, none
/// longer than half the local radius. Returns the value there, accurate to a thousandth of that
/// radius.
ImplicitValue Project(const std::vector<RoundCone>& cones, Eigen::Vector3d* point);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BODIES_DETAIL_IMPLICIT_H_
