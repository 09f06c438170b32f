#ifndef SHAPESPACE_HIERARCHY_FREEZE_LEVEL_H_
#define SHAPESPACE_HIERARCHY_FREEZE_LEVEL_H_

#include <memory>
#include <vector>

#include <shapespace/hierarchy/hierarchy.h>
#include <shapespace/metric/metric.h>

namespace shapespace {

/// Restricts `options` of a metric on the mesh itself, `connectivity`, to a level of a hierarchy:
/// the user's stiffness is restricted to the level's vertices (Hierarchy::RestrictField).
MetricOptions RestrictOptions(const MetricOptions& options, const Connectivity& connectivity,
                              const Hierarchy& hierarchy, int level);

/// The metric of a level of a hierarchy: the options of `finest`, the metric on the mesh itself,
/// are restricted and frozen on `poses`, shapes of the level in the finest metric's unit.
std::shared_ptr<const Metric> FreezeLevel(const Metric& finest, const Hierarchy& hierarchy,
                                          int level, const std::vector<Shape>& poses,
                                          PosePairs pairs = PosePairs::kConsecutive);

}  // namespace shapespace

#endif  // SHAPESPACE_HIERARCHY_FREEZE_LEVEL_H_
