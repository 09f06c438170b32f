#include <shapespace/exponential/detail/cost_of_position.h>

#include <shapespace/metric/feature_registry.h>

namespace shapespace::internal {

std::shared_ptr<const Metric> WithCostOfPosition(const std::shared_ptr<const Metric>& metric) {
  // A hundredth of the default. With ten times as much, bodies that turn by 90 degrees arrive
  // within a thousandth of their diameter of the same place.
  constexpr double kLambda = 1e-6;
  if (metric->options.lambda > 0) return metric;
  MetricBasis basis;
  basis.connectivity = metric->connectivity;
  basis.vertex_area = metric->vertex_area;
  auto definite = std::make_shared<Metric>(*metric);
  definite->options.lambda = kLambda;
  definite->features.push_back(FindFeature(PositionFeature::kName).freeze(basis, kLambda));
  return definite;
}

}  // namespace shapespace::internal
