#include <shapespace/skinning/detail/bone_motions.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>

#include <shapespace/base/parallel.h>

namespace shapespace::internal {
namespace {

using Matrix34 = Eigen::Matrix<double, 3, 4>;

// Levenberg and Marquardt: the damping, as a share of the diagonal, begins small, because steps are
// small after the first iterations, and a step is given up when it would have to be negligible.
constexpr double kFirstDamping = 1e-4, kMostDamping = 1e6, kDampingFactor = 10;

// A share of the greatest entry of the diagonal that makes the system regular where a bone moves
// nothing, or lies in a line about which it may turn.
constexpr double kRegular = 1e-12;

// Sums over points of products of weights and homogeneous rest positions.
struct Moments {
  // Of bones b and c at (4 b, 4 c): sums of w_b w_c rest rest^T.
  Eigen::MatrixXd products;
  // Of shape i and bone b at (3 i, 4 b): sums of w_b moved rest^T.
  Eigen::MatrixXd targets;
  Eigen::VectorXd squares;                 // of each shape: sum of squared positions
  std::vector<std::vector<int>> partners;  // bones that share points with each, itself included

  auto Products(int b, int c) const { return products.block<4, 4>(4 * b, 4 * c); }
};

Moments ComputeMoments(const MovingPoints& points, const VertexWeights& weights, int num_bones) {
  Moments moments;
  moments.products = Eigen::MatrixXd::Zero(4 * num_bones, 4 * num_bones);
  moments.targets = Eigen::MatrixXd::Zero(points.moved.rows(), 4 * num_bones);
  moments.squares.resize(points.NumShapes());
  moments.partners.resize(num_bones);
  const Eigen::Index most = weights.weights.rows();
  std::vector<std::vector<std::pair<int, double>>> points_of(num_bones);
  for (int p = 0; p < points.NumPoints(); ++p) {
    for (Eigen::Index k = 0; k < most; ++k) {
      const double weight = weights.weights(k, p);
      if (weight > 0) points_of[weights.bones(k, p)].emplace_back(p, weight);
    }
  }
  ParallelFor(num_bones, [&](int b) {
    std::vector<char> is_partner(num_bones, 0);
    Eigen::VectorXd moved(points.moved.rows());
    for (const auto& [p, weight] : points_of[b]) {
      const Eigen::Vector4d rest = points.Rest(p).homogeneous();
      const Eigen::Matrix4d square = rest * rest.transpose();
      for (Eigen::Index k = 0; k < most; ++k) {
        if (!(weights.weights(k, p) > 0)) continue;
        const int c = weights.bones(k, p);
        moments.products.block<4, 4>(4 * b, 4 * c) += weight * weights.weights(k, p) * square;
        is_partner[c] = 1;
      }
      moments.targets.middleCols<4>(4 * b).noalias() +=
          points.moved.col(p) * (weight * rest).transpose();
    }
    for (int c = 0; c < num_bones; ++c) {
      if (is_partner[c]) moments.partners[b].push_back(c);
    }
  });
  ParallelFor(points.NumShapes(),
              [&](int i) { moments.squares(i) = points.moved.middleRows<3>(3 * i).squaredNorm(); });
  return moments;
}

// The motions of all bones in one shape.
class ShapeFit {
 public:
  ShapeFit(const Moments& moments, int shape, bool scale, Bones* bones)
      : moments_(moments), shape_(shape), unknowns_(scale ? 9 : 6), bones_(*bones) {
    for (int b = 0; b < bones_.Count(); ++b) motions_.push_back(Motion(b));
    matrices_ = MatricesOf(motions_);
    energy_ = Energy(matrices_);
  }

  // One step. More gain little before weights follow.
  void Run() {
    Linearise();
    double damping = kFirstDamping;
    while (!Step(damping) && damping < kMostDamping) damping *= kDampingFactor;
    for (int b = 0; b < bones_.Count(); ++b) Motion(b) = motions_[b];
  }

 private:
  JointMotion& Motion(int b) { return bones_.motions[b * bones_.shapes + shape_]; }

  std::vector<Matrix34> MatricesOf(const std::vector<JointMotion>& motions) const {
    std::vector<Matrix34> matrices;
    for (size_t b = 0; b < motions.size(); ++b) {
      matrices.push_back(motions[b].Matrix(bones_.joints[b]));
    }
    return matrices;
  }

  auto Target(int b) const { return moments_.targets.block<3, 4>(3 * shape_, 4 * b); }

  // The sum of the squared distances of all points.
  double Energy(const std::vector<Matrix34>& matrices) const {
    double energy = moments_.squares(shape_);
    for (int b = 0; b < bones_.Count(); ++b) {
      Matrix34 sum = -2 * Target(b);
      for (const int c : moments_.partners[b]) sum += matrices[c] * moments_.Products(c, b);
      energy += matrices[b].cwiseProduct(sum).sum();
    }
    return energy;
  }

  // Derivatives of a bone's matrix: for a rotation about the pivot's place, a translation, and the
  // logarithms of the scales.
  void Derivatives(int b, std::vector<Matrix34>* derivatives) const {
    const Joint& joint = bones_.joints[b];
    const auto about_pivot = [&](const Eigen::Matrix3d& linear) {
      Matrix34 matrix;
      matrix << linear, -linear * joint.pivot;
      return matrix;
    };
    const Eigen::Matrix3d linear = matrices_[b].leftCols<3>();
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d axis = Eigen::Vector3d::Unit(k);
      Eigen::Matrix3d turned;
      for (int c = 0; c < 3; ++c) turned.col(c) = axis.cross(linear.col(c));
      (*derivatives)[unknowns_ * b + k] = about_pivot(turned);
      Matrix34 moved = Matrix34::Zero();
      moved(k, 3) = 1;
      (*derivatives)[unknowns_ * b + 3 + k] = moved;
      if (unknowns_ == 6) continue;
      const Eigen::Vector3d along = joint.axes.col(k);
      (*derivatives)[unknowns_ * b + 6 + k] =
          about_pivot(motions_[b].scale(k) * motions_[b].rotation * along * along.transpose());
    }
  }

  // Half the gradient of the energy, and half the Gauss-Newton approximation of its Hessian, whose
  // lower triangle alone is filled.
  void Linearise() {
    const int size = unknowns_ * bones_.Count();
    std::vector<Matrix34> derivatives(size);
    for (int b = 0; b < bones_.Count(); ++b) Derivatives(b, &derivatives);
    hessian_.setZero(size, size);
    gradient_.setZero(size);
    for (int b = 0; b < bones_.Count(); ++b) {
      Matrix34 residual = -Target(b);
      for (const int c : moments_.partners[b]) {
        residual += matrices_[c] * moments_.Products(c, b);
        if (c > b) continue;
        for (int k = unknowns_ * b; k < unknowns_ * (b + 1); ++k) {
          const Matrix34 product = derivatives[k] * moments_.Products(b, c);
          for (int l = unknowns_ * c; l < unknowns_ * (c + 1); ++l) {
            hessian_(k, l) = product.cwiseProduct(derivatives[l]).sum();
          }
        }
      }
      for (int k = unknowns_ * b; k < unknowns_ * (b + 1); ++k) {
        gradient_(k) = residual.cwiseProduct(derivatives[k]).sum();
      }
    }
  }

  // Tries a damped step; returns false, and changes nothing, unless it lowers the energy.
  bool Step(double damping) {
    Eigen::MatrixXd damped = hessian_;
    damped.diagonal() *= 1 + damping;
    damped.diagonal().array() += kRegular * hessian_.diagonal().maxCoeff();
    const Eigen::VectorXd step = damped.selfadjointView<Eigen::Lower>().ldlt().solve(-gradient_);
    std::vector<JointMotion> motions = motions_;
    for (int b = 0; b < bones_.Count(); ++b) {
      const auto part = step.segment(unknowns_ * b, unknowns_);
      const Eigen::Vector3d turn = part.head<3>();
      const double angle = turn.norm();
      if (angle > 0) {
        const Eigen::Quaterniond rotation(Eigen::AngleAxisd(angle, turn / angle) *
                                          Eigen::Quaterniond(motions[b].rotation));
        motions[b].rotation = rotation.normalized().toRotationMatrix();
      }
      motions[b].place += part.segment<3>(3);
      if (unknowns_ == 9) motions[b].scale.array() *= part.tail<3>().array().exp();
    }
    std::vector<Matrix34> matrices = MatricesOf(motions);
    const double energy = Energy(matrices);
    if (!(energy < energy_)) return false;
    motions_ = std::move(motions);
    matrices_ = std::move(matrices);
    energy_ = energy;
    return true;
  }

  const Moments& moments_;
  const int shape_;
  const int unknowns_;  // of a bone
  Bones& bones_;
  std::vector<JointMotion> motions_;
  std::vector<Matrix34> matrices_;
  double energy_ = 0;
  Eigen::MatrixXd hessian_;
  Eigen::VectorXd gradient_;
};

}  // namespace

void FitBoneMotions(const MovingPoints& points, const VertexWeights& weights, bool scale,
                    Bones* bones) {
  const Moments moments = ComputeMoments(points, weights, bones->Count());
  // At the centroid of what a bone moves, rotations and translations are the least coupled.
  for (int b = 0; b < bones->Count(); ++b) {
    const Eigen::Vector4d sums = moments.Products(b, b).col(3);
    if (!(sums(3) > 0)) continue;
    const Eigen::Vector3d pivot = sums.head<3>() / sums(3);
    MovePivot(pivot, b, points.rest, bones);
  }
  ParallelFor(bones->shapes, [&](int i) {
    if (i != points.rest) ShapeFit(moments, i, scale, bones).Run();
  });
  for (int b = 0; b < bones->Count(); ++b) bones->UpdateMatrices(b);
}

}  // namespace shapespace::internal
