#include <shapespace/metric/triangle_strain.h>

#include <shapespace/base/internal/ranges.h>
#include <shapespace/metric/detail/collapse.h>
#include <shapespace/metric/detail/rest_triangle.h>
#include <shapespace/metric/metric_basis.h>

namespace shapespace {

TriangleStrain TriangleStrain::Freeze(const MetricBasis& basis) {
  TriangleStrain feature;
  feature.stencils = basis.connectivity->Triangles();
  feature.weights = basis.triangle_stiffness;
  if (basis.weighting == Weighting::kArea) feature.weights.array() *= basis.triangle_area.array();
  feature.epsilon_squared = basis.CollapsedSquared();
  feature.numbers.resize(4, basis.connectivity->NumTriangles());
  internal::ForIndices(basis.connectivity->NumTriangles(), [&](int f) {
    const auto t = basis.connectivity->Triangles().col(f);
    const double collapsed_squared = feature.epsilon_squared;
    const Eigen::Vector4d rest = internal::RestNumbers(basis, collapsed_squared, t(0), t(1), t(2));
    feature.numbers.col(f) = rest;
    feature.weights(f) *=
        internal::KeptInCollapse(basis, collapsed_squared, rest, t(0), t(1), t(2));
  });
  return feature;
}

}  // namespace shapespace
