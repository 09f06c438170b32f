#ifndef SHAPESPACE_STATISTICS_DETAIL_FEATURE_STATISTICS_H_
#define SHAPESPACE_STATISTICS_DETAIL_FEATURE_STATISTICS_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/shape.h>
#include <shapespace/metric/feature_map.h>

namespace shapespace::internal {

/// The features of weighted poses, and their means: of strains and positions arithmetic, of
/// dihedral angles on the circle.
class FeatureStatistics {
 public:
  /// `poses` are aligned, in the metric's unit; `weights` have sum 1.
  FeatureStatistics(const FeatureMap& map, const std::vector<Shape>& poses,
                    const Eigen::VectorXd& weights);

  /// The mean, as features of a shape are: angles are points of the unit circle.
  const Eigen::VectorXd& Mean() const { return mean_; }

  /// The weighted mean of |features of a pose - Mean()|^2.
  double Variance() const;

  /// A lower bound of sum_i w_i K sum_k |Phi_{k+1} - Phi_k|^2 over all stars of paths with K =
  /// `segments` segments each that lead from one shape to the poses: the sum over all elements of
  /// the least value for each alone, which is exact. Of an angle theta it is, with the poses'
  /// angles theta_i unwrapped in the best of all ways,
  ///   min_theta sum_i w_i (2 K sin((theta_i - theta) / (2 K)))^2
  ///     = 2 K^2 (1 - |sum_i w_i exp(i theta_i / K)|).
  double LowerBound(int segments) const;

  /// Hinges whose angles no half circle contains.
  int AmbiguousHinges() const;

 private:
  // Angles in all poses of the hinge whose first value is `at`. False if it has collapsed in one.
  bool GetAngles(Eigen::Index at, std::vector<double>* angles) const;

  const FeatureMap& map_;
  const Eigen::VectorXd weights_;
  Eigen::MatrixXd values_;  // a column for each pose
  Eigen::VectorXd mean_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_STATISTICS_DETAIL_FEATURE_STATISTICS_H_
