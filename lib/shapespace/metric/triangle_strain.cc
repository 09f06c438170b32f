#include <shapespace/metric/triangle_strain.h>

#include <shapespace/metric/metric_basis.h>

namespace shapespace {

TriangleStrain TriangleStrain::Freeze(const MetricBasis& basis) {
  TriangleStrain feature;
  feature.stencils = basis.connectivity->Triangles();
  feature.weights = basis.triangle_stiffness;
  if (basis.weighting == Weighting::kArea) feature.weights.array() *= basis.triangle_area.array();
  feature.epsilon_squared = basis.CollapsedSquared();
  return feature;
}

}  // namespace shapespace
