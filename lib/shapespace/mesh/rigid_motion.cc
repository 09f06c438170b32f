#include <shapespace/mesh/rigid_motion.h>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <shapespace/base/parallel.h>

namespace shapespace {

Eigen::Vector3d Centroid(const Shape& shape, const Eigen::VectorXd& weights) {
  return shape * weights / weights.sum();
}

Eigen::Matrix3d ProcrustesRotation(const Eigen::Matrix3d& covariance) {
  // A small multiple of the identity selects the smallest rotation where the covariance does not
  // determine it.
  const double scale = covariance.norm();
  const Eigen::Matrix3d matrix = covariance + 1e-12 * scale * Eigen::Matrix3d::Identity();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Eigen::Vector3d sign(1, 1, 1);
  if ((svd.matrixV() * svd.matrixU().transpose()).determinant() < 0) sign(2) = -1;
  return svd.matrixV() * sign.asDiagonal() * svd.matrixU().transpose();
}

RigidMotion FitRigidMotion(const Shape& from, const Shape& to, const Eigen::VectorXd& weights) {
  const Eigen::Vector3d from_centre = Centroid(from, weights), to_centre = Centroid(to, weights);
  const Shape centred = from.colwise() - from_centre;
  RigidMotion motion;
  motion.rotation =
      ProcrustesRotation(centred * weights.asDiagonal() * (to.colwise() - to_centre).transpose());
  motion.translation = to_centre - motion.rotation * from_centre;
  return motion;
}

void RemoveRigidDrift(std::vector<Shape>* shapes, const Eigen::VectorXd& weights) {
  const int last = static_cast<int>(shapes->size()) - 1;
  ParallelFor(last - 1, [&](int i) {
    Shape& shape = (*shapes)[i + 1];
    const Eigen::Vector3d centre = Centroid(shape, weights);
    shape.colwise() -= centre;
  });
  // For centred shapes only rotations R_i remain, and the sum depends on the shapes only through
  // C_i = sum_p A_p p_i p_{i+1}^T.
  std::vector<Eigen::Matrix3d> covariance(last);
  ParallelFor(last, [&](int i) {
    covariance[i] = (*shapes)[i] * weights.asDiagonal() * (*shapes)[i + 1].transpose();
  });
  std::vector<Eigen::Matrix3d> rotation(last + 1, Eigen::Matrix3d::Identity());
  // Initial guess: each shape is aligned with the one before; the remaining rotation at the end is
  // distributed evenly.
  for (int i = 0; i < last; ++i) {
    rotation[i + 1] = ProcrustesRotation((rotation[i] * covariance[i]).transpose());
  }
  const Eigen::AngleAxisd amiss(Eigen::Matrix3d(rotation[last].transpose()));
  for (int i = 1; i <= last; ++i) {
    rotation[i] = Eigen::AngleAxisd(amiss.angle() * i / last, amiss.axis()) * rotation[i];
  }
  rotation[last].setIdentity();
  // Iterations: each rotation is replaced by the best one for its neighbours.
  constexpr int kMaxSweeps = 1000;
  constexpr double kStill = 1e-14;
  for (int sweep = 0; sweep < kMaxSweeps; ++sweep) {
    double change = 0;
    for (int i = 1; i < last; ++i) {
      const Eigen::Matrix3d better =
          ProcrustesRotation(covariance[i] * rotation[i + 1].transpose() +
                             covariance[i - 1].transpose() * rotation[i - 1].transpose());
      change = std::max(change, (better - rotation[i]).squaredNorm());
      rotation[i] = better;
    }
    if (change < kStill * kStill) break;
  }
  ParallelFor(last - 1, [&](int i) { (*shapes)[i + 1] = rotation[i + 1] * (*shapes)[i + 1]; });
}

RigidMotion InterpolateMotion(const RigidMotion& first, const RigidMotion& last, double t) {
  RigidMotion motion;
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(last.rotation * first.rotation.transpose()));
  motion.rotation = Eigen::AngleAxisd(t * turn.angle(), turn.axis()) * first.rotation;
  motion.translation = (1 - t) * first.translation + t * last.translation;
  return motion;
}

}  // namespace shapespace
