#include <shapespace/hierarchy/freeze_level.h>

namespace shapespace {

MetricOptions RestrictOptions(const MetricOptions& options, const Connectivity& connectivity,
                              const Hierarchy& hierarchy, int level) {
  MetricOptions result = options;
  for (Eigen::VectorXd* field : {&result.stretching_stiffness, &result.bending_stiffness}) {
    if (field->size() == 0) continue;
    *field =
        hierarchy.RestrictField(VertexStiffness(*field, options.stiffness_on, connectivity), level);
  }
  result.stiffness_on = StiffnessOn::kVertices;
  return result;
}

std::shared_ptr<const Metric> FreezeLevel(const Metric& finest, const Hierarchy& hierarchy,
                                          int level, const std::vector<Shape>& poses,
                                          PosePairs pairs) {
  return FreezeMetric(RestrictOptions(finest.options, *finest.connectivity, hierarchy, level),
                      hierarchy.LevelConnectivity(level), poses, 1, pairs);
}

}  // namespace shapespace
