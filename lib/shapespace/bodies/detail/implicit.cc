#include <shapespace/bodies/detail/implicit.h>

#include <algorithm>
#include <cmath>

namespace shapespace::internal {

ImplicitValue Evaluate(const RoundCone& cone, const Eigen::Vector3d& point) {
  // Flattening stretches distances along `flat`.
  const double stretch = 1 / cone.flatness - 1;
  const auto stretched = [&](const Eigen::Vector3d& v) -> Eigen::Vector3d {
    return v + stretch * cone.flat.dot(v) * cone.flat;
  };
  const Eigen::Vector3d from_begin = stretched(point - cone.begin);
  const Eigen::Vector3d axis = stretched(cone.end - cone.begin);
  const double length = axis.norm();
  const double slope = (cone.end_radius - cone.begin_radius) / length;
  // The sphere on the axis to which the point is nearest.
  const double along = from_begin.dot(axis) / length;
  const double aside = std::sqrt(std::max(0.0, from_begin.squaredNorm() - along * along));
  const double at = std::clamp(along + slope * aside / std::sqrt(1 - slope * slope), 0.0, length);
  const Eigen::Vector3d from_centre = from_begin - at / length * axis;
  const double distance = std::max(from_centre.norm(), 1e-12);
  const double radius = cone.begin_radius + slope * at;
  return {distance - radius, stretched(from_centre / distance), radius * cone.flatness};
}

ImplicitValue Evaluate(const std::vector<RoundCone>& cones, const Eigen::Vector3d& point) {
  ImplicitValue result = Evaluate(cones[0], point);
  for (size_t i = 1; i < cones.size(); ++i) {
    const ImplicitValue next = Evaluate(cones[i], point);
    const double blend = cones[i].blend;
    const double overlap = std::max(0.0, blend - std::abs(next.value - result.value)) / blend;
    const bool next_is_nearer = next.value < result.value;
    const ImplicitValue& nearer = next_is_nearer ? next : result;
    const ImplicitValue& other = next_is_nearer ? result : next;
    const double share = overlap * overlap / 2;  // weight of the farther one
    result = {nearer.value - blend / 6 * overlap * overlap * overlap,
              (1 - share) * nearer.gradient + share * other.gradient,
              (1 - share) * nearer.radius + share * other.radius};
  }
  return result;
}

ImplicitValue Project(const std::vector<RoundCone>& cones, Eigen::Vector3d* point) {
  ImplicitValue here = Evaluate(cones, *point);
  for (int i = 0; i < 4; ++i) {
    const double slope = std::max(here.gradient.norm(), 0.1);  // near 1 except in creases
    const double largest = here.radius / 2;
    const double step = here.value / slope;
    *point -= std::clamp(step, -largest, largest) / slope * here.gradient;
    // After such a short step, which is exact to second order, the old gradient is accurate enough.
    if (std::abs(step) < 1e-3 * here.radius) break;
    here = Evaluate(cones, *point);
  }
  return here;
}

}  // namespace shapespace::internal
