#include <shapespace/statistics/assess.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/statistics/detail/size.h>
#include <shapespace/statistics/detail/weighted_poses.h>
#include <shapespace/statistics/internal/summary_fields.h>
#include <shapespace/summary/internal/json_of.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {
namespace {

double Diagonal(const Shape& shape) {
  return (shape.rowwise().maxCoeff() - shape.rowwise().minCoeff()).norm();
}

// Area-weighted mean over the vertices, after rigid alignment.
double MeanDistance(const Metric& metric, const Shape& shape, const Shape& truth) {
  const Shape moved = FitRigidMotion(shape, truth, metric.vertex_area)(shape);
  return (moved - truth).colwise().norm().dot(metric.vertex_area) / metric.vertex_area.sum();
}

Eigen::VectorXd LogLengths(const Metric& metric, const Shape& shape) {
  const Eigen::Matrix2Xi& edges = metric.connectivity->Edges();
  Eigen::VectorXd lengths(edges.cols());
  for (Eigen::Index e = 0; e < edges.cols(); ++e) {
    lengths(e) = std::log((shape.col(edges(1, e)) - shape.col(edges(0, e))).norm());
  }
  return lengths;
}

// Area-weighted; edges without length do not count.
double Rms(const Metric& metric, const Eigen::VectorXd& of_edges) {
  double sum = 0, area = 0;
  for (Eigen::Index e = 0; e < of_edges.size(); ++e) {
    if (!std::isfinite(of_edges(e))) continue;
    sum += metric.edge_area(e) * of_edges(e) * of_edges(e);
    area += metric.edge_area(e);
  }
  return area > 0 ? std::sqrt(sum / area) : 0;
}

class Assessor {
 public:
  Assessor(const std::shared_ptr<const Connectivity>& connectivity, internal::WeightedPoses kept,
           const AssessmentOptions& options, Progress* progress)
      : connectivity_(connectivity),
        poses_(std::move(kept.poses)),
        weights_(std::move(kept.weights)),
        options_(options),
        progress_(progress) {
    // As the models see them, so that the sizes that are no part of their shape do not matter.
    if (options.model.size == PoseSize::kRemove) internal::ScaleToMeanSize(*connectivity, &poses_);
    for (const Shape& pose : poses_) diagonal_ += Diagonal(pose) / poses_.size();
  }

  Assessment Run() {
    const internal::Stopwatch stopwatch;
    const ShapeModel model(Make(poses_, weights_));
    const int count = std::min(model.Modes().NumModes(), static_cast<int>(poses_.size()) - 2);
    assessment_.poses = static_cast<int>(poses_.size());
    assessment_.rows.resize(count);
    for (int k = 0; k < count; ++k) {
      ModelQuality& row = assessment_.rows[k];
      row.modes = k + 1;
      row.generalisation = row.generalisation_edges = row.specificity = row.beyond = 0;
      row.compactness = model.Modes().Share(k + 1);
    }
    for (size_t i = 0; i < poses_.size(); ++i) LeaveOut(i);
    for (int s = 0; s < options_.samples; ++s) DrawSample(model, s);
    assessment_.total_seconds = stopwatch.Seconds();
    return std::move(assessment_);
  }

 private:
  PoseModes Make(const std::vector<Shape>& poses, std::vector<double> weights) {
    ShapeModelOptions options = options_.model;
    options.average.certify = false;
    options.average.weights = std::move(weights);
    options.modes = 0;
    PoseModes modes = MakeShapeModel(connectivity_, poses, {}, options, progress_).modes;
    const int most = options_.model.modes;
    if (most > 0 && most < modes.NumModes()) return FirstModes(std::move(modes), most);
    return modes;
  }

  void LeaveOut(size_t pose) {
    ReportProgress(progress_, "leaving out poses", static_cast<int>(pose),
                   static_cast<int>(poses_.size()));
    std::vector<Shape> others = poses_;
    others.erase(others.begin() + pose);
    std::vector<double> weights = weights_;
    weights.erase(weights.begin() + pose);
    const ShapeModel model(Make(others, std::move(weights)));
    const Metric& metric = *model.Modes().metric;
    const Eigen::VectorXd lengths = LogLengths(metric, poses_[pose]);
    for (ModelQuality& row : assessment_.rows) {
      const int modes = std::min(row.modes, model.Modes().NumModes());
      const Shape shape = model.Coordinates(poses_[pose], options_.fit, modes, progress_).shape;
      const double share = 1.0 / poses_.size();
      row.generalisation += share * MeanDistance(metric, shape, poses_[pose]) / diagonal_;
      row.generalisation_edges += share * Rms(metric, LogLengths(metric, shape) - lengths);
    }
  }

  void DrawSample(const ShapeModel& model, int sample) {
    ReportProgress(progress_, "drawing random shapes", sample, options_.samples);
    const PoseModes& modes = model.Modes();
    const Metric& metric = *modes.metric;
    Eigen::VectorXd least = LogLengths(metric, modes.poses[0]), most = least;
    for (const Shape& pose : modes.poses) {
      const Eigen::VectorXd lengths = LogLengths(metric, pose);
      least = least.cwiseMin(lengths);
      most = most.cwiseMax(lengths);
    }
    const Eigen::VectorXd coordinates = model.Sample(options_.seed + sample);
    for (ModelQuality& row : assessment_.rows) {
      const ModelShape found = model.At(coordinates.head(row.modes), progress_);
      if (!found.Converged()) ++assessment_.unconverged;
      const Shape shape = found.shape / metric.unit;
      double nearest = std::numeric_limits<double>::infinity();
      for (const Shape& pose : modes.poses) {
        nearest = std::min(nearest, metric.unit * MeanDistance(metric, shape, pose));
      }
      const Eigen::VectorXd lengths = LogLengths(metric, shape);
      row.specificity += nearest / diagonal_ / options_.samples;
      row.beyond += Rms(metric, (lengths - most).cwiseMax(0) + (least - lengths).cwiseMax(0)) /
                    options_.samples;
    }
  }

  const std::shared_ptr<const Connectivity>& connectivity_;
  std::vector<Shape> poses_;
  const std::vector<double> weights_;
  const AssessmentOptions& options_;
  Progress* const progress_;
  double diagonal_ = 0;
  Assessment assessment_;
};

}  // namespace

void AssessmentOptions::Validate() const {
  model.Validate();
  if (samples < 1) throw InvalidOptions("samples", "must be 1 or more");
}

Assessment AssessShapeModel(const std::shared_ptr<const Connectivity>& connectivity,
                            const std::vector<Shape>& poses, const AssessmentOptions& options,
                            Progress* progress) {
  options.Validate();
  internal::WeightedPoses kept(poses, options.model.average.weights);
  if (kept.poses.size() < 3) {
    throw InvalidOptions(
        "", "an assessment leaves one pose out, and needs three or more of positive weight");
  }
  return Assessor(connectivity, std::move(kept), options, progress).Run();
}

std::string Assessment::FullReport() const {
  std::string text =
      "Modes  compactness  generalisation  (edges)  specificity  beyond the poses' edges\n";
  for (const ModelQuality& row : rows) {
    text +=
        internal::Format("%5d  %10.2f%%  %13.3f%%  %6.2f%%  %10.3f%%  %22.2f%%\n", row.modes,
                         100 * row.compactness, 100 * row.generalisation,
                         100 * row.generalisation_edges, 100 * row.specificity, 100 * row.beyond);
  }
  return text;
}

std::string Assessment::ToJson() const { return internal::TextOf(internal::JsonOf(*this)); }

}  // namespace shapespace
