#include <shapespace/transfer/transfer.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <shapespace/analysis/quality.h>
#include <shapespace/base/error.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/base/internal/sub_progress.h>
#include <shapespace/contact/internal/slide.h>
#include <shapespace/mesh/different_meshes.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/mesh/mirrored.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/mesh/seams.h>
#include <shapespace/path/align.h>
#include <shapespace/summary/internal/check_options.h>
#include <shapespace/summary/internal/memory.h>
#include <shapespace/transfer/detail/feature_transfer.h>
#include <shapespace/transfer/detail/ladder.h>
#include <shapespace/transfer/detail/memory.h>

namespace shapespace {
namespace {

// The geodesic's share of the time that a pose's geodesic and its transfer take together.
constexpr double kGeodesicShare = 0.1;

Path PathOfPlaced(const std::shared_ptr<const Metric>& metric, const std::vector<Shape>& placed,
                  std::vector<double> parameters, std::string provenance) {
  Path path = MakePath(metric, placed, std::move(parameters));
  path.poses.clear();
  path.provenance = std::move(provenance);
  return path;
}

// The target's path: the target itself and the shapes computed from it.
Path PathOfTarget(const std::shared_ptr<const Metric>& metric, const std::vector<Shape>& placed,
                  std::vector<double> parameters, std::string provenance) {
  Path path = PathOfPlaced(metric, placed, std::move(parameters), std::move(provenance));
  path.poses = {0};
  path.extrapolated = path.NumShapes() - 1;
  return path;
}

// Measures the difference between the changes of target and source since their first shapes.
void MeasureTransferErrors(const Metric& metric, const Path& source, const Path& target,
                           TransferSummary* summary) {
  const auto change = [](const Path& path, const auto& value) {
    const auto first = value(path.shapes.front());
    auto last = value(path.shapes.back());
    last -= first;  // not an expression template, which would outlive its operands
    return last;
  };
  const Eigen::Matrix2Xi& edges = metric.connectivity->Edges();
  double squares = 0, area = 0;
  for (int e = 0; e < edges.cols(); ++e) {
    const auto log_length = [&](const Shape& shape) {
      return std::log((shape.col(edges(1, e)) - shape.col(edges(0, e))).norm());
    };
    const double off = std::abs(change(target, log_length) - change(source, log_length));
    if (!std::isfinite(off)) continue;  // an edge of length zero
    squares += metric.edge_area(e) * off * off;
    area += metric.edge_area(e);
    summary->strain_max = std::fmax(summary->strain_max, off);
  }
  if (area > 0) summary->strain_rms = std::sqrt(squares / area);

  const auto angles_of = [&](const Shape& shape) {
    return DihedralAngles(*metric.connectivity, shape);
  };
  const Eigen::VectorXd off = change(target, angles_of) - change(source, angles_of);
  squares = metric.hinge_area.dot(off.unaryExpr(&WrapAngle).cwiseAbs2());
  area = metric.hinge_area.sum();
  if (area > 0) summary->angle_rms = std::sqrt(squares / area) * internal::kDegrees;
}

void Warn(TransferSummary* summary) {
  if (summary->cancelled) {
    summary->warnings.push_back("cancelled: the path ends with the last shape made before");
  }
  int coarse = 0, open = 0;
  for (size_t i = 0; i < summary->steps.size(); ++i) {
    const TransferSummary::Step& step = summary->steps[i];
    coarse += !step.on_mesh;
    open += !step.converged;
    for (const std::string& warning : step.warnings) {
      summary->warnings.push_back("rung " + std::to_string(i) + ": " + warning);
    }
  }
  const std::string of = " of " + std::to_string(summary->steps.size()) + " shapes ";
  if (coarse > 0) {
    summary->warnings.push_back(std::to_string(coarse) + of +
                                "were solved on a coarser mesh and lifted with its detail");
  }
  if (open > 0) {
    summary->warnings.push_back(std::to_string(open) + of + "did not converge: check the pictures");
  }
}

// Rejects metrics under which no geodesics can be shot or whose features cannot be taken.
void CheckMetric(const MetricOptions& metric) {
  metric.Validate();
  if (metric.rigid > 0) {
    throw InvalidOptions("metric.rigid", "the rigid metric knows no transfer; use 0");
  }
  if (metric.discretization != Discretization::kMidpoint) {
    throw InvalidOptions("metric.discretization",
                         "in trapezoid form nothing can be transferred; use kMidpoint");
  }
}

// Brings source and target into the frame in which they are compared: the source's aligned frame
// and, if `scaled`, the target's size, in the user's unit. In it the target's first shape is
// `target`.
class Comparison {
 public:
  Comparison(const Path& source, const Shape& target, double scale, bool align)
      : source_(source), size_(scale) {
    const Eigen::VectorXd& weights = source.metric->vertex_area;
    for (const Shape& shape : source.shapes) shapes_.push_back(size_ * source.metric->unit * shape);
    place_ = FitRigidMotion(shapes_[0], target, weights);
    if (!align) {
      place_.rotation = source.motions[0].rotation;
      place_.translation =
          Centroid(target, weights) - place_.rotation * Centroid(shapes_[0], weights);
    }
    target_ = place_.rotation.transpose() * (target.colwise() - place_.translation);
  }

  const std::vector<Shape>& Shapes() const { return shapes_; }
  const Shape& Target() const { return target_; }

  /// The motion back to the target's frame, for shape i of the source; `upright` is applied first.
  RigidMotion Placing(int i, const Eigen::Matrix3d& upright) const {
    const Eigen::Matrix3d turn = place_.rotation * source_.motions[0].rotation.transpose();
    RigidMotion motion;
    motion.rotation = turn * source_.motions[i].rotation * upright;
    motion.translation =
        place_.translation +
        size_ * turn * (source_.motions[i].translation - source_.motions[0].translation);
    return motion;
  }

 private:
  const Path& source_;
  const double size_;
  std::vector<Shape> shapes_;
  RigidMotion place_;
  Shape target_;
};

void CheckTarget(const Path& source, const Shape& target) {
  const int num_vertices = source.metric->connectivity->NumVertices();
  if (source.NumShapes() < 2) throw MeshError("a source of one shape has no motion to transfer");
  if (target.cols() != num_vertices) {
    throw MeshError(internal::OfOtherMesh("the target", target.cols(), num_vertices));
  }
  if (!target.allFinite()) throw MeshError("a coordinate of the target is not finite");
}

// Size of the target as a multiple of the source's.
double ScaleOf(const Path& source, const Shape& target) {
  const Eigen::VectorXd& weights = source.metric->vertex_area;
  const double scale = internal::Radius(target, weights) /
                       (source.metric->unit * internal::Radius(source.shapes[0], weights));
  if (!(scale > 0) || !std::isfinite(scale)) {
    throw MeshError("the target or the source's first shape has no extent");
  }
  return scale;
}

// Computes the target's shapes one after the other, beginning with the given first one.
class TargetShapes {
 public:
  TargetShapes(const Path& source, const Shape& target, double scale,
               const TransferOptions& options)
      : options_(options),
        climbs_(options.method == TransferMethod::kLadder),
        comparison_(source, target, climbs_ && !options.ladder.scale ? 1 : scale,
                    !climbs_ || options.ladder.align),
        shapes_{comparison_.Target()} {
    std::vector<Shape> poses = comparison_.Shapes();
    poses.insert(poses.begin(), shapes_[0]);
    const auto freeze = [&](const MetricOptions& metric) {
      return FreezeMetric(metric, source.metric->connectivity, poses);
    };
    metric_ = freeze(climbs_ ? options.ladder.metric : MetricOptions::Strain());
    const int count = source.NumShapes();
    std::shared_ptr<const Metric> rungs, features;
    if (climbs_ || options.hybrids) {
      rungs = climbs_ ? metric_ : freeze(options.ladder.metric);
      estimated_bytes_ += internal::LadderBytes(*rungs, count, options.ladder.rung_shapes);
    }
    if (!climbs_) {
      features = freeze(options.metric);
      estimated_bytes_ += internal::FeatureTransferBytes(*features, count);
    }
    internal::CheckMemory("this transfer", estimated_bytes_, options.memory_limit,
                          "use meshes of fewer vertices");
    if (rungs) ladder_.emplace(rungs, options.ladder);
    if (features) {
      features_.emplace(features, comparison_.Shapes()[0] / metric_->unit,
                        shapes_[0] / metric_->unit);
    }
  }

  const std::shared_ptr<const Metric>& GetMetric() const { return metric_; }
  double EstimatedBytes() const { return estimated_bytes_; }

  void MakeNext(TransferSummary::Step* row, Progress* within) {
    const int i = static_cast<int>(shapes_.size());
    if (climbs_) {
      try {
        shapes_.push_back(
            ladder_->TransportOnce(RungAt(i - 1, within), shapes_.back(), row, within));
      } catch (const SolverError& error) {
        throw SolverError("transfer of shape " + std::to_string(i + 1) + ": " + error.what() +
                          "; use a source with more shapes, so that steps are smaller");
      }
      return;
    }
    const internal::NearestShape nearest =
        (*features_)(comparison_.Shapes()[i] / metric_->unit, options_.tolerance,
                     options_.max_iterations, [&] { ReportProgress(within, "", i, 0); });
    row->converged = nearest.Converged();
    row->on_mesh = true;
    row->iterations = nearest.iterations;
    shapes_.push_back(metric_->unit * nearest.shape);
  }

  /// The last shape in the target's own frame.
  Shape Placed() const { return Placing()(shapes_.back()); }
  /// The shape half way between the last shape and the source's corresponding one.
  Shape Hybrid(Progress* within) {
    const int last = static_cast<int>(shapes_.size()) - 1;
    return Placing()(ladder_->Hybrid(RungAt(last, within)));
  }

 private:
  RigidMotion Placing() const {
    const int last = static_cast<int>(shapes_.size()) - 1;
    const std::vector<Shape>& source = comparison_.Shapes();
    return comparison_.Placing(
        last, climbs_ ? ladder_->Uprighting(source[0], source[last], shapes_[0], shapes_[last])
                      : Eigen::Matrix3d::Identity());
  }

  // The rung of shape i; used for both the target's next shape and the hybrid.
  const internal::Ladder::Rung& RungAt(int i, Progress* within) {
    if (rung_at_ != i) {
      const std::vector<Shape>& source = comparison_.Shapes();
      const size_t next = std::min<size_t>(i + 1, source.size() - 1);
      rung_ = ladder_->BuildRung(source[i], source[next], shapes_[i], within);
      rung_at_ = i;
    }
    return *rung_;
  }

  const TransferOptions& options_;
  const bool climbs_;
  const Comparison comparison_;
  std::vector<Shape> shapes_;
  std::shared_ptr<const Metric> metric_;
  double estimated_bytes_ = 0;
  std::optional<internal::Ladder> ladder_;
  std::optional<internal::FeatureTransfer> features_;
  std::optional<internal::Ladder::Rung> rung_;
  int rung_at_ = -1;
};

}  // namespace

MetricOptions LadderOptions::Strains() {
  MetricOptions metric = MetricOptions::Strain();
  metric.bending = 0.02;
  return metric;
}

void LadderOptions::Validate() const {
  CheckMetric(metric);
  if (rung_shapes < 1 || rung_shapes % 2 == 0) {
    throw InvalidOptions("rung_shapes", "must be odd, 1 or more");
  }
  internal::CheckTolerance(tolerance);
}

MetricOptions TransferOptions::Features() {
  MetricOptions metric = MetricOptions::Strain();
  metric.lambda = 1000;
  metric.bending = 1e-4;
  return metric;
}

void TransferOptions::Validate() const {
  CheckMetric(metric);
  internal::CheckTolerance(tolerance);
  internal::CheckMaxIterations(max_iterations);
  ladder.Validate();
  internal::CheckMemoryLimit(memory_limit);
}

namespace {

void AvoidContact(Progress* progress, Path* path, TransferSummary* summary) {
  try {
    internal::SlideResult slide = internal::SlideAtContact(path->metric, progress, &path->shapes);
    summary->uncertified_segments = slide.uncertified_segments;
    summary->contact_distance = slide.contact_distance;
    summary->warnings = std::move(slide.warnings);
  } catch (const Cancelled&) {
    summary->cancelled = true;
  }
}

}  // namespace

TransferResult Transfer(const Path& source, const Shape& target, const TransferOptions& options,
                        Progress* progress) {
  options.Validate();
  CheckTarget(source, target);
  const internal::Stopwatch total;
  TransferResult result;
  TransferSummary& summary = result.summary;
  const bool climbs = options.method == TransferMethod::kLadder;
  summary.method = options.method;
  summary.vertices = source.metric->connectivity->NumVertices();
  summary.metric = DescribeMetric(climbs ? options.ladder.metric : options.metric);
  summary.scale = ScaleOf(source, target);
  TargetShapes shapes(source, target, summary.scale, options);
  summary.estimated_bytes = shapes.EstimatedBytes();
  const int count = source.NumShapes();
  std::vector<Shape> placed, hybrids;
  try {
    for (int i = 0; i < count; ++i) {
      if (progress != nullptr) progress->ReportShare(static_cast<double>(i) / count);
      internal::SubProgress within(progress, "transferring", i, count);
      ReportProgress(&within, "", i, count);
      const internal::Stopwatch stopwatch;
      TransferSummary::Step row;
      if (i > 0) shapes.MakeNext(&row, &within);
      if (options.hybrids) hybrids.push_back(shapes.Hybrid(&within));
      placed.push_back(i == 0 ? target : shapes.Placed());
      row.seconds = stopwatch.Seconds();
      if (i > 0) summary.steps.push_back(row);
    }
  } catch (const Cancelled&) {
    if (placed.size() < 2) throw;
    summary.cancelled = true;
    hybrids.resize(options.hybrids ? placed.size() : 0);
  }
  const Path made = FirstShapes(source, static_cast<int>(placed.size()));
  const std::string provenance = source.provenance.empty() ? "" : source.provenance + "; ";
  const std::shared_ptr<const Metric>& metric = shapes.GetMetric();
  result.path = PathOfTarget(metric, placed, made.parameters, provenance + "transferred");
  if (options.hybrids) {
    result.hybrids = PathOfPlaced(metric, hybrids, made.parameters, provenance + "hybrids");
  }
  result.path.appearance = result.hybrids.appearance = source.appearance;
  if (options.avoid_contact && !summary.cancelled) AvoidContact(progress, &result.path, &summary);
  if (IsMirrored(source.metric->connectivity->Triangles(), source.shapes.front(), target)) {
    summary.warnings.push_back(
        "the target is a mirror image of the source's first shape: its surface bends to the other "
        "side everywhere, so that no motion of it has the source's angles; change the sign of one "
        "coordinate of the target");
  }
  result.path.converged = result.hybrids.converged = source.converged && summary.Converged();
  MeasureTransferErrors(*metric, made, result.path, &summary);
  Warn(&summary);
  const int parted = CountParted(*metric->connectivity, target);
  if (parted > 0) {
    summary.warnings.push_back(
        std::to_string(parted) +
        " vertices of the target are apart from others that are the same point of the source's "
        "surface, and were moved there; leave the source's seams open if that surface is open");
  }
  summary.total_seconds = total.Seconds();
  return result;
}

namespace {

// Transfers geodesics between the poses and uses their last shapes.
PoseTransferResult TransferAlongGeodesics(const std::shared_ptr<const Connectivity>& connectivity,
                                          const std::vector<Shape>& poses, const Shape& target,
                                          const GeodesicOptions& geodesic,
                                          const TransferOptions& options, Progress* progress) {
  const int count = static_cast<int>(poses.size());
  PoseTransferResult result;
  std::vector<Shape> placed = {target}, hybrids;
  std::vector<double> parameters = {0};
  for (int i = 1; i < count && !result.summary.cancelled; ++i) {
    GeodesicResult source;
    TransferResult transfer;
    const double begin = (i - 1.0) / (count - 1), end = 1.0 * i / (count - 1);
    const double between = begin + kGeodesicShare * (end - begin);
    internal::SubProgress to_pose(progress, begin, between), from_pose(progress, between, end);
    try {
      source = Interpolate(connectivity, {poses[0], poses[i]}, geodesic, &to_pose);
      if (source.summary.termination == Termination::kCancelled) throw Cancelled();
      transfer = Transfer(source.path, target, options, &from_pose);
      if (transfer.summary.cancelled) throw Cancelled();
    } catch (const Cancelled&) {
      if (i == 1) throw;
      result.summary.cancelled = true;
      continue;
    } catch (const SolverError& error) {
      throw SolverError("pose " + std::to_string(i + 1) + ": " + error.what());
    }
    const int last = transfer.path.NumShapes() - 1;
    placed.push_back(transfer.path.Placed(last));
    if (options.hybrids) {
      if (hybrids.empty()) hybrids.push_back(transfer.hybrids.Placed(0));
      hybrids.push_back(transfer.hybrids.Placed(last));
    }
    parameters.push_back(static_cast<double>(i) / (count - 1));
    result.summary.geodesics.push_back(std::move(source.summary));
    result.summary.transfers.push_back(std::move(transfer.summary));
  }
  const auto metric = FreezeMetric(options.ladder.metric, connectivity, placed);
  result.path = PathOfTarget(metric, placed, parameters, "transferred");
  if (options.hybrids) result.hybrids = PathOfPlaced(metric, hybrids, parameters, "hybrids");
  return result;
}

}  // namespace

PoseTransferResult TransferPoses(const std::shared_ptr<const Connectivity>& connectivity,
                                 const std::vector<Shape>& poses, const Shape& target,
                                 const GeodesicOptions& geodesic, const TransferOptions& options,
                                 Progress* progress) {
  options.Validate();
  const int count = static_cast<int>(poses.size());
  if (count < 2) throw MeshError("one pose has no motion to transfer");
  PoseTransferResult result;
  if (options.method == TransferMethod::kLadder) {
    result = TransferAlongGeodesics(connectivity, poses, target, geodesic, options, progress);
  } else {
    std::vector<double> parameters;
    for (int i = 0; i < count; ++i) parameters.push_back(static_cast<double>(i) / (count - 1));
    const auto metric = FreezeMetric(MetricOptions::Strain(), connectivity, poses);
    TransferResult transfer =
        Transfer(PathOfPlaced(metric, poses, parameters, ""), target, options, progress);
    result.path = std::move(transfer.path);
    result.hybrids = std::move(transfer.hybrids);
    result.summary.cancelled = transfer.summary.cancelled;
    result.summary.transfers.push_back(std::move(transfer.summary));
  }
  result.path.converged = result.hybrids.converged = result.summary.Converged();
  return result;
}

}  // namespace shapespace
