#ifndef SHAPESPACE_SKINNING_DETAIL_NEAR_RIGID_CLUSTERS_H_
#define SHAPESPACE_SKINNING_DETAIL_NEAR_RIGID_CLUSTERS_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/skinning/detail/bones.h>
#include <shapespace/skinning/detail/moving_points.h>

namespace shapespace::internal {

/// Points that move nearly rigidly, and the rigid motions of each such cluster.
struct NearRigidClusters {
  Bones bones;
  std::vector<int> bone_of;  ///< of each point
};

/// Clusters by which the motion is best explained if every point follows one of `count` bones. They
/// need not be connected, so that bodies of several components are no special case. As in the
/// vector quantisation of Y. Linde, A. Buzo, R. M. Gray ("An Algorithm for Vector Quantizer
/// Design", 1980), with which Le and Deng begin too: a new bone begins where the error is greatest,
/// points follow the bone that is the nearest to their motion, and bones the points that follow
/// them. There are fewer bones if these reproduce the motion but for `exact`, a root mean square
/// distance.
NearRigidClusters FindNearRigidClusters(const MovingPoints& points, int count, double exact);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SKINNING_DETAIL_NEAR_RIGID_CLUSTERS_H_
