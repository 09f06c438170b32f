#ifndef SHAPESPACE_TOOLS_SUPPORT_GEODESIC_FLAGS_H_
#define SHAPESPACE_TOOLS_SUPPORT_GEODESIC_FLAGS_H_

#include <shapespace/solvers/geodesic.h>

namespace shapespace::tools {

/// How to interpolate between poses, as the flags say; those of the metric included.
/// \throw UsageError, InvalidOptions.
GeodesicOptions GeodesicFromFlags();

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_GEODESIC_FLAGS_H_
