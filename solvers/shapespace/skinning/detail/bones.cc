#include <shapespace/skinning/detail/bones.h>

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <shapespace/mesh/rigid_motion.h>

namespace shapespace::internal {

void Bones::Append() {
  joints.emplace_back();
  motions.resize(motions.size() + shapes);
  matrices.conservativeResize(3 * shapes, 4 * Count());
  UpdateMatrices(Count() - 1);
}

void Bones::UpdateMatrices(int bone) {
  for (int i = 0; i < shapes; ++i) {
    matrices.block<3, 4>(3 * i, 4 * bone) = motions[bone * shapes + i].Matrix(joints[bone]);
  }
}

void Bones::Select(const std::vector<int>& kept) {
  Bones selected;
  selected.shapes = shapes;
  for (const int bone : kept) {
    selected.joints.push_back(joints[bone]);
    selected.motions.insert(selected.motions.end(), motions.begin() + bone * shapes,
                            motions.begin() + (bone + 1) * shapes);
  }
  selected.matrices.resize(3 * shapes, 4 * selected.Count());
  for (int bone = 0; bone < selected.Count(); ++bone) selected.UpdateMatrices(bone);
  *this = std::move(selected);
}

std::vector<int> Bones::Keep(const std::vector<char>& is_used) {
  std::vector<int> kept, number(is_used.size(), 0);
  for (size_t bone = 0; bone < is_used.size(); ++bone) {
    if (!is_used[bone]) continue;
    number[bone] = static_cast<int>(kept.size());
    kept.push_back(static_cast<int>(bone));
  }
  Select(kept);
  return number;
}

void FitBone(const MovingPoints& points, const std::vector<int>& part, int bone, Bones* bones) {
  const double count = static_cast<double>(part.size());
  Eigen::VectorXd mean = Eigen::VectorXd::Zero(points.moved.rows());
  for (const int p : part) mean += points.moved.col(p);
  mean /= count;
  const Eigen::Vector3d pivot = mean.segment<3>(3 * points.rest);
  // Three rows per shape: sums of (moved - mean) (rest - pivot)^T.
  Eigen::Matrix<double, Eigen::Dynamic, 3> covariances =
      Eigen::Matrix<double, Eigen::Dynamic, 3>::Zero(points.moved.rows(), 3);
  for (const int p : part) {
    covariances.noalias() += (points.moved.col(p) - mean) * (points.Rest(p) - pivot).transpose();
  }
  bones->joints[bone].pivot = pivot;
  for (int i = 0; i < bones->shapes; ++i) {
    JointMotion& motion = bones->motions[bone * bones->shapes + i];
    motion = JointMotion();
    if (i != points.rest) {
      motion.rotation = ProcrustesRotation(covariances.middleRows<3>(3 * i).transpose());
    }
    motion.place = mean.segment<3>(3 * i);
  }
  bones->UpdateMatrices(bone);
}

void MovePivot(const Eigen::Vector3d& pivot, int bone, int rest, Bones* bones) {
  for (int i = 0; i < bones->shapes; ++i) {
    Eigen::Vector3d& place = bones->motions[bone * bones->shapes + i].place;
    place = i == rest ? pivot
                      : (bones->matrices.block<3, 4>(3 * i, 4 * bone) * pivot.homogeneous()).eval();
  }
  bones->joints[bone].pivot = pivot;
  bones->UpdateMatrices(bone);
}

void SetPrincipalAxes(const MovingPoints& points, const std::vector<int>& bone_of, Bones* bones) {
  std::vector<Eigen::Matrix3d> spread(bones->Count(), Eigen::Matrix3d::Zero());
  for (int p = 0; p < points.NumPoints(); ++p) {
    const Eigen::Vector3d arm = points.Rest(p) - bones->joints[bone_of[p]].pivot;
    spread[bone_of[p]] += arm * arm.transpose();
  }
  for (int bone = 0; bone < bones->Count(); ++bone) {
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> solver(spread[bone]);
    Eigen::Matrix3d& axes = bones->joints[bone].axes;
    axes = solver.eigenvectors();
    if (axes.determinant() < 0) axes.col(0) = -axes.col(0);
    bones->UpdateMatrices(bone);
  }
}

}  // namespace shapespace::internal
