#include <shapespace/metric/position.h>

#include <shapespace/metric/metric_basis.h>

namespace shapespace {

PositionFeature PositionFeature::Freeze(const MetricBasis& basis) {
  const int num_vertices = basis.connectivity->NumVertices();
  PositionFeature feature;
  feature.stencils.setLinSpaced(num_vertices, 0, num_vertices - 1);
  feature.weights = basis.vertex_area;
  return feature;
}

}  // namespace shapespace
