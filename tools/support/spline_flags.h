#ifndef SHAPESPACE_TOOLS_SUPPORT_SPLINE_FLAGS_H_
#define SHAPESPACE_TOOLS_SUPPORT_SPLINE_FLAGS_H_

#include <optional>

#include <shapespace/spline/spline.h>

namespace shapespace::tools {

/// The options of a spline through poses of a mesh with `num_vertices` according to the flags, but
/// for those of the geodesics; none without --spline.
/// \throw UsageError.
std::optional<SplineOptions> SplineFromFlags(int num_vertices);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_SPLINE_FLAGS_H_
