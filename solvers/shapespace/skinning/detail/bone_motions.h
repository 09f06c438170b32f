#ifndef SHAPESPACE_SKINNING_DETAIL_BONE_MOTIONS_H_
#define SHAPESPACE_SKINNING_DETAIL_BONE_MOTIONS_H_

#include <shapespace/skinning/detail/bones.h>
#include <shapespace/skinning/detail/moving_points.h>
#include <shapespace/skinning/detail/vertex_weights.h>

namespace shapespace::internal {

/// Improves the motions of all bones, in all shapes but the rest pose, for weights as they are. The
/// error is a polynomial of the bones' matrices whose coefficients are sums over points, computed
/// once; so that a step of Gauss and Newton for all bones of a shape together costs no more than a
/// solve of a system of six unknowns per bone, nine with scale. (Le and Deng fit one bone at a
/// time, while the others rest, which needs many more iterations.) Steps that would raise the error
/// are shortened (Levenberg and Marquardt).
void FitBoneMotions(const MovingPoints& points, const VertexWeights& weights, bool scale,
                    Bones* bones);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SKINNING_DETAIL_BONE_MOTIONS_H_
