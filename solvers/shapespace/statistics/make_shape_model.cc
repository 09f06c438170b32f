#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Eigenvalues>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/statistics/detail/feature_statistics.h>
#include <shapespace/statistics/detail/logarithms.h>
#include <shapespace/statistics/detail/size.h>
#include <shapespace/statistics/detail/weighted_poses.h>
#include <shapespace/statistics/shape_model.h>
#include <shapespace/summary/internal/memory.h>

namespace shapespace {
namespace {

// A mode exists if its variance is more than this, in squares of the metric's unit, and more than
// this share of the first mode's; below are rounding errors.
constexpr double kLeastVariance = 1e-16, kLeastShare = 1e-10;

// Above this share of the variance the mean features belong to no shape.
constexpr double kFarFeatures = 0.03;

// Of displacements, in the area-weighted L2 product, times the roots of the weights.
Eigen::MatrixXd GramMatrix(const std::vector<Tangent>& logs, const PoseModes& modes) {
  const int count = modes.NumPoses();
  Eigen::MatrixXd gram(count, count);
  for (int i = 0; i < count; ++i) {
    const Tangent weighted = logs[i] * modes.metric->vertex_area.asDiagonal();
    for (int j = 0; j <= i; ++j) {
      gram(i, j) = gram(j, i) =
          std::sqrt(modes.weights(i) * modes.weights(j)) * weighted.cwiseProduct(logs[j]).sum();
    }
  }
  return gram;
}

// The eigenvector's sign is arbitrary: its entry of the greatest absolute value is made positive.
void FixSign(Eigen::VectorXd* vector) {
  Eigen::Index at;
  vector->cwiseAbs().maxCoeff(&at);
  if ((*vector)(at) < 0) *vector = -*vector;
}

void FindModes(const std::vector<Tangent>& logs, int wanted, PoseModes* modes,
               ShapeModelSummary* summary) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> solver(GramMatrix(logs, *modes));
  const int count = modes->NumPoses();
  const Eigen::VectorXd values = solver.eigenvalues().reverse();
  while (summary->rank < count &&
         values(summary->rank) > std::max(kLeastVariance, kLeastShare * values(0))) {
    ++summary->rank;
  }
  if (wanted > summary->rank) {
    throw InvalidOptions("modes", "must be at most " + std::to_string(summary->rank) +
                                      ": the poses vary in no more dimensions");
  }
  summary->modes = wanted > 0 ? wanted : summary->rank;
  modes->total_variance = values.head(summary->rank).sum();
  for (int k = 0; k < summary->rank; ++k) {
    summary->variances.push_back(values(k) / modes->total_variance);
  }
  modes->variances = values.head(summary->modes);
  modes->coefficients.resize(count, summary->modes);
  for (int k = 0; k < summary->modes; ++k) {
    Eigen::VectorXd vector = solver.eigenvectors().col(count - 1 - k);
    FixSign(&vector);
    modes->coefficients.col(k) = modes->weights.cwiseSqrt().cwiseProduct(vector);
    Tangent mode = Tangent::Zero(3, modes->mean.cols());
    for (int i = 0; i < count; ++i) mode += modes->coefficients(i, k) * logs[i];
    modes->modes.push_back(std::move(mode));
  }
}

void Warn(const PoseModes& modes, const ShapeModelOptions& options, ShapeModelSummary* summary) {
  summary->warnings = summary->average.warnings;
  if (modes.NumPoses() == 1) {
    summary->warnings.push_back("there is one pose, which is the mean; it has no modes");
  } else if (summary->rank == 0) {
    summary->warnings.push_back("the poses are the same shape, which is the mean; it has no modes");
  }
  if (summary->average.residual > kFarFeatures) {
    summary->warnings.push_back(
        "the poses are so different that no shape has nearly their mean lengths and angles: the "
        "modes say little (" +
        std::to_string(std::lround(100 * summary->average.residual)) + " % of the variance)");
  }
  if (options.average.geodesic.metric.isometric > 0) {
    summary->warnings.push_back(
        "under an isometric metric some shapes at coordinates do not converge; strain is the "
        "metric of choice");
  }
}

}  // namespace

void ShapeModelOptions::Validate() const {
  average.Validate();
  if (modes < 0) throw InvalidOptions("modes", "must be 0 or more");
}

ShapeModelResult MakeShapeModel(const std::shared_ptr<const Connectivity>& connectivity,
                                const std::vector<Shape>& given,
                                const std::vector<std::string>& names,
                                const ShapeModelOptions& options, Progress* progress) {
  const internal::Stopwatch total;
  options.Validate();
  if (given.empty()) throw MeshError("there is no pose of which to find modes");
  ShapeModelResult result;
  auto& [modes, summary] = result;
  if (!names.empty() && names.size() != given.size()) {
    throw InvalidOptions("names", "must be " + std::to_string(given.size()) +
                                      ", one for each pose, not " + std::to_string(names.size()));
  }
  modes.size = options.size;
  internal::WeightedPoses kept(given, options.average.weights);
  std::vector<Shape>& poses = kept.poses;
  for (const size_t i : kept.which) {
    modes.names.push_back(names.empty() ? std::to_string(i + 1) : names[i]);
  }
  modes.weights = Eigen::Map<Eigen::VectorXd>(kept.weights.data(), kept.weights.size());
  modes.weights /= modes.weights.sum();
  if (options.size == PoseSize::kRemove) internal::ScaleToMeanSize(*connectivity, &poses);

  AverageOptions of_average = options.average;
  of_average.weights = kept.weights;
  AverageResult average = Average(connectivity, poses, of_average, progress);
  summary.average = std::move(average.summary);
  modes.metric =
      FreezeMetric(options.average.geodesic.metric, connectivity, poses, 0, PosePairs::kAll);
  const Metric& metric = *modes.metric;
  modes.place.translation = Centroid(average.shape, metric.vertex_area);
  modes.mean = (average.shape.colwise() - modes.place.translation) / metric.unit;
  for (const Shape& pose : poses) {
    const Shape own = pose / metric.unit;
    const RigidMotion motion = FitRigidMotion(own, modes.mean, metric.vertex_area);
    modes.poses.push_back(motion(own));
    connectivity->CopyToTwins(&modes.poses.back());
    const Eigen::Matrix3d back = motion.rotation.transpose();
    modes.motions.push_back({back, -metric.unit * back * motion.translation});
  }

  const FeatureMap map(modes.metric);
  const internal::FeatureStatistics statistics(map, modes.poses, modes.weights);
  const internal::FeatureChart chart(map, statistics.Mean());
  const internal::Logarithms logarithms(map, chart, modes.mean);
  std::vector<Tangent> logs;
  for (int i = 0; i < modes.NumPoses(); ++i) {
    ReportProgress(progress, "finding modes", i, modes.NumPoses());
    logs.push_back(logarithms.Of(chart.Log(map.Values(modes.poses[i]))));
  }
  FindModes(logs, options.modes, &modes, &summary);
  Warn(modes, options, &summary);
  summary.total_seconds = total.Seconds();
  return result;
}

}  // namespace shapespace
