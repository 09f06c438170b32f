#include <shapespace/solvers/transfer.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/stopwatch.h>
#include <shapespace/hierarchy/detail.h>
#include <shapespace/path/align.h>
#include <shapespace/path/quality.h>
#include <shapespace/path/rigid_motion.h>
#include <shapespace/solvers/check_options.h>

namespace shapespace {
namespace {

// Of the time that a pose's geodesic and the transfer of it take together.
constexpr double kGeodesicShare = 0.1;

// So that a copy of the source comes out as its motion to ten digits.
constexpr double kStepTolerance = 1e-12;

// Root mean square distance of the surface from its centroid.
double Radius(const Shape& shape, const Eigen::VectorXd& weights) {
  const Eigen::Vector3d centre = Centroid(shape, weights);
  const Eigen::VectorXd squares = (shape.colwise() - centre).colwise().squaredNorm().transpose();
  return std::sqrt(squares.dot(weights) / weights.sum());
}

Path TwoShapes(const std::shared_ptr<const Metric>& metric, const Shape& from, const Shape& to) {
  Path path;
  path.metric = metric;
  path.shapes = {from / metric->unit, to / metric->unit};
  path.parameters = {0, 1};
  path.motions.resize(2);
  path.poses = {0, 1};
  return path;
}

// What a path carries as motions becomes part of its shapes.
void TurnShapes(Path* path) {
  for (int i = 0; i < path->NumShapes(); ++i) {
    path->shapes[i] = path->motions[i].rotation * path->shapes[i];
    path->motions[i].rotation.setIdentity();
  }
}

Path PathOfPlaced(const std::shared_ptr<const Metric>& metric, const std::vector<Shape>& placed,
                  std::vector<double> parameters, std::string provenance) {
  Path path;
  path.metric = metric;
  AlignedPoses aligned = AlignPoses(*metric, placed);
  path.shapes = std::move(aligned.shapes);
  path.motions = std::move(aligned.motions);
  path.parameters = std::move(parameters);
  path.provenance = std::move(provenance);
  return path;
}

// The target's path: the target itself, and what was shot from there.
Path PathOfTarget(const std::shared_ptr<const Metric>& metric, const std::vector<Shape>& placed,
                  std::vector<double> parameters, std::string provenance) {
  Path path = PathOfPlaced(metric, placed, std::move(parameters), std::move(provenance));
  path.poses = {0};
  path.extrapolated = path.NumShapes() - 1;
  return path;
}

double NormChange(double before, double after) { return before > 0 ? after / before - 1 : 0; }

// What goes on within a rung is heard as that rung's.
class WithinRung final : public Progress {
 public:
  WithinRung(Progress* all, int done, int total) : all_(all), done_(done), total_(total) {}
  bool Report(const std::string&, int, int) override {
    return all_ == nullptr || all_->Report("transferring", done_, total_);
  }

 private:
  Progress* const all_;
  const int done_, total_;
};

// A call within a call, as a part of its work.
class Within final : public Progress {
 public:
  Within(Progress* all, double begin, double end) : all_(all), begin_(begin), end_(end) {}
  bool Report(const std::string& stage, int done, int total) override {
    return all_ == nullptr || all_->Report(stage, done, total);
  }
  void ReportShare(double share) override {
    if (all_ != nullptr) all_->ReportShare(begin_ + share * (end_ - begin_));
  }

 private:
  Progress* const all_;
  const double begin_, end_;
};

// The rotation that gives the target's surface, in the mean over it, the orientation that the
// source's has. Bodies of other proportions have their mass elsewhere, so that shapes which lie
// well on each other as a whole do not stand alike.
Eigen::Matrix3d Uprighting(const Metric& metric, const Shape& first_source, const Shape& source,
                           const Shape& first_target, const Shape& target) {
  const Connectivity& connectivity = *metric.connectivity;
  const auto is = internal::VertexRotations(connectivity, first_target, target);
  const auto wanted = internal::VertexRotations(connectivity, first_source, source);
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (size_t v = 0; v < is.size(); ++v) {
    sum += metric.vertex_area(v) * is[v] * wanted[v].transpose();
  }
  return ProcrustesRotation(sum);
}

class Ladder {
 public:
  Ladder(std::shared_ptr<const Metric> metric, const TransferOptions& options)
      : metric_(std::move(metric)), options_(options) {
    geodesic_.shapes = options.rung_shapes;
    geodesic_.tolerance = options.tolerance;
    transport_.connection = options.connection;
    transport_.align = options.align;
    step_.tolerance = kStepTolerance;
  }

  struct Rung {
    GeodesicResult geodesic;
    Shape from, next;  // of the source, as they are compared with the target
  };

  // From a shape of the source to the target's; `next` is the source's after that.
  Rung Lay(const Shape& source, const Shape& next, const Shape& target, Progress* progress) const {
    const Eigen::VectorXd& weights = metric_->vertex_area;
    const double scale = options_.scale ? Radius(target, weights) / Radius(source, weights) : 1;
    RigidMotion onto;
    if (options_.align) onto = FitRigidMotion(scale * source, target, weights);
    Rung rung;
    rung.from = onto(scale * source);
    rung.next = onto(scale * next);
    rung.geodesic = Interpolate(metric_, {rung.from, target}, geodesic_, progress);
    if (rung.geodesic.summary.termination == Termination::kCancelled) throw Cancelled();
    if (!options_.align) TurnShapes(&rung.geodesic.path);
    return rung;
  }

  // A rung without length: the target is the source's shape.
  bool HasNoLength(const Rung& rung) const {
    return options_.align && rung.geodesic.summary.energy < GeodesicSummary::kZeroEnergy;
  }

  // What `target` becomes as the source becomes its next shape. \throw SolverError.
  Shape Climb(const Rung& rung, const Shape& target, TransferSummary::Rung* row,
              Progress* progress) const {
    // Along a rung without length nothing changes, and the target's step is the source's.
    if (HasNoLength(rung)) return rung.next + (target - rung.from);
    const Tangent velocity =
        Carry(rung.geodesic.path, InitialVelocity(TwoShapes(metric_, rung.from, rung.next)), row,
              progress);
    const ExponentialResult step = Extrapolate(metric_, target, velocity, 1, step_, progress);
    if (step.summary.ending != ExponentialSummary::Ending::kComplete) {
      throw SolverError(step.summary.stopped);
    }
    row->on_mesh = step.summary.steps[0].vertices == step.summary.vertices;
    if (row->on_mesh) row->converged = row->converged && step.summary.Converged();
    return step.path.Placed(1);
  }

 private:
  Tangent Carry(const Path& path, const Tangent& velocity, TransferSummary::Rung* row,
                Progress* progress) const {
    const TransportResult carried = Transport(path, {velocity}, transport_, progress);
    row->norm_change = NormChange(carried.summary.first_norm[0], carried.summary.last_norm[0]);
    row->converged = row->converged && carried.summary.converged;
    return carried.tangents[0];
  }

  const std::shared_ptr<const Metric> metric_;
  const TransferOptions options_;
  GeodesicOptions geodesic_;
  TransportOptions transport_;
  ExponentialOptions step_;
};

// Compares what target and source have done since their first shapes.
void MeasureWhatIsOff(const Metric& metric, const Path& source, const Path& target,
                      TransferSummary* summary) {
  const auto change = [](const Path& path, const auto& value) {
    const auto first = value(path.shapes.front());
    auto last = value(path.shapes.back());
    last -= first;  // no expression, which would outlive the two
    return last;
  };
  const Eigen::Matrix2Xi& edges = metric.connectivity->Edges();
  double squares = 0, area = 0;
  for (int e = 0; e < edges.cols(); ++e) {
    const auto log_length = [&](const Shape& shape) {
      return std::log((shape.col(edges(1, e)) - shape.col(edges(0, e))).norm());
    };
    const double off = std::abs(change(target, log_length) - change(source, log_length));
    if (!std::isfinite(off)) continue;  // an edge without length
    squares += metric.edge_area(e) * off * off;
    area += metric.edge_area(e);
    summary->strain_max = std::max(summary->strain_max, off);
  }
  if (area > 0) summary->strain_rms = std::sqrt(squares / area);

  const auto angles_of = [&](const Shape& shape) {
    return DihedralAngles(*metric.connectivity, shape);
  };
  const Eigen::VectorXd off = change(target, angles_of) - change(source, angles_of);
  squares = metric.hinge_area.dot(off.unaryExpr(&WrapAngle).cwiseAbs2());
  area = metric.hinge_area.sum();
  if (area > 0) summary->angle_rms = std::sqrt(squares / area) * 180 / M_PI;
}

void Warn(TransferSummary* summary) {
  if (summary->cancelled) {
    summary->warnings.push_back("cancelled: the path ends with the last shape made before");
  }
  const auto count = [&](const auto& is_so) {
    return std::count_if(summary->rungs.begin(), summary->rungs.end(), is_so);
  };
  const std::string of = " of " + std::to_string(summary->rungs.size()) + " rungs ";
  if (const auto coarse = count([](const TransferSummary::Rung& rung) { return !rung.on_mesh; })) {
    summary->warnings.push_back(std::to_string(coarse) + of +
                                "made their step on a coarser mesh, and carried detail along");
  }
  if (const auto open = count([](const TransferSummary::Rung& rung) { return !rung.converged; })) {
    summary->warnings.push_back(std::to_string(open) + of +
                                "did not converge: look at the pictures");
  }
}

}  // namespace

MetricOptions TransferOptions::Strains() {
  MetricOptions metric;
  metric.isometric = 0;
  metric.log_length = 1;
  metric.bending = 0.02;
  return metric;
}

void TransferOptions::Validate() const {
  metric.Validate();
  if (metric.rigid > 0) {
    throw InvalidOptions("metric.rigid: the rigid metric knows no parallel transport; use 0");
  }
  if (metric.discretization != Discretization::kMidpoint) {
    throw InvalidOptions(
        "metric.discretization: in trapezoid form geodesics cannot be shot; use kMidpoint");
  }
  if (rung_shapes < 1 || rung_shapes % 2 == 0) {
    throw InvalidOptions("rung_shapes: must be odd, 1 or more");
  }
  internal::CheckTolerance(tolerance);
}

TransferResult Transfer(const Path& source, const Shape& target, const TransferOptions& options,
                        Progress* progress) {
  options.Validate();
  const Stopwatch total;
  const std::shared_ptr<const Connectivity>& connectivity = source.metric->connectivity;
  const int count = source.NumShapes();
  if (count < 2) throw MeshError("a source of one shape has no motion to transfer");
  if (target.cols() != connectivity->NumVertices()) {
    throw MeshError("the target has " + std::to_string(target.cols()) +
                    " vertices, the source has " + std::to_string(connectivity->NumVertices()));
  }
  if (!target.allFinite()) throw MeshError("a coordinate of the target is not finite");
  const Eigen::VectorXd& weights = source.metric->vertex_area;
  TransferResult result;
  TransferSummary& summary = result.summary;
  summary.vertices = connectivity->NumVertices();
  summary.metric = Describe(options.metric);
  summary.scale =
      Radius(target, weights) / (source.metric->unit * Radius(source.shapes[0], weights));
  if (!(summary.scale > 0) || !std::isfinite(summary.scale)) {
    throw MeshError("the target or the source's first shape has no extent");
  }

  // All happens in the source's aligned frame, and in the target's size: there the target's first
  // shape is `targets[0]`, and `turn` leads from the source's place to the target's.
  const double size = options.scale ? summary.scale : 1;
  std::vector<Shape> shapes;
  for (const Shape& shape : source.shapes) shapes.push_back(size * source.metric->unit * shape);
  RigidMotion place = FitRigidMotion(shapes[0], target, weights);
  if (!options.align) {
    place.rotation = source.motions[0].rotation;
    place.translation = Centroid(target, weights) - place.rotation * Centroid(shapes[0], weights);
  }
  const Eigen::Matrix3d turn = place.rotation * source.motions[0].rotation.transpose();
  std::vector<Shape> targets = {place.rotation.transpose() *
                                (target.colwise() - place.translation)};
  std::vector<Shape> poses = shapes;
  poses.insert(poses.begin(), targets[0]);
  const auto metric =
      std::make_shared<const Metric>(FreezeMetric(options.metric, connectivity, poses));

  const Ladder ladder(metric, options);
  std::vector<Shape> placed, hybrids;
  const auto climb = [&](int i) {
    if (progress != nullptr) progress->ReportShare(static_cast<double>(i) / count);
    ReportProgress(progress, "transferring", i, count);
    const Stopwatch stopwatch;
    WithinRung within(progress, i, count);
    const bool last = i + 1 == count;
    const Ladder::Rung rung = ladder.Lay(shapes[i], shapes[last ? i : i + 1], targets[i], &within);
    TransferSummary::Rung row;
    row.ratio = rung.geodesic.summary.Ratio();
    row.converged =
        ladder.HasNoLength(rung) || rung.geodesic.summary.termination == Termination::kConverged;
    if (!last) {
      try {
        targets.push_back(ladder.Climb(rung, targets[i], &row, &within));
      } catch (const SolverError& error) {
        throw SolverError("transfer of shape " + std::to_string(i + 2) + ": " + error.what() +
                          "; a source with more shapes on the same way makes smaller steps");
      }
    }
    row.seconds = stopwatch.Seconds();
    summary.rungs.push_back(row);

    RigidMotion motion;
    motion.rotation = turn * source.motions[i].rotation;
    if (options.align) {
      motion.rotation *= Uprighting(*metric, shapes[0], shapes[i], targets[0], targets[i]);
    }
    motion.translation =
        place.translation +
        size * turn * (source.motions[i].translation - source.motions[0].translation);
    placed.push_back(motion(targets[i]));
    hybrids.push_back(motion(rung.geodesic.path.Placed((options.rung_shapes + 1) / 2)));
  };
  try {
    for (int i = 0; i < count; ++i) climb(i);
  } catch (const Cancelled&) {
    if (placed.size() < 2) throw;
    summary.cancelled = true;
  }
  placed[0] = target;
  const Path made = FirstShapes(source, static_cast<int>(placed.size()));
  const std::string provenance = source.provenance.empty() ? "" : source.provenance + "; ";
  result.path = PathOfTarget(metric, placed, made.parameters, provenance + "transferred");
  result.hybrids = PathOfPlaced(metric, hybrids, made.parameters, provenance + "hybrids");
  result.path.appearance = result.hybrids.appearance = source.appearance;
  result.path.converged = result.hybrids.converged = source.converged && summary.Converged();
  MeasureWhatIsOff(*metric, made, result.path, &summary);
  Warn(&summary);
  summary.total_seconds = total.Seconds();
  return result;
}

PoseTransferResult TransferPoses(const std::shared_ptr<const Connectivity>& connectivity,
                                 const std::vector<Shape>& poses, const Shape& target,
                                 const GeodesicOptions& geodesic, const TransferOptions& options,
                                 Progress* progress) {
  options.Validate();
  const int count = static_cast<int>(poses.size());
  if (count < 2) throw MeshError("one pose has no motion to transfer");
  PoseTransferResult result;
  std::vector<Shape> placed = {target}, hybrids;
  std::vector<double> parameters = {0};
  for (int i = 1; i < count && !result.summary.cancelled; ++i) {
    GeodesicResult source;
    TransferResult transfer;
    const double begin = (i - 1.0) / (count - 1), end = 1.0 * i / (count - 1);
    const double between = begin + kGeodesicShare * (end - begin);
    Within to_pose(progress, begin, between), from_pose(progress, between, end);
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
    if (hybrids.empty()) hybrids.push_back(transfer.hybrids.Placed(0));
    hybrids.push_back(transfer.hybrids.Placed(last));
    parameters.push_back(static_cast<double>(i) / (count - 1));
    result.summary.geodesics.push_back(std::move(source.summary));
    result.summary.transfers.push_back(std::move(transfer.summary));
  }
  const auto metric =
      std::make_shared<const Metric>(FreezeMetric(options.metric, connectivity, placed));
  result.path = PathOfTarget(metric, placed, parameters, "transferred");
  result.hybrids = PathOfPlaced(metric, hybrids, parameters, "hybrids");
  result.path.converged = result.hybrids.converged = result.summary.Converged();
  return result;
}

}  // namespace shapespace
