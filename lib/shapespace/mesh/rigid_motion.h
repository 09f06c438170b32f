#ifndef SHAPESPACE_MESH_RIGID_MOTION_H_
#define SHAPESPACE_MESH_RIGID_MOTION_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/shape.h>

namespace shapespace {

/// x -> rotation x + translation.
struct RigidMotion {
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  Shape operator()(const Shape& shape) const { return (rotation * shape).colwise() + translation; }
};

/// The weighted centroid of a shape; weights (one per vertex) need not have sum 1.
Eigen::Vector3d Centroid(const Shape& shape, const Eigen::VectorXd& weights);

/// The rotation R that maximises trace(R covariance); the smallest one if it is not unique.
Eigen::Matrix3d ProcrustesRotation(const Eigen::Matrix3d& covariance);

/// The rigid motion that maps `from` closest to `to` in the weighted L2 sense (Procrustes).
RigidMotion FitRigidMotion(const Shape& from, const Shape& to, const Eigen::VectorXd& weights);

/// Moves each inner shape rigidly such that sum_i |P_{i+1} - P_i|^2 (weighted) is minimal over all
/// such motions; the ends stay. The cost of rigid-invariant features does not change. The ends must
/// be centred at the origin.
void RemoveRigidDrift(std::vector<Shape>* shapes, const Eigen::VectorXd& weights);

/// The motion at t, interpolated between two (t in [0, 1]) or extrapolated: the rotation at
/// constant speed about one axis, and the image of the origin, which is the centroid of aligned
/// shapes, along a straight line.
RigidMotion InterpolateMotion(const RigidMotion& first, const RigidMotion& last, double t);

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_RIGID_MOTION_H_
