#ifndef SHAPESPACE_SKINNING_DETAIL_FIT_BONES_H_
#define SHAPESPACE_SKINNING_DETAIL_FIT_BONES_H_

#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/skinning/detail/bones.h>
#include <shapespace/skinning/detail/moving_points.h>
#include <shapespace/skinning/detail/vertex_weights.h>
#include <shapespace/skinning/skinning.h>

namespace shapespace::internal {

/// A root mean square distance, in the frame of `MovingPoints`, below which a motion is reproduced
/// exactly: files in single precision do not show less.
inline constexpr double kExactError = 1e-7;

/// Bones and weights, in the frame of `MovingPoints`.
struct FittedBones {
  Bones bones;
  VertexWeights weights;
  std::vector<double> errors;  ///< root mean square: at the start, and after each iteration
  Termination termination = Termination::kMaxIterations;
};

/// At most `count` bones, without a hierarchy; fewer if the others would have no use.
FittedBones FitBones(const MovingPoints& points, int count, const SkinningOptions& options,
                     Progress* progress);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SKINNING_DETAIL_FIT_BONES_H_
