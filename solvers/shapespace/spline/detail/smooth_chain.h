#ifndef SHAPESPACE_SPLINE_DETAIL_SMOOTH_CHAIN_H_
#define SHAPESPACE_SPLINE_DETAIL_SMOOTH_CHAIN_H_

#include <limits>
#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/path/path.h>
#include <shapespace/spline/spline.h>

namespace shapespace::internal {

/// What was done about contact; fields of SplineSummary with these names.
struct SmoothContact {
  int uncertified_segments = -1;
  double contact_distance = std::numeric_limits<double>::quiet_NaN();
};

/// Moves the inner shapes of a chain of geodesics such that the velocity is continuous at its
/// poses, which are met at `times`, from 0 to 1. If `options` avoid contact, and the motion between
/// two poses has some that the chain has not, it is relaxed, from the chain, to the motion without
/// contact whose increments are nearest to it.
/// \throw Cancelled if `progress` asks to stop; the path is then as it was.
SmoothContact SmoothChain(const SplineOptions& options, const std::vector<double>& times,
                          Progress* progress, Path* path);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SPLINE_DETAIL_SMOOTH_CHAIN_H_
