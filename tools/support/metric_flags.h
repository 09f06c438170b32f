#ifndef SHAPESPACE_TOOLS_SUPPORT_METRIC_FLAGS_H_
#define SHAPESPACE_TOOLS_SUPPORT_METRIC_FLAGS_H_

#include <shapespace/files/read.h>
#include <shapespace/metric/metric.h>

namespace shapespace::tools {

/// The metric according to the flags: --metric is a preset, and other flags that were given
/// override it. The preset `deformation` depends on the mesh, in its
/// first pose.
/// \throw UsageError, also for that preset without a mesh; FileError if the file that --stiffness
///        names cannot be read, or has a number that is not positive.
MetricOptions MetricFromFlags(const Poses* mesh = nullptr);

/// \throw UsageError if --bending was given for a mesh without hinges; FileError if --stiffness has
///        not one number a vertex.
void CheckMetricFlags(const Connectivity& connectivity);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_METRIC_FLAGS_H_
