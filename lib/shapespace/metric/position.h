#ifndef SHAPESPACE_METRIC_POSITION_H_
#define SHAPESPACE_METRIC_POSITION_H_

#include <Eigen/Core>

namespace shapespace {

/// The position of a vertex: the paper's regularising L2 metric (5), weights lambda A_p.
/// What a feature is: edge_length.h.
struct Position {
  static constexpr int kVertices = 1, kValues = 3, kStencils = 1;
  static constexpr bool kRigidInvariant = false, kSum = false, kTrapezoid = false;
  static constexpr const char* kName = "position";

  Eigen::Matrix<int, 1, Eigen::Dynamic> stencils;
  Eigen::VectorXd weights;

  template <typename T>
  void operator()(const T* x, T* value) const {
    value[0] = x[0];
    value[1] = x[1];
    value[2] = x[2];
  }

  double LeastChange(const double* a, const double* b, int segments) const {
    return (Eigen::Map<const Eigen::Vector3d>(b) - Eigen::Map<const Eigen::Vector3d>(a))
               .squaredNorm() /
           segments;
  }

  void Stencil(const Eigen::Vector3d*, double* k) const { k[0] = 1; }
};

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_POSITION_H_
