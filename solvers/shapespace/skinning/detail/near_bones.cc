#include <shapespace/skinning/detail/near_bones.h>

namespace shapespace::internal {

NearBones::NearBones(const MovingPoints& points, const VertexWeights& weights, int count)
    : points_(points),
      weights_(weights),
      region_of_(points.NumPoints()),
      is_in_(Table::Zero(count, points.num_components)) {
  for (int p = 0; p < points.NumPoints(); ++p) {
    Eigen::Index greatest;
    weights.weights.col(p).maxCoeff(&greatest);
    region_of_[p] = weights.bones(greatest, p);
    is_in_(region_of_[p], points.component_of[p]) = 1;
  }
  Eigen::MatrixXi touch = Eigen::MatrixXi::Identity(count, count);
  for (int p = 0; p < points.NumPoints(); ++p) {
    for (const int q : points.neighbours[p]) touch(region_of_[q], region_of_[p]) = 1;
  }
  near_ = touch * touch;
}

void NearBones::Find(int point, std::vector<int>* bones) const {
  const auto moves_already = [&](int bone) {
    return ((weights_.bones.col(point).array() == bone) &&
            (weights_.weights.col(point).array() > 0))
        .any();
  };
  bones->clear();
  for (int b = 0; b < static_cast<int>(near_.rows()); ++b) {
    if (near_(b, region_of_[point]) != 0 || is_in_(b, points_.component_of[point]) == 0 ||
        moves_already(b)) {
      bones->push_back(b);
    }
  }
}

}  // namespace shapespace::internal
