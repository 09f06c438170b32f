#ifndef SHAPESPACE_SKINNING_DETAIL_JOINT_TREE_H_
#define SHAPESPACE_SKINNING_DETAIL_JOINT_TREE_H_

#include <shapespace/skinning/detail/bones.h>
#include <shapespace/skinning/detail/moving_points.h>
#include <shapespace/skinning/detail/vertex_weights.h>

namespace shapespace::internal {

/// Makes a skeleton of bones. Bones that move the same points are neighbours, and of all trees that
/// connect them so, the skeleton is the one in which neighbours share the most: the maximum
/// spanning tree of the sums of products of weights. Where that leaves several trees, because
/// components of the body share no bone, the bones whose centroids are the nearest connect them.
/// The root is the bone without which the tree falls into the smallest parts.
///
/// The pivot of a joint is the point that moves least when its bone moves relative to the parent's:
/// the minimum, over all shapes, of the squared distances between the places to which the two move
/// it. Where motions tell nothing, such as along a hinge's axis, or cannot be trusted, because no
/// point rests or because of `error`, the root mean square distance of points from where the bones
/// move them, the pivot is near the centroid of what the two bones share, at a distance that the
/// spread of that region permits.
///
/// Parents are set, bones are ordered with parents before children, pivots are moved without
/// changing any motion, and weights follow the order, the greatest of each point first.
void MakeSkeleton(const MovingPoints& points, double error, Bones* bones, VertexWeights* weights);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SKINNING_DETAIL_JOINT_TREE_H_
