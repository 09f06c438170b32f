#ifndef SHAPESPACE_GEODESIC_DETAIL_ALIGN_FOLDS_H_
#define SHAPESPACE_GEODESIC_DETAIL_ALIGN_FOLDS_H_

#include <shapespace/metric/metric.h>
#include <shapespace/path/align.h>

namespace shapespace::internal {

/// Turns poses that `AlignPoses` has aligned once more, where hinges turn by 180 degrees from the
/// pose before and other orientations are nearly as good. For a sheet that is folded in half, flat,
/// all rotations about the fold are equally good; the poses' frame, or a vertex more on one side,
/// would choose. Such a pose is aligned with the shape half-way of the `TurningMotion` from the
/// pose before, and this with the pose before: both halves of the sheet turn by 90 degrees. Later
/// poses are turned with it.
AlignedPoses AlignFolds(const Metric& metric, AlignedPoses poses);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_GEODESIC_DETAIL_ALIGN_FOLDS_H_
