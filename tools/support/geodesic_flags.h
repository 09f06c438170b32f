#ifndef SHAPESPACE_TOOLS_SUPPORT_GEODESIC_FLAGS_H_
#define SHAPESPACE_TOOLS_SUPPORT_GEODESIC_FLAGS_H_

#include <cstdint>
#include <string>
#include <vector>

#include <shapespace/geodesic/geodesic.h>

namespace shapespace::tools {

/// The options of an interpolation, including the metric, according to the flags.
/// \throw UsageError, InvalidOptions.
GeodesicOptions GeodesicFromFlags();

/// The number of shapes of a path through this number of poses, including the poses.
std::int64_t NumShapes(size_t poses, const GeodesicOptions& options);

/// Whether the argument is a .path file instead of poses to interpolate.
/// \throw UsageError if there is no argument, if a .path is not the only one, or if a flag was
///        given that would have no effect on a .path, which is not so of the tool's `own`.
bool IsOnePath(const std::vector<std::string>& files, const std::string& own = "");

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_GEODESIC_FLAGS_H_
