#ifndef SHAPESPACE_METRIC_EDGE_LENGTH_H_
#define SHAPESPACE_METRIC_EDGE_LENGTH_H_

#include <cmath>

#include <Eigen/Core>

namespace shapespace {

// A feature is one component of the map Phi whose pull-back is the metric (docs/mathematics.md,
// section 1): for every element, `operator()` maps the coordinates of its vertices (kVertices x 3,
// vertex after vertex) to kValues numbers, and the element adds weight * |change of them|^2 to what
// a motion costs. Besides, a feature states
//   kRigidInvariant  its values do not change under rigid motion,
//   kSum             the values of all elements are added up before the square is taken,
//   kTrapezoid       it has a form of its own in the paper's discretisation (trapezoid.h),
//   LeastChange      the least of sum_i |Phi_{i+1} - Phi_i|^2 over all paths of `segments` segments
//                    from value a to value b: the element's share in the lower bound,
//   Stencil          kStencils vectors k, each of a scalar per vertex, one after the other, such
//   that
//                    sum w k k^T resembles the metric's matrix, axis by axis: what the
//                    preconditioner is assembled from.

/// |e|^2 / 2 of an edge: the paper's metric (4), since its derivative along X is <X_p - X_q, p -
/// q>.
struct EdgeLength {
  static constexpr int kVertices = 2, kValues = 1, kStencils = 1;
  static constexpr bool kRigidInvariant = true, kSum = false, kTrapezoid = true;
  static constexpr const char* kName = "edge length";

  Eigen::Matrix2Xi stencils;  ///< 2 x elements
  Eigen::VectorXd weights;

  template <typename T>
  void operator()(const T* x, T* value) const {
    const T ex = x[3] - x[0], ey = x[4] - x[1], ez = x[5] - x[2];
    value[0] = 0.5 * (ex * ex + ey * ey + ez * ez);
  }

  double LeastChange(const double* a, const double* b, int segments) const {
    return (b[0] - a[0]) * (b[0] - a[0]) / segments;
  }

  // e e^T acts along the edge only; averaged over directions that would be |e|^2 / 3 a coordinate.
  // 0.6 makes the unit step of a quasi-Newton method acceptable from the first iteration on.
  void Stencil(const Eigen::Vector3d* x, double* k) const {
    k[1] = std::sqrt(0.6) * (x[1] - x[0]).norm();
    k[0] = -k[1];
  }
};

/// log |e| of an edge that is no side of a triangle: its strain, indifferent to the length itself.
struct LogLength {
  static constexpr int kVertices = 2, kValues = 1, kStencils = 1;
  static constexpr bool kRigidInvariant = true, kSum = false, kTrapezoid = false;
  static constexpr const char* kName = "log length";

  Eigen::Matrix2Xi stencils;
  Eigen::VectorXd weights;
  double epsilon_squared = 0;  ///< keeps the logarithm of a collapsed edge finite

  template <typename T>
  void operator()(const T* x, T* value) const {
    using std::log;
    const T ex = x[3] - x[0], ey = x[4] - x[1], ez = x[5] - x[2];
    value[0] = 0.5 * log(ex * ex + ey * ey + ez * ez + epsilon_squared);
  }

  double LeastChange(const double* a, const double* b, int segments) const {
    return (b[0] - a[0]) * (b[0] - a[0]) / segments;
  }

  void Stencil(const Eigen::Vector3d* x, double* k) const {
    k[1] = std::sqrt(0.6 / ((x[1] - x[0]).squaredNorm() + epsilon_squared));
    k[0] = -k[1];
  }
};

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_EDGE_LENGTH_H_
