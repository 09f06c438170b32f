#include <shapespace/skinning/skinning.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/check_range.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/skinning/detail/fit_bones.h>
#include <shapespace/skinning/detail/joint_tree.h>
#include <shapespace/skinning/detail/moving_points.h>
#include <shapespace/summary/internal/check_options.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {
namespace {

using internal::FittedBones;
using internal::Format;
using internal::MovingPoints;

constexpr int kMostBones = 500;

// Half the diagonal of the bounding box, in the user's unit.
double HalfDiagonal(const Shape& rest) {
  return (rest.rowwise().maxCoeff() - rest.rowwise().minCoeff()).norm() / 2;
}

// Searches the least number of bones with which the root mean square distance is at most `error`:
// numbers grow by half until one suffices, and then the interval is halved.
class BoneSearch {
 public:
  BoneSearch(const MovingPoints& points, double error, const SkinningOptions& options,
             Progress* progress)
      : points_(points), error_(error), options_(options), progress_(progress) {}

  // Without bones that suffice, the most that are permitted.
  FittedBones Run() {
    int too_few = 0, enough = 1;
    while (!Suffice(enough)) {
      if (cancelled_ || enough == options_.most_bones) return std::move(best_);
      too_few = enough;
      enough = std::min(options_.most_bones, enough + (enough + 1) / 2);
    }
    while (enough - too_few > 1 && !cancelled_) {
      const int middle = (too_few + enough) / 2;
      (Suffice(middle) ? enough : too_few) = middle;
    }
    return std::move(best_);
  }

 private:
  // Whether that many bones suffice. Stores them if they do, or if none have sufficed yet.
  bool Suffice(int count) {
    FittedBones fitted = internal::FitBones(points_, count, options_, progress_);
    cancelled_ = fitted.termination == Termination::kCancelled;
    const bool suffice = fitted.errors.back() <= error_;
    if (suffice || !found_) best_ = std::move(fitted);
    found_ = found_ || suffice;
    if (cancelled_) best_.termination = Termination::kCancelled;
    return suffice;
  }

  const MovingPoints& points_;
  const double error_;
  const SkinningOptions& options_;
  Progress* const progress_;
  FittedBones best_;
  bool found_ = false, cancelled_ = false;
};

// Bones in the user's frame and unit, and weights for all vertices of the file.
SkinnedPath PlacedSkin(const Path& path, const MovingPoints& points, const FittedBones& fitted,
                       const SkinningOptions& options) {
  const internal::Bones& bones = fitted.bones;
  const double scale = path.metric->unit * points.size;
  // Of a shape: rotation and translation of points to the user's frame, after they are scaled.
  const auto rotation = [&](int i) -> const Eigen::Matrix3d& { return path.motions[i].rotation; };
  const auto translation = [&](int i) -> Eigen::Vector3d {
    return rotation(i) * (path.metric->unit * points.centroids.col(i)) +
           path.motions[i].translation;
  };
  const int rest = points.rest;
  SkinnedPath skinned;
  skinned.connectivity = path.metric->connectivity;
  skinned.rest = path.Placed(rest);
  skinned.parameters = path.parameters;
  skinned.provenance = path.provenance;
  skinned.appearance = path.appearance;
  for (int b = 0; b < bones.Count(); ++b) {
    Joint joint = bones.joints[b];
    joint.name = Format("bone_%02d", b + 1);
    joint.pivot = scale * (rotation(rest) * joint.pivot) + translation(rest);
    if (options.scale) joint.axes = (rotation(rest) * joint.axes).eval();
    skinned.joints.push_back(std::move(joint));
  }
  for (int i = 0; i < bones.shapes; ++i) {
    for (int b = 0; b < bones.Count(); ++b) {
      JointMotion motion = bones.motions[b * bones.shapes + i];
      motion.rotation = (rotation(i) * motion.rotation * rotation(rest).transpose()).eval();
      motion.place = scale * (rotation(i) * motion.place) + translation(i);
      skinned.motions.push_back(motion);
    }
  }
  const int vertices = path.metric->connectivity->NumVertices();
  skinned.bones = Eigen::MatrixXi::Zero(options.weights_per_vertex, vertices);
  skinned.weights = Eigen::MatrixXd::Zero(options.weights_per_vertex, vertices);
  skinned.bones(Eigen::all, points.vertices) = fitted.weights.bones;
  skinned.weights(Eigen::all, points.vertices) = fitted.weights.weights;
  path.metric->connectivity->CopyToTwins(&skinned.bones);
  path.metric->connectivity->CopyToTwins(&skinned.weights);
  return skinned;
}

// The errors of the result as it will be used, in the user's frame and unit.
void MeasureErrors(const Path& path, const SkinnedPath& skinned, const std::vector<int>& vertices,
                   SkinningSummary* summary) {
  const int shapes = path.NumShapes();
  summary->vertex_errors = Eigen::VectorXd::Zero(skinned.rest.cols());
  summary->shape_errors.resize(shapes);
  double greatest = -1;
  for (int i = 0; i < shapes; ++i) {
    const Eigen::VectorXd squares =
        (skinned.Skinned(i) - path.Placed(i)).colwise().squaredNorm().transpose();
    summary->vertex_errors += squares;
    double sum = 0;
    for (const int v : vertices) {
      sum += squares(v);
      if (squares(v) <= greatest) continue;
      greatest = squares(v);
      summary->max_error_vertex = v;
      summary->max_error_shape = i;
    }
    summary->shape_errors(i) = std::sqrt(sum / static_cast<double>(vertices.size()));
  }
  summary->vertex_errors = (summary->vertex_errors / shapes).cwiseSqrt();
  summary->max_error = std::sqrt(greatest);
  summary->error = std::sqrt(summary->shape_errors.squaredNorm() / shapes);
  summary->relative_error = summary->error / HalfDiagonal(skinned.rest);
}

void WarnOfFewBones(const SkinningOptions& options, SkinningSummary* summary) {
  if (options.bones == 0 || summary->bones == options.bones) return;
  summary->warnings.push_back(Format(
      "%d of the %d bones that were asked for have no use and are left out: the others move every "
      "vertex as well without them",
      options.bones - summary->bones, options.bones));
}

void WarnOfError(const SkinningOptions& options, SkinningSummary* summary) {
  if (options.bones > 0 || !(summary->relative_error > options.error) ||
      summary->termination == Termination::kCancelled) {
    return;
  }
  // Of cloth and of animals alike, the error is about inversely proportional to the number of
  // bones.
  summary->warnings.push_back(Format(
      "%d bones, the most that are permitted, leave an error of %.3g%% of half the diagonal, "
      "more than the %.3g%% asked for; that may need about %.0f bones",
      summary->bones, 100 * summary->relative_error, 100 * options.error,
      summary->bones * summary->relative_error / options.error));
}

}  // namespace

void SkinningOptions::Validate() const {
  internal::CheckRange("bones", bones, 0, kMostBones);
  if (!(error > 0 && error < 1)) throw InvalidOptions("error", "must be between 0 and 1");
  internal::CheckRange("most_bones", most_bones, 1, kMostBones);
  internal::CheckRange("weights_per_vertex", weights_per_vertex, 1, 8);
  if (rest < 0) throw InvalidOptions("rest", "must be 0 or more");
  internal::CheckTolerance(tolerance);
  internal::CheckMaxIterations(max_iterations);
}

SkinningResult Skin(const Path& path, const SkinningOptions& options, Progress* progress) {
  const internal::Stopwatch stopwatch;
  options.Validate();
  path.Validate();
  if (path.NumShapes() < 2) {
    throw MeshError(
        "a path of one shape has no motion from which bones could be found; give two "
        "shapes or more");
  }
  if (options.rest >= path.NumShapes()) {
    throw InvalidOptions("rest",
                         Format("must be less than the number of shapes, %d", path.NumShapes()));
  }
  ReportProgress(progress, "bones", 0, options.max_iterations);
  const MovingPoints points = internal::MakeMovingPoints(path, options.rest);
  const double unit = points.size * path.metric->unit;
  FittedBones fitted =
      options.bones > 0
          ? internal::FitBones(points, options.bones, options, progress)
          : BoneSearch(points, options.error * HalfDiagonal(path.Placed(options.rest)) / unit,
                       options, progress)
                .Run();
  internal::MakeSkeleton(points, fitted.errors.back(), &fitted.bones, &fitted.weights);

  SkinningResult result;
  result.path = PlacedSkin(path, points, fitted, options);
  SkinningSummary& summary = result.summary;
  summary.termination = fitted.termination;
  summary.vertices = path.metric->connectivity->NumVertices();
  summary.shapes = path.NumShapes();
  summary.bones = fitted.bones.Count();
  summary.iterations = static_cast<int>(fitted.errors.size()) - 1;
  for (const double error : fitted.errors) summary.errors.push_back(unit * error);
  MeasureErrors(path, result.path, points.vertices, &summary);
  WarnOfFewBones(options, &summary);
  WarnOfError(options, &summary);
  summary.total_seconds = stopwatch.Seconds();
  return result;
}

}  // namespace shapespace
