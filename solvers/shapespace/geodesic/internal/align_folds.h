#ifndef SHAPESPACE_GEODESIC_INTERNAL_ALIGN_FOLDS_H_
#define SHAPESPACE_GEODESIC_INTERNAL_ALIGN_FOLDS_H_

#include <shapespace/metric/metric.h>
#include <shapespace/path/align.h>

namespace shapespace::internal {

/// Turns poses that `AlignPoses` has aligned once more, where hinges turn by 180 degrees from the
/// pose before and other orientations are nearly as good. For a sheet that is folded in half, flat,
/// all rotations about the fold are equally good; the poses' frame, or a vertex more on one side,
/// would choose. Such a pose is oriented so that its triangles, on the way from the pose before
/// (`FindTurns`), turn by zero in the mean, as the two halves do if both turn by 90 degrees.
/// Later poses are turned with it.
AlignedPoses AlignFolds(const Metric& metric, AlignedPoses poses);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_GEODESIC_INTERNAL_ALIGN_FOLDS_H_
