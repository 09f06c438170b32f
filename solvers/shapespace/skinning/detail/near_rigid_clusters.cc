#include <shapespace/skinning/detail/near_rigid_clusters.h>

#include <algorithm>

#include <shapespace/base/parallel.h>

namespace shapespace::internal {
namespace {

// Averages of errors over neighbours before the worst point is chosen. Of 0, 1, 2, 4 and 10, 2 led
// to the least errors of the cat of Sumner and Popovic.
constexpr int kAverages = 2;

// A new bone begins with this share of the points that a bone has on average, and with a whole
// component if that is smaller than kLeastPatch.
constexpr double kPatchShare = 0.25;
constexpr int kLeastPatch = 5;

// The point about which errors are the greatest on average, of those whose own is not below the
// mean, so that a bone which begins there has something to gain.
int WorstPoint(const MovingPoints& points, const Eigen::VectorXd& squared_errors) {
  Eigen::VectorXd errors = squared_errors;
  for (int round = 0; round < kAverages; ++round) {
    Eigen::VectorXd averages = errors;
    for (int p = 0; p < points.NumPoints(); ++p) {
      for (const int neighbour : points.neighbours[p]) averages(p) += errors(neighbour);
      averages(p) /= 1 + points.neighbours[p].size();
    }
    errors = averages;
  }
  const double mean = squared_errors.mean();
  int worst = 0;
  squared_errors.maxCoeff(&worst);
  for (int p = 0; p < points.NumPoints(); ++p) {
    if (squared_errors(p) >= mean && errors(p) > errors(worst)) worst = p;
  }
  return worst;
}

// Points about `seed`, in the order of their distance in edges; fewer than `size` if its component
// is smaller.
std::vector<int> PatchAround(const MovingPoints& points, int seed, size_t size) {
  std::vector<int> patch = {seed};
  std::vector<char> is_in(points.NumPoints(), 0);
  is_in[seed] = 1;
  for (size_t i = 0; i < patch.size() && patch.size() < size; ++i) {
    for (const int neighbour : points.neighbours[patch[i]]) {
      if (is_in[neighbour]) continue;
      is_in[neighbour] = 1;
      patch.push_back(neighbour);
    }
  }
  return patch;
}

// Has `bone` move as a patch of points does where errors are the greatest; fewer points if that
// does not lower the error there.
void MoveWithWorst(const MovingPoints& points, const Eigen::VectorXd& squared_errors, int count,
                   int bone, Bones* bones) {
  const int seed = WorstPoint(points, squared_errors);
  const int size =
      std::max(kLeastPatch, static_cast<int>(kPatchShare * points.NumPoints() / count));
  std::vector<int> patch = PatchAround(points, seed, size);
  const auto error = [&] {
    return (bones->MatricesOf(bone) * points.Rest(seed).homogeneous() - points.moved.col(seed))
        .squaredNorm();
  };
  FitBone(points, patch, bone, bones);
  while (patch.size() > 1 && !(error() < squared_errors(seed))) {
    patch.resize(patch.size() / 2);
    FitBone(points, patch, bone, bones);
  }
}

// Clusters while they are made.
class Clustering {
 public:
  Clustering(const MovingPoints& points, int count)
      : points_(points), count_(count), bone_of_(points.NumPoints(), 0) {
    bones_.shapes = points.NumShapes();
    errors_.resize(count, points.NumPoints());
    bones_.Append();
    std::vector<int> all(points.NumPoints());
    for (int p = 0; p < points.NumPoints(); ++p) all[p] = p;
    FitBone(points_, all, 0, &bones_);
    changed_ = {0};
    UpdateErrors();
  }

  // Root mean square distance of points from where their bones move them.
  double Error() const { return RootMeanSquare(points_, SquaredErrors()); }

  // Begins a bone where the error is greatest: one that no point follows, or a new one. Returns
  // false if all bones have begun.
  bool BeginBone() {
    const auto parts = Parts();
    int bone = 0;
    while (bone < bones_.Count() && !parts[bone].empty()) ++bone;
    if (bone == count_) return false;
    if (bone == bones_.Count()) bones_.Append();
    MoveWithWorst(points_, SquaredErrors(), count_, bone, &bones_);
    changed_ = {bone};
    UpdateErrors();
    return true;
  }

  // Has points follow the nearest bone, and bones their points.
  void Improve() {
    std::vector<char> has_changed(bones_.Count(), 0);
    for (int p = 0; p < points_.NumPoints(); ++p) {
      int best = bone_of_[p];
      for (int b = 0; b < bones_.Count(); ++b) {
        if (errors_(b, p) < errors_(best, p)) best = b;
      }
      if (best == bone_of_[p]) continue;
      has_changed[best] = has_changed[bone_of_[p]] = 1;
      bone_of_[p] = best;
    }
    const auto parts = Parts();
    changed_.clear();
    for (int b = 0; b < bones_.Count(); ++b) {
      if (has_changed[b] && !parts[b].empty()) changed_.push_back(b);
    }
    ParallelFor(static_cast<int>(changed_.size()),
                [&](int i) { FitBone(points_, parts[changed_[i]], changed_[i], &bones_); });
    UpdateErrors();
  }

  // The bones that points follow.
  NearRigidClusters Result() const {
    NearRigidClusters result{bones_, bone_of_};
    std::vector<char> is_followed(bones_.Count(), 0);
    for (const int bone : bone_of_) is_followed[bone] = 1;
    const std::vector<int> number = result.bones.Keep(is_followed);
    for (int& bone : result.bone_of) bone = number[bone];
    return result;
  }

 private:
  // Squared distance of each point from where its bone moves it, summed over shapes.
  Eigen::VectorXd SquaredErrors() const {
    Eigen::VectorXd errors(points_.NumPoints());
    for (int p = 0; p < points_.NumPoints(); ++p) errors(p) = errors_(bone_of_[p], p);
    return errors;
  }

  std::vector<std::vector<int>> Parts() const {
    std::vector<std::vector<int>> parts(bones_.Count());
    for (int p = 0; p < points_.NumPoints(); ++p) parts[bone_of_[p]].push_back(p);
    return parts;
  }

  // The squared distances of all points from where the bones that have changed move them.
  void UpdateErrors() {
    ForRunsOfPoints(points_.NumPoints(), [&](int begin, int end) {
      Eigen::VectorXd residual(points_.moved.rows());
      for (int p = begin; p < end; ++p) {
        const Eigen::Vector4d rest = points_.Rest(p).homogeneous();
        for (const int b : changed_) {
          residual = -points_.moved.col(p);
          residual.noalias() += bones_.MatricesOf(b) * rest;
          errors_(b, p) = residual.squaredNorm();
        }
      }
    });
  }

  const MovingPoints& points_;
  const int count_;
  Bones bones_;
  std::vector<int> bone_of_;
  Eigen::MatrixXd errors_;    // bones x points
  std::vector<int> changed_;  // bones whose errors are to be computed anew
};

}  // namespace

NearRigidClusters FindNearRigidClusters(const MovingPoints& points, int count, double exact) {
  Clustering clustering(points, count);
  for (int begun = 1; begun < count && clustering.Error() > exact; ++begun) {
    if (!clustering.BeginBone()) break;
    clustering.Improve();
  }
  return clustering.Result();
}

}  // namespace shapespace::internal
