#ifndef SHAPESPACE_SPLINE_INTERNAL_SMOOTH_CHAIN_H_
#define SHAPESPACE_SPLINE_INTERNAL_SMOOTH_CHAIN_H_

#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/path/path.h>
#include <shapespace/spline/spline.h>

namespace shapespace::internal {

/// Moves the inner shapes of a chain of geodesics such that the velocity is continuous at its
/// poses, which are met at `times`, from 0 to 1.
/// \throw Cancelled if `progress` asks to stop; the path is then as it was.
void SmoothChain(const SplineOptions& options, const std::vector<double>& times, Progress* progress,
                 Path* path);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SPLINE_INTERNAL_SMOOTH_CHAIN_H_
