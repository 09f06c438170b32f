#ifndef SHAPESPACE_METRIC_VOLUME_H_
#define SHAPESPACE_METRIC_VOLUME_H_

#include <Eigen/Core>

namespace shapespace {

/// The volume that a closed mesh encloses, as a share of the poses' mean: one number, the sum of
/// det(p, q, r) / (6 V_ref) over the triangles. What a feature is: edge_length.h.
struct Volume {
  static constexpr int kVertices = 3, kValues = 1;
  static constexpr bool kRigidInvariant = true, kSum = true, kTrapezoid = false;
  static constexpr const char* kName = "volume";

  Eigen::Matrix3Xi stencils;
  Eigen::VectorXd weights;  ///< one number: of the square of the sum
  double reference = 1;     ///< V_ref

  template <typename T>
  void operator()(const T* x, T* value) const {
    value[0] = (x[0] * (x[4] * x[8] - x[5] * x[7]) + x[1] * (x[5] * x[6] - x[3] * x[8]) +
                x[2] * (x[3] * x[7] - x[4] * x[6])) /
               (6 * reference);
  }

  double LeastChange(const double* a, const double* b, int segments) const {
    return (b[0] - a[0]) * (b[0] - a[0]) / segments;
  }
};

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_VOLUME_H_
