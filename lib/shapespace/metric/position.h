#ifndef SHAPESPACE_METRIC_POSITION_H_
#define SHAPESPACE_METRIC_POSITION_H_

#include <Eigen/Core>

#include <shapespace/metric/feature.h>

namespace shapespace {

struct MetricBasis;

/// The position of a vertex: the paper's regularising L2 metric (5), weights lambda A_p.
struct PositionFeature : ElementFeature<1, 3> {
  static constexpr bool kRigidInvariant = false;
  static constexpr int kScalarRows = 1;
  static constexpr const char* kName = "position";

  static PositionFeature Freeze(const MetricBasis& basis);

  template <typename T>
  void operator()(const T* x, T* value) const {
    value[0] = x[0];
    value[1] = x[1];
    value[2] = x[2];
  }

  void ScalarRows(const Eigen::Vector3d*, double* k) const { k[0] = 1; }
};

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_POSITION_H_
