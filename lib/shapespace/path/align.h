#ifndef SHAPESPACE_PATH_ALIGN_H_
#define SHAPESPACE_PATH_ALIGN_H_

#include <vector>

#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/metric/metric.h>

namespace shapespace {

/// Poses with position and orientation removed, and the motions that restore these.
struct AlignedPoses {
  std::vector<Shape> shapes;         ///< centred, in the metric's unit
  std::vector<RigidMotion> motions;  ///< from unit * shape to the pose, in the user's unit
};

/// Centres each of `poses` (user's unit) and rotates it onto the one before, by the best rotation
/// in the A_p-weighted L2 sense (Procrustes).
AlignedPoses AlignPoses(const Metric& metric, const std::vector<Shape>& poses);

}  // namespace shapespace

#endif  // SHAPESPACE_PATH_ALIGN_H_
