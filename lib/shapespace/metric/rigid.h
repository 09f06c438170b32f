#ifndef SHAPESPACE_METRIC_RIGID_H_
#define SHAPESPACE_METRIC_RIGID_H_

#include <Eigen/Core>

namespace shapespace {

/// The paper's as-rigid-as-possible metric (3): the part of a motion that remains after subtracting
/// the best velocity field of a rigid body, c_bar + c x p. Evaluated at the midpoint of a segment,
/// where it vanishes on finite rigid motions (Cayley: |c| = 2 tan(angle / 2)). It is not a feature.
struct RigidForm {
  Eigen::VectorXd weights;  ///< one per vertex; empty: the metric has no rigid part

  bool Active() const { return weights.size() > 0; }

  /// Residual of one vertex, 3 numbers, for given c and c_bar; `from` and `to` are its positions at
  /// the segment's ends.
  template <typename T>
  static void Residual(const T* from, const T* to, const T* c, const T* c_bar, T* residual) {
    const T mx = 0.5 * (from[0] + to[0]), my = 0.5 * (from[1] + to[1]),
            mz = 0.5 * (from[2] + to[2]);
    residual[0] = to[0] - from[0] - c_bar[0] - (c[1] * mz - c[2] * my);
    residual[1] = to[1] - from[1] - c_bar[1] - (c[2] * mx - c[0] * mz);
    residual[2] = to[2] - from[2] - c_bar[2] - (c[0] * my - c[1] * mx);
  }
};

/// The c that minimises sum w |X_p - c x m_p|^2 for centred X and m, given the moment b = sum w m_p
/// x X_p and the inertia sum w (|m_p|^2 I - m_p m_p^T). Components that are not determined
/// (collinear vertices) are zero.
Eigen::Vector3d AngularVelocity(const Eigen::Matrix3d& inertia, const Eigen::Vector3d& moment);

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_RIGID_H_
