#include <shapespace/metric/dihedral.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include <shapespace/base/internal/ranges.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/metric/detail/collapse.h>
#include <shapespace/metric/detail/rest_triangle.h>
#include <shapespace/metric/metric_basis.h>

namespace shapespace {
namespace {

using internal::kRadians;

// |f|^2 / A_f of a hinge is unbounded for slivers; 8 corresponds to a triangle of aspect ratio 4.
constexpr double kGreatestHingeAspect = 8;

// The greatest distance on the circle between two of the angles, which are in [-pi, pi]; sorts
// them. The angle that is farthest from another one is next to its opposite.
double GreatestDistance(std::vector<double>* angles) {
  std::sort(angles->begin(), angles->end());
  double greatest = 0;
  for (const double angle : *angles) {
    const double opposite = angle > 0 ? angle - M_PI : angle + M_PI;
    const auto after = std::lower_bound(angles->begin(), angles->end(), opposite);
    const double neighbours[] = {after == angles->end() ? angles->front() : *after,
                                 after == angles->begin() ? angles->back() : *(after - 1)};
    for (const double other : neighbours) {
      greatest = std::max(greatest, std::abs(WrapAngle(angle - other)));
    }
  }
  return greatest;
}

}  // namespace

Dihedral Dihedral::Freeze(const MetricBasis& basis) {
  const Connectivity& connectivity = *basis.connectivity;
  Dihedral feature;
  feature.stencils = connectivity.Hinges();
  feature.weights.resize(connectivity.NumHinges());
  if (connectivity.NumHinges() == 0) return feature;
  feature.normal_epsilon_squared =
      std::pow(MetricBasis::kCollapsed * 2 * basis.triangle_area.mean(), 2);
  feature.edge_epsilon_squared = basis.CollapsedSquared();
  const auto kept_in_collapse = [&, collapsed_squared = feature.edge_epsilon_squared](int a, int b,
                                                                                      int c) {
    const Eigen::Vector4d rest = internal::RestNumbers(basis, collapsed_squared, a, b, c);
    return internal::KeptInCollapse(basis, collapsed_squared, rest, a, b, c);
  };
  const auto freeze = [&](int h, std::vector<double>* angles) {
    double x[12];
    double squared_length = 0, jump = 0, fold = 0;
    for (size_t i = 0; i < basis.poses.size(); ++i) {
      GatherCoordinates(feature, h, basis.poses[i], x);
      const Eigen::Map<Eigen::Vector3d> a(x), b(x + 3);
      squared_length += (b - a).squaredNorm() / basis.poses.size();
      const double angle = (*angles)[i] = feature.Angle(x);
      fold = std::max(fold, std::abs(angle));
      if (i > 0) jump = std::max(jump, std::abs(WrapAngle(angle - (*angles)[i - 1])));
    }
    if (basis.pairs == PosePairs::kAll) jump = GreatestDistance(angles);
    // Hinges that are folded in a given pose, or that turn by more than 90 degrees from one pose to
    // the next, are weighted down, because the chord has no gradient there.
    const double ramp = std::clamp((fold - 120 * kRadians) / (15 * kRadians), 0.0, 1.0);
    const double u = std::max(jump, ramp * fold) / (60 * kRadians);
    const double area = basis.hinge_area(h);
    const double aspect =
        area * kGreatestHingeAspect > squared_length ? squared_length / area : kGreatestHingeAspect;
    const auto v = connectivity.Hinges().col(h);
    const double kept =
        std::min(kept_in_collapse(v(0), v(1), v(2)), kept_in_collapse(v(1), v(0), v(3)));
    feature.weights(h) = basis.hinge_stiffness(h) * aspect * kept / (1 + u * u * u * u);
  };
  internal::ForRanges(connectivity.NumHinges(), [&](int begin, int end) {
    std::vector<double> angles(basis.poses.size());
    for (int h = begin; h < end; ++h) freeze(h, &angles);
  });
  return feature;
}

}  // namespace shapespace
