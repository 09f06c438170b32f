#include <shapespace/metric/rigid.h>

#include <Eigen/Eigenvalues>

namespace shapespace {

Eigen::Vector3d AngularVelocity(const Eigen::Matrix3d& inertia, const Eigen::Vector3d& moment) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(inertia);
  const Eigen::Vector3d& values = solver.eigenvalues();
  // If a moment of inertia is below this share of the largest one, all vertices lie on its axis.
  const double least = 1e-12 * values(2);
  Eigen::Vector3d result = Eigen::Vector3d::Zero();
  for (int i = 0; i < 3; ++i) {
    if (values(i) <= least) continue;
    const Eigen::Vector3d axis = solver.eigenvectors().col(i);
    result += axis * (axis.dot(moment) / values(i));
  }
  return result;
}

}  // namespace shapespace
