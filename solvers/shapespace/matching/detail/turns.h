#ifndef SHAPESPACE_MATCHING_DETAIL_TURNS_H_
#define SHAPESPACE_MATCHING_DETAIL_TURNS_H_

#include <utility>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>

namespace shapespace::internal {

/// At each vertex, the mean over the triangles around it, by area, of n . (grad f x grad g), n the
/// unit normal, for each of `pairs` (f, g) of columns of `functions` (n x count). The result is
/// n x pairs. It tells to which side grad g is turned from grad f, seen from outside, and therefore
/// changes its sign under reflection. `areas` are those of vertices (`Laplacian`).
Eigen::MatrixXf GradientTurns(const Connectivity& connectivity, const Eigen::VectorXd& areas,
                              const Eigen::MatrixXf& functions,
                              const std::vector<std::pair<int, int>>& pairs);

/// All pairs (i, j) of `count` things, i < j.
std::vector<std::pair<int, int>> AllPairs(int count);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_TURNS_H_
