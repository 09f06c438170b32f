#include <shapespace/analysis/vertex_energy.h>

#include <shapespace/metric/feature_map.h>

namespace shapespace {
namespace {

// The squared change of each vertex's share of the features.
Eigen::VectorXd SharedByVertices(const FeatureMap& map, const Eigen::VectorXd& change) {
  const Metric& metric = map.GetMetric();
  Eigen::VectorXd shares = Eigen::VectorXd::Zero(metric.vertex_area.size());
  for (size_t f = 0; f < metric.features.size(); ++f) {
    const Feature& feature = *metric.features[f];
    const int first = map.FirstValue(f), values = feature.ValuesPerElement();
    if (feature.IsSum()) {
      shares += change[first] * change[first] * metric.vertex_area;
      continue;
    }
    for (int e = 0; e < feature.NumElements(); ++e) {
      const double share =
          change.segment(first + values * e, values).squaredNorm() / feature.VerticesPerElement();
      for (int k = 0; k < feature.VerticesPerElement(); ++k) shares[feature.Element(e)[k]] += share;
    }
  }
  return shares;
}

}  // namespace

std::vector<Eigen::VectorXd> VertexEnergy(const Path& path) {
  const FeatureMap map(path.metric);
  const Eigen::VectorXd& area = path.metric->vertex_area;
  std::vector<Eigen::VectorXd> energies(path.shapes.size(), Eigen::VectorXd::Zero(area.size()));
  if (path.shapes.size() < 2) return energies;
  Eigen::VectorXd before = map.Values(path.shapes[0]);
  for (size_t i = 1; i < path.shapes.size(); ++i) {
    Eigen::VectorXd values = map.Values(path.shapes[i]);
    const double time = path.parameters[i] - path.parameters[i - 1];
    const Eigen::VectorXd density =
        SharedByVertices(map, values - before).cwiseQuotient(area) / (time * time);
    energies[i - 1] += density;
    energies[i] += density;
    before.swap(values);
  }
  for (size_t i = 1; i + 1 < energies.size(); ++i) energies[i] /= 2;
  for (Eigen::VectorXd& energy : energies) path.metric->connectivity->CopyToTwins(&energy);
  return energies;
}

}  // namespace shapespace
