#ifndef SHAPESPACE_STATISTICS_DETAIL_PROCRUSTES_H_
#define SHAPESPACE_STATISTICS_DETAIL_PROCRUSTES_H_

#include <vector>

#include <shapespace/path/align.h>

namespace shapespace::internal {

/// Centres poses (user's unit) and rotates them such that the weighted sum of their area-weighted
/// squared distances from their mean is least (generalised Procrustes analysis: Gower,
/// Psychometrika 1975). `weights` have sum 1.
AlignedPoses AlignToMean(const Metric& metric, const std::vector<Shape>& poses,
                         const Eigen::VectorXd& weights);

/// The rigid motion, from the metric's unit to the user's frame, in the middle of the poses'.
RigidMotion MeanMotion(const AlignedPoses& poses, const Eigen::VectorXd& weights);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_STATISTICS_DETAIL_PROCRUSTES_H_
