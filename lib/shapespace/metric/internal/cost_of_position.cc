#include <shapespace/metric/internal/cost_of_position.h>

#include <algorithm>
#include <vector>

#include <shapespace/metric/feature_registry.h>
#include <shapespace/metric/position.h>

namespace shapespace::internal {

std::shared_ptr<const Metric> WithCostOfPosition(const std::shared_ptr<const Metric>& metric,
                                                 double lambda) {
  if (metric->options.lambda >= lambda) return metric;
  auto result = std::make_shared<Metric>(*metric);
  result->options.lambda = lambda;
  std::vector<std::shared_ptr<const Feature>>& features = result->features;
  features.erase(std::remove_if(features.begin(), features.end(),
                                [](const std::shared_ptr<const Feature>& feature) {
                                  return feature->Name() == PositionFeature::kName;
                                }),
                 features.end());
  MetricBasis basis;
  basis.connectivity = metric->connectivity;
  basis.vertex_area = metric->vertex_area;
  features.push_back(FindFeature(PositionFeature::kName).freeze(basis, lambda));
  return result;
}

}  // namespace shapespace::internal
