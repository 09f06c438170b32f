#include <shapespace/skinning/detail/fit_bones.h>

#include <utility>

#include <shapespace/skinning/detail/bone_motions.h>
#include <shapespace/skinning/detail/near_rigid_clusters.h>

namespace shapespace::internal {
namespace {

// The squared difference of weights along an edge counts as this share of the mean squared error of
// a point, for each point of the mesh: with finer meshes the sum of errors grows with their points,
// that of squared differences does not. Without it weights that two shapes determine are four times
// as rough; five times more has the error of a horse rise by a quarter.
constexpr double kSmoothness = 1e-3;

std::vector<char> UsedBones(const VertexWeights& weights, int count) {
  std::vector<char> is_used(count, 0);
  for (Eigen::Index i = 0; i < weights.weights.size(); ++i) {
    if (weights.weights(i) > 0) is_used[weights.bones(i)] = 1;
  }
  return is_used;
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
    const double squares = points.NumShapes() * error * error;  // of a point, on average
    FitWeights(points, bones, kSmoothness * points.NumPoints() * squares, &weights);
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
