#ifndef SHAPESPACE_TOOLS_SUPPORT_GEODESIC_FLAGS_H_
#define SHAPESPACE_TOOLS_SUPPORT_GEODESIC_FLAGS_H_

#include <cstdint>
#include <string>
#include <vector>

#include <shapespace/solvers/geodesic.h>

namespace shapespace::tools {

/// How to interpolate between poses, as the flags say; those of the metric included.
/// \throw UsageError, InvalidOptions.
GeodesicOptions GeodesicFromFlags();

/// How many shapes a path through so many poses has, the poses included.
std::int64_t NumShapes(size_t poses, const GeodesicOptions& options);

/// Whether the arguments are a .path file, which takes the place of poses to interpolate.
/// \throw UsageError if they are neither that nor two or more poses, or if a flag was given that
/// goes with poses: nobody shall believe that it did anything.
bool IsOnePath(const std::vector<std::string>& files);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_GEODESIC_FLAGS_H_
