#ifndef SHAPESPACE_STATISTICS_DETAIL_FEATURE_CHART_H_
#define SHAPESPACE_STATISTICS_DETAIL_FEATURE_CHART_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/metric/feature_map.h>

namespace shapespace::internal {

/// Features relative to given ones, their centre, such that they can be added: differences of
/// values, but of dihedral angles, which are points of a circle, the angle between the two (times
/// the root of the hinge's weight; then a zero).
class FeatureChart {
 public:
  FeatureChart(const FeatureMap& map, Eigen::VectorXd centre);

  const Eigen::VectorXd& Centre() const { return centre_; }
  /// The relative values of features; angles the shorter way.
  Eigen::VectorXd Log(const Eigen::VectorXd& values) const;
  /// The features of relative values.
  Eigen::VectorXd Exp(const Eigen::VectorXd& relative) const;
  /// A change of relative values as a change of the features of a shape that has `values`.
  Eigen::VectorXd ChangeAt(const Eigen::VectorXd& values, const Eigen::VectorXd& relative) const;

 private:
  Eigen::VectorXd centre_;
  std::vector<int> angles_;  // the first value of each dihedral angle whose centre is on the circle
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_STATISTICS_DETAIL_FEATURE_CHART_H_
