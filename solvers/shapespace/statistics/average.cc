#include <shapespace/statistics/average.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/base/internal/task_group.h>
#include <shapespace/exponential/internal/nearest_shape.h>
#include <shapespace/statistics/detail/feature_chart.h>
#include <shapespace/statistics/detail/feature_statistics.h>
#include <shapespace/statistics/detail/memory.h>
#include <shapespace/statistics/detail/procrustes.h>
#include <shapespace/statistics/detail/weighted_poses.h>
#include <shapespace/summary/internal/check_options.h>
#include <shapespace/summary/internal/memory.h>

namespace shapespace {
namespace {

// Above it a warning is given: the poses are so different that a mean says little.
constexpr double kFar = 1.1;

// A refinement that lowers the energy by less than this share is the last.
constexpr double kLeastRefinement = 1e-5;
constexpr int kMaxRefinements = 20;

// The features of the blend of the poses, or of the pose, that is nearest to the mean features.
Shape Start(const FeatureMap& map, const std::vector<Shape>& poses, const Eigen::VectorXd& weights,
            const Eigen::VectorXd& wanted) {
  Shape blend = Shape::Zero(3, poses[0].cols());
  for (size_t i = 0; i < poses.size(); ++i) blend += weights(i) * poses[i];
  Shape best = blend;
  double least = (map.Values(blend) - wanted).squaredNorm();
  for (const Shape& pose : poses) {
    const double distance = (map.Values(pose) - wanted).squaredNorm();
    if (distance >= least) continue;
    least = distance;
    best = pose;
  }
  return best;
}

// Of log edge lengths, from their means over the poses; edges without length do not count.
double EdgesOff(const Metric& metric, const std::vector<Shape>& poses,
                const Eigen::VectorXd& weights, const Shape& shape) {
  const Eigen::Matrix2Xi& edges = metric.connectivity->Edges();
  const auto length = [&](const Shape& x, Eigen::Index e) {
    return (x.col(edges(1, e)) - x.col(edges(0, e))).norm();
  };
  double sum = 0, area = 0;
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    double mean = 0;
    for (size_t i = 0; i < poses.size(); ++i) mean += weights(i) * std::log(length(poses[i], e));
    const double off = std::log(length(shape, e)) - mean;
    if (!std::isfinite(off)) continue;
    sum += metric.edge_area(e) * off * off;
    area += metric.edge_area(e);
  }
  return area > 0 ? std::sqrt(sum / area) : kNotComputed;
}

// For geodesics of which only the energy and the velocity are used.
GeodesicOptions NotAssessed(GeodesicOptions options) {
  options.assess = false;
  return options;
}

// A shape with geodesics to all poses.
struct GeodesicFan {
  Shape centre;       // in the user's unit
  double energy = 0;  // the weighted mean of the squared lengths
  // The features of the centre moved by the weighted mean of the geodesics' velocities.
  Eigen::VectorXd mean_of_ends;
};

class GeodesicFans {
 public:
  GeodesicFans(const FeatureMap& map, const std::shared_ptr<const Connectivity>& connectivity,
               const std::vector<Shape>& poses, const Eigen::VectorXd& weights,
               const GeodesicOptions& options, Progress* progress)
      : map_(map),
        poses_(poses),
        weights_(weights),
        segments_(options.shapes + 1),
        progress_(progress),
        interpolator_(connectivity, poses, NotAssessed(options)) {}

  GeodesicFan From(const Shape& centre) const {
    const int count = static_cast<int>(poses_.size());
    std::vector<Arm> arms(count);
    internal::TaskGroup group(progress_, "comparing with the lower bound", count);
    group.RunAll(interpolator_.MostAtOnce(), [&](int i, Progress* progress) {
      const GeodesicResult result = interpolator_.Between(centre, poses_[i], progress);
      if (result.summary.termination == Termination::kCancelled) throw Cancelled();
      arms[i] = {result.path.shapes[0], result.path.shapes[1], result.summary.energy};
    });
    const internal::FeatureChart chart(map_, map_.Values(arms[0].centre));
    GeodesicFan fan;
    fan.centre = centre;
    Eigen::VectorXd velocity = Eigen::VectorXd::Zero(chart.Centre().size());
    for (int i = 0; i < count; ++i) {
      fan.energy += weights_(i) * arms[i].energy;
      velocity += weights_(i) * segments_ * chart.Log(map_.Values(arms[i].next));
    }
    fan.mean_of_ends = chart.Exp(velocity);
    return fan;
  }

 private:
  // The geodesic to a pose: its first shape, the centre, and the next (metric's unit).
  struct Arm {
    Shape centre, next;
    double energy = 0;
  };

  const FeatureMap& map_;
  const std::vector<Shape>& poses_;
  const Eigen::VectorXd& weights_;
  const int segments_;
  Progress* const progress_;
  const Interpolator interpolator_;
};

}  // namespace

void AverageOptions::Validate() const {
  geodesic.Validate();
  double sum = 0;
  for (const double weight : weights) {
    if (!(weight >= 0) || !std::isfinite(weight)) {
      throw InvalidOptions("weights", "must be finite and not negative");
    }
    sum += weight;
  }
  if (!weights.empty() && !(sum > 0 && std::isfinite(sum))) {
    throw InvalidOptions("weights", "must not all be zero");
  }
  internal::CheckTolerance(tolerance);
  internal::CheckMaxIterations(max_iterations);
  if (geodesic.metric.discretization == Discretization::kTrapezoid) {
    throw InvalidOptions("discretization", "an average takes the midpoint form only");
  }
  if (geodesic.metric.rigid > 0) {
    throw InvalidOptions("rigid", "is no feature, of which a mean could be taken");
  }
}

AverageResult Average(const std::shared_ptr<const Connectivity>& connectivity,
                      const std::vector<Shape>& given, const AverageOptions& options,
                      Progress* progress) {
  const internal::Stopwatch total;
  options.Validate();
  if (given.empty()) throw MeshError("there is no pose of which to take the average");
  const internal::WeightedPoses kept(given, options.weights);
  const std::vector<Shape>& poses = kept.poses;
  Eigen::VectorXd weights =
      Eigen::Map<const Eigen::VectorXd>(kept.weights.data(), kept.weights.size());
  weights /= weights.sum();
  const auto metric =
      FreezeMetric(options.geodesic.metric, connectivity, poses, 0, PosePairs::kAll);
  AverageResult result;
  AverageSummary& summary = result.summary;
  summary.vertices = connectivity->NumVertices();
  summary.triangles = connectivity->NumTriangles();
  summary.poses = static_cast<int>(poses.size());
  summary.metric = DescribeMetric(metric->options);
  summary.unit = metric->unit;
  summary.estimated_bytes = internal::AverageBytes(*metric, summary.poses);
  internal::CheckMemory("this average", summary.estimated_bytes, options.geodesic.memory_limit,
                        "name fewer poses");
  ReportProgress(progress, "averaging", 0, 0);

  const AlignedPoses aligned = internal::AlignToMean(*metric, poses, weights);
  const FeatureMap map(metric);
  const internal::FeatureStatistics statistics(map, aligned.shapes, weights);
  summary.variance = statistics.Variance();
  summary.ambiguous_hinges = statistics.AmbiguousHinges();
  const double rounding = 1e3 * std::numeric_limits<double>::epsilon() * statistics.Mean().norm();
  const double least = std::max(options.tolerance * summary.variance, rounding * rounding);
  internal::MetricSolver solver;
  const internal::NearestShape nearest = internal::FindNearestShape(
      map, statistics.Mean(), Start(map, aligned.shapes, weights, statistics.Mean()),
      {least, options.max_iterations}, [&] { ReportProgress(progress, "averaging", 0, 0); },
      &solver);
  summary.iterations = nearest.iterations;
  summary.termination = nearest.termination;
  if (summary.variance > rounding * rounding) {
    summary.residual = nearest.squared_distance / summary.variance;
  }
  const RigidMotion place = internal::MeanMotion(aligned, weights);
  result.shape = place(metric->unit * nearest.shape);

  const bool certify = options.certify || options.refine;
  if (certify && !(summary.variance > rounding * rounding)) {
    summary.energy = summary.lower_bound = 0;  // copies of one shape, which is the mean
  } else if (certify) {
    const internal::Stopwatch stopwatch;
    try {
      GeodesicFans fans(map, connectivity, poses, weights, options.geodesic, progress);
      GeodesicFan fan = fans.From(result.shape);
      const double before = fan.energy;
      // Karcher's iteration: the centre moves by the mean of the velocities towards the poses.
      while (options.refine && summary.refinements < kMaxRefinements) {
        const Eigen::Vector3d place = Centroid(fan.centre, metric->vertex_area);
        const internal::NearestShape moved = internal::FindNearestShape(
            map, fan.mean_of_ends, (fan.centre.colwise() - place) / metric->unit,
            {least, options.max_iterations}, [&] { ReportProgress(progress, "averaging", 0, 0); },
            &solver);
        GeodesicFan next = fans.From((metric->unit * moved.shape).colwise() + place);
        ++summary.refinements;
        if (!(next.energy < fan.energy)) break;
        const bool last = next.energy > (1 - kLeastRefinement) * fan.energy;
        fan = std::move(next);
        if (last) break;
      }
      result.shape = fan.centre;
      summary.energy = fan.energy;
      if (options.refine) summary.refined_by = 1 - fan.energy / before;
      summary.lower_bound = statistics.LowerBound(options.geodesic.shapes + 1);
    } catch (const Cancelled&) {
      summary.termination = Termination::kCancelled;
      summary.refinements = 0;  // their shapes are lost
    }
    summary.certificate_seconds = stopwatch.Seconds();
  }
  connectivity->CopyToTwins(&result.shape);
  summary.edge_rms = EdgesOff(*metric, aligned.shapes, weights, result.shape / metric->unit);
  if (summary.Ratio() > kFar) {
    summary.warnings.push_back(
        "the poses are so different that the average says little: its distances from them are " +
        std::to_string(std::lround(100 * (summary.Ratio() - 1))) + " % above the lower bound");
  }
  if (summary.ambiguous_hinges > 0) {
    summary.warnings.push_back(std::to_string(summary.ambiguous_hinges) +
                               " hinges are bent in so different ways that their mean angle is not "
                               "determined");
  }
  summary.total_seconds = total.Seconds();
  return result;
}

AverageResult Average(const Poses& poses, const AverageOptions& options, Progress* progress) {
  return Average(poses.connectivity, poses.shapes, options, progress);
}

}  // namespace shapespace
