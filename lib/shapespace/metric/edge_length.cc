#include <shapespace/metric/edge_length.h>

#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/metric/detail/collapse.h>
#include <shapespace/metric/metric_basis.h>

namespace shapespace {

EdgeLength EdgeLength::Freeze(const MetricBasis& basis) {
  EdgeLength feature;
  feature.stencils = basis.connectivity->Edges();
  feature.weights = basis.edge_stiffness;
  if (basis.weighting == Weighting::kArea) {
    // An edge far shorter than the others would have the weight A_e / |e|^4 and make its
    // neighbourhood rigid.
    const double least = internal::SquaredShortest(basis.squared_length);
    feature.weights.array() *=
        basis.edge_area.array() / basis.squared_length.array().max(least).square();
  }
  return feature;
}

LogLength LogLength::Freeze(const MetricBasis& basis) {
  const Connectivity& connectivity = *basis.connectivity;
  const int loose_edges = connectivity.NumEdges() - connectivity.NumTriangleEdges();
  LogLength feature;
  feature.stencils = connectivity.Edges().rightCols(loose_edges);
  feature.weights = basis.edge_stiffness.tail(loose_edges);
  if (basis.weighting == Weighting::kArea) {
    feature.weights.array() *= basis.edge_area.tail(loose_edges).array();
  }
  feature.epsilon_squared = basis.CollapsedSquared();
  for (int e = 0; e < loose_edges; ++e) {
    feature.weights(e) *= internal::KeptInCollapse(basis, feature.epsilon_squared,
                                                   feature.stencils(0, e), feature.stencils(1, e));
  }
  return feature;
}

}  // namespace shapespace
