#include <shapespace/skinning/detail/fit_bones.h>

#include <utility>

#include <shapespace/skinning/detail/bone_motions.h>
#include <shapespace/skinning/detail/near_rigid_clusters.h>

namespace shapespace::internal {
namespace {

std::vector<char> UsedBones(const VertexWeights& weights, int count) {
  std::vector<char> is_used(count, 0);
  for (Eigen::Index i = 0; i < weights.weights.size(); ++i) {
    if (weights.weights(i) > 0) is_used[weights.bones(i)] = 1;
  }
  return is_used;
}

// Has the first bone that moves no point follow the points whose error is the greatest, so that the
// next weights may use it.
void BeginUnusedBoneAnew(const MovingPoints& points, const VertexWeights& weights, Bones* bones) {
  const std::vector<char> is_used = UsedBones(weights, bones->Count());
  for (int b = 0; b < bones->Count(); ++b) {
    if (is_used[b]) continue;
    return BeginBone(points, SquaredErrors(points, *bones, weights), bones->Count(), b, bones);
  }
}

void RemoveUnusedBones(FittedBones* fitted) {
  const std::vector<int> number =
      fitted->bones.Keep(UsedBones(fitted->weights, fitted->bones.Count()));
  for (int& bone : fitted->weights.bones.reshaped()) bone = number[bone];
}

}  // namespace

FittedBones FitBones(const MovingPoints& points, int count, const SkinningOptions& options,
                     Progress* progress) {
  NearRigidClusters clusters = FindNearRigidClusters(points, count, kExactError);
  if (options.scale) SetPrincipalAxes(points, clusters.bone_of, &clusters.bones);
  FittedBones fitted;
  fitted.bones = std::move(clusters.bones);
  fitted.weights = OneBoneEach(clusters.bone_of, options.weights_per_vertex);
  double error = RootMeanSquare(points, SquaredErrors(points, fitted.bones, fitted.weights));
  fitted.errors = {error};
  for (int i = 0; i < options.max_iterations && error > kExactError; ++i) {
    if (progress != nullptr && !progress->Report("bones", i, options.max_iterations)) {
      fitted.termination = Termination::kCancelled;
      break;
    }
    Bones bones = fitted.bones;
    VertexWeights weights = fitted.weights;
    BeginUnusedBoneAnew(points, weights, &bones);
    FitWeights(points, bones, &weights);
    FitBoneMotions(points, weights, options.scale, &bones);
    const double last =
        std::exchange(error, RootMeanSquare(points, SquaredErrors(points, bones, weights)));
    if (error < last) {
      fitted.bones = std::move(bones);
      fitted.weights = std::move(weights);
      fitted.errors.push_back(error);
    }
    if (!(last - error > options.tolerance * last)) {
      fitted.termination = Termination::kConverged;
      break;
    }
  }
  if (fitted.errors.back() <= kExactError) fitted.termination = Termination::kConverged;
  RemoveUnusedBones(&fitted);
  return fitted;
}

}  // namespace shapespace::internal
