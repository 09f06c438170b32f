#ifndef SHAPESPACE_SKINNING_DETAIL_NEAR_BONES_H_
#define SHAPESPACE_SKINNING_DETAIL_NEAR_BONES_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/skinning/detail/moving_points.h>
#include <shapespace/skinning/detail/vertex_weights.h>

namespace shapespace::internal {

/// The bones that may move a point. A bone's region are the points for which it has the greatest
/// weight. Those bones may move a point whose region is the point's own, or is at most two regions
/// away along the surface. Few shapes say little about weights, so that without this a hand would
/// take weight of a foot that happens to move alike.
class NearBones {
 public:
  NearBones(const MovingPoints& points, const VertexWeights& weights, int count);

  /// The bones that may move this point, ascending: those near it, those without a region in its
  /// component, as if they were near, and those that move it already.
  void Find(int point, std::vector<int>* bones) const;

 private:
  using Table = Eigen::Matrix<char, Eigen::Dynamic, Eigen::Dynamic>;

  const MovingPoints& points_;
  const VertexWeights& weights_;
  std::vector<int> region_of_;
  Eigen::MatrixXi near_;  // bones x bones: not 0 if the regions are at most two steps apart
  Table is_in_;           // bones x components
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SKINNING_DETAIL_NEAR_BONES_H_
