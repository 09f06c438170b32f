#ifndef SHAPESPACE_SKINNING_DETAIL_JOINT_TREE_H_
#define SHAPESPACE_SKINNING_DETAIL_JOINT_TREE_H_

#include <shapespace/skinning/detail/bones.h>
#include <shapespace/skinning/detail/moving_points.h>
#include <shapespace/skinning/detail/vertex_weights.h>

namespace shapespace::internal {

/// Makes a skeleton of bones. The root is the bone with the greatest sum of weights. Bones that
/// move the same points are neighbours, and of all trees that connect them so, the skeleton is the
/// one in which neighbours share the most: the maximum spanning tree of the sums of products of
/// weights. Where that leaves several trees, because components of the body share no bone, the
/// bones whose centroids are the nearest connect them.
///
/// The pivot of a joint is the point that moves least when its bone moves relative to the parent's:
/// the minimum, over all shapes, of the squared distances between the places to which the two move
/// it. Motions tell nothing about some directions, such as along a hinge's axis; `error`, the root
/// mean square distance of points from where the bones move them, says how much they can be
/// trusted, and as far as they cannot, the pivot is at the centroid of what the two bones share.
///
/// Parents are set, bones are ordered with parents before children, pivots are moved without
/// changing any motion, and weights follow the order, the greatest of each point first.
void MakeSkeleton(const MovingPoints& points, double error, Bones* bones, VertexWeights* weights);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SKINNING_DETAIL_JOINT_TREE_H_
