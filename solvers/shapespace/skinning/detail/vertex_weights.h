#ifndef SHAPESPACE_SKINNING_DETAIL_VERTEX_WEIGHTS_H_
#define SHAPESPACE_SKINNING_DETAIL_VERTEX_WEIGHTS_H_

#include <Eigen/Core>

#include <shapespace/skinning/detail/bones.h>
#include <shapespace/skinning/detail/moving_points.h>

namespace shapespace::internal {

/// The bones of each point, k x n, and their weights, which are not negative and have sum 1. Bones
/// with weight 0 stand for none.
struct VertexWeights {
  Eigen::MatrixXi bones;
  Eigen::MatrixXd weights;
};

/// Each point with weight 1 for its one bone.
VertexWeights OneBoneEach(const std::vector<int>& bone_of, int weights_per_vertex);

/// Squared distance of each point from where the bones move it, summed over shapes.
Eigen::VectorXd SquaredErrors(const MovingPoints& points, const Bones& bones,
                              const VertexWeights& weights);

/// Weights of each point by least squares over all shapes, for the bones as they move, among the
/// bones that may move it (near_bones.h): the minimum over the simplex of the squared error plus
/// `smoothness` times the squared differences from its neighbours' weights; then the least useful
/// bones are left out until there are no more than the rows of `weights`.
///
/// The sum over points of squared errors and, for each edge, `smoothness` times the squared
/// difference of its ends' weights does not rise.
void FitWeights(const MovingPoints& points, const Bones& bones, double smoothness,
                VertexWeights* weights);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SKINNING_DETAIL_VERTEX_WEIGHTS_H_
