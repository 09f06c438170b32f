#ifndef SHAPESPACE_TOOLS_SUPPORT_METRIC_FLAGS_H_
#define SHAPESPACE_TOOLS_SUPPORT_METRIC_FLAGS_H_

#include <shapespace/metric/metric.h>

namespace shapespace::tools {

/// The metric that the flags ask for: --metric names a preset, which sets the defaults of the other
/// flags; a flag that was given wins. The preset `deformation` is one of a mesh.
/// \throw UsageError; also for that preset without a mesh.
MetricOptions MetricFromFlags(const Connectivity* mesh = nullptr);

/// \throw UsageError if --bending was given for a mesh on which nothing can bend.
void CheckMetricFlags(const Connectivity& connectivity);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_METRIC_FLAGS_H_
