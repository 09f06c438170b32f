#include <shapespace/geodesic/geodesic.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>

#include <shapespace/analysis/intersections.h>
#include <shapespace/analysis/path_intersections.h>
#include <shapespace/base/error.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/base/parallel.h>
#include <shapespace/contact/internal/avoid_contact.h>
#include <shapespace/cost/internal/refuse_sums.h>
#include <shapespace/geodesic/detail/align_folds.h>
#include <shapespace/geodesic/detail/contact_piece.h>
#include <shapespace/geodesic/detail/geodesic_piece.h>
#include <shapespace/geodesic/internal/memory.h>
#include <shapespace/hierarchy/freeze_level.h>
#include <shapespace/path/align.h>
#include <shapespace/path/energy.h>
#include <shapespace/summary/internal/check_options.h>
#include <shapespace/summary/internal/memory.h>

namespace shapespace {
namespace {

// Fails early if the finest level cannot be solved.
void CheckFinest(const Metric& metric, double bytes, const GeodesicOptions& options) {
  if (options.solver == GeodesicSolver::kTrustRegion) cost::RefuseDenseRows(metric);
  internal::CheckMemory("this solve", bytes, options.memory_limit, "insert fewer shapes");
}

// Between two neighbours of so many pieces: twice as many shapes as asked for, to remove a jump,
// unless they need very much memory. The memory limit has no part in this: it refuses solves, and
// changes no result.
int MostShapes(const Metric& metric, int pieces, const GeodesicOptions& options) {
  constexpr double kVeryMuch = 8e9;
  if (options.shapes >= std::numeric_limits<int>::max() / 2) return options.shapes;
  const int twice = 2 * options.shapes + 1;
  return internal::GeodesicBytes(metric, pieces + 1, twice) <= kVeryMuch ? twice : options.shapes;
}

// Restricts all `shapes` to a level.
std::vector<Shape> Restrict(const Hierarchy& hierarchy, const std::vector<Shape>& shapes,
                            int level) {
  std::vector<Shape> restricted;
  for (const Shape& shape : shapes) restricted.push_back(hierarchy.Restrict(shape, level));
  return restricted;
}

// Prepares all levels, each with a metric of its own in the mesh's unit.
std::vector<internal::SharedLevel> PrepareLevels(const Hierarchy& hierarchy,
                                                 const std::shared_ptr<const Metric>& metric,
                                                 const std::vector<Shape>& aligned,
                                                 PosePairs pairs) {
  std::vector<internal::SharedLevel> levels;
  for (int level = 0; level < hierarchy.NumLevels(); ++level) {
    std::vector<Shape> poses = Restrict(hierarchy, aligned, level);
    auto own = metric;
    if (level + 1 < hierarchy.NumLevels()) {
      own = FreezeLevel(*metric, hierarchy, level, poses, pairs);
    }
    levels.emplace_back(std::move(own), std::move(poses));
  }
  return levels;
}

// Linear interpolation from one pose to another.
std::vector<Shape> Blend(const Shape& from, const Shape& to, int inner) {
  std::vector<Shape> shapes;
  for (int k = 0; k <= inner + 1; ++k) {
    const double t = static_cast<double>(k) / (inner + 1);
    shapes.push_back((1 - t) * from + t * to);
  }
  return shapes;
}

// The vertices whose motion has no cost: those of no element of any feature. Twins follow others.
std::vector<int> VerticesWithoutCost(const Metric& metric) {
  const int num_vertices = metric.connectivity->NumVertices();
  std::vector<char> has_cost(num_vertices, metric.rigid.Active() ? 1 : 0);
  for (const auto& feature : metric.features) {
    for (int e = 0; e < feature->NumElements(); ++e) {
      for (int k = 0; k < feature->VerticesPerElement(); ++k) has_cost[feature->Element(e)[k]] = 1;
    }
  }
  std::vector<int> vertices;
  for (int v = 0; v < num_vertices; ++v) {
    if (!has_cost[v] && metric.connectivity->Representative(v) == v) vertices.push_back(v);
  }
  return vertices;
}

// Moves `vertices` on straight lines from the first shape to the last.
void MoveStraight(const std::vector<int>& vertices, std::vector<Shape>* shapes) {
  const int last = static_cast<int>(shapes->size()) - 1;
  for (int k = 1; k < last; ++k) {
    const double t = static_cast<double>(k) / last;
    for (const int v : vertices) {
      (*shapes)[k].col(v) = (1 - t) * shapes->front().col(v) + t * shapes->back().col(v);
    }
  }
}

// Whether poses differ so little that the path between them is dominated by rounding.
bool AreNear(const Shape& a, const Shape& b) {
  constexpr double kNear = 1e-6;
  return (b - a).cwiseAbs().maxCoeff() <= kNear * a.cwiseAbs().maxCoeff();
}

// If the poses are so near that the energy is dominated by rounding, the blend is the solution,
// because curvature is of second order, and a relative tolerance on the energy has no meaning. Adds
// a row to the summary in that case.
bool IsSolved(int piece, const std::vector<Shape>& blend, const GeodesicOptions& options,
              internal::Resolution* finest, GeodesicSummary* summary) {
  const int segments = static_cast<int>(blend.size()) - 1;
  const double energy = ScaledEnergy(finest->Energy(blend, options), segments);
  if (!(energy < GeodesicSummary::kZeroEnergy)) return false;
  GeodesicSummary::Level row;
  row.piece = piece;
  row.vertices = static_cast<int>(blend.front().cols());
  row.shapes = segments - 1;
  row.start = "blend";
  row.solver = "none";
  row.termination = Termination::kConverged;
  row.initial_energy = row.energy = energy;
  summary->levels.push_back(row);
  return true;
}

// Measures the energy of the finished path by feature, and the lower bound, over all pieces.
void MeasureEnergy(const Path& path, const GeodesicOptions& options, internal::Resolution* finest,
                   GeodesicSummary* summary) {
  const Metric& metric = *path.metric;
  for (const auto& feature : metric.features) summary->parts.emplace_back(feature->Name(), 0.0);
  if (metric.rigid.Active()) summary->parts.emplace_back("rigid", 0.0);
  summary->energy = summary->lower_bound = 0;
  for (size_t piece = 0; piece + 1 < path.poses.size(); ++piece) {
    const std::vector<Shape> shapes(path.shapes.begin() + path.poses[piece],
                                    path.shapes.begin() + path.poses[piece + 1] + 1);
    const int segments = static_cast<int>(shapes.size()) - 1;
    const std::vector<double> parts = finest->EnergyParts(shapes, options);
    for (size_t i = 0; i < parts.size(); ++i) {
      summary->parts[i].second += ScaledEnergy(parts[i], segments);
    }
    summary->lower_bound +=
        ScaledEnergy(EnergyLowerBound(metric, shapes.front(), shapes.back(), segments), segments);
  }
  for (const auto& part : summary->parts) summary->energy += part.second;
}

// Pairs of intersecting triangles in the middle of each segment, in excess of those in the poses
// before and after it: the greatest number. With an obstacle, pairs of the body and the obstacle
// count too.
double CrossingsBetween(const Path& path, const std::optional<Obstacle>& obstacle) {
  std::vector<Shape> shapes;
  const std::vector<Shape> all = obstacle ? path.Placed() : path.shapes;
  for (const int pose : path.poses) shapes.push_back(all[pose]);
  for (int i = 0; i + 1 < path.NumShapes(); ++i) shapes.push_back(0.5 * (all[i] + all[i + 1]));
  auto connectivity = path.metric->connectivity;
  if (obstacle) {
    connectivity = obstacle->Joined(connectivity);
    for (Shape& shape : shapes) shape = obstacle->Joined(shape);
  }
  const std::vector<std::int64_t> pairs = CountIntersections(*connectivity, shapes);
  std::int64_t most = 0;
  size_t piece = 0;
  for (int i = 0; i + 1 < path.NumShapes(); ++i) {
    if (i == path.poses[piece + 1]) ++piece;
    most = std::max(most, pairs[path.poses.size() + i] - std::max(pairs[piece], pairs[piece + 1]));
  }
  return static_cast<double>(most);
}

// Measures what is visible in the finished path.
void Assess(const Path& path, const GeodesicOptions& options, GeodesicSummary* summary) {
  summary->quality = MeasureQuality(path);

  // A few shapes suffice to find out whether the body intersects itself.
  std::vector<double> times = {0};
  for (size_t piece = 0; piece + 1 < path.poses.size(); ++piece) {
    const double begin = path.parameters[path.poses[piece]];
    const double end = path.parameters[path.poses[piece + 1]];
    for (double t : {.25, .5, .75}) times.push_back(begin + t * (end - begin));
    times.push_back(end);
  }
  try {
    summary->intersections = MeasureIntersections(Resample(path, times)).beyond_poses;
    if (options.avoid_contact) {
      const bool is_free =
          summary->uncertified_segments == 0 && std::isnan(summary->contact_distance);
      summary->crossings_between = is_free ? 0 : CrossingsBetween(path, options.obstacle);
    }
  } catch (const Error& error) {  // no reason to discard the path
    summary->warnings.push_back(std::string("not counted: ") + error.what());
  }
}

void CheckShape(const Shape& shape, const Metric& metric) {
  if (shape.cols() != metric.connectivity->NumVertices() || !shape.allFinite()) {
    throw MeshError("a pose is not finite, or has another number of vertices than the metric");
  }
}

GeodesicSchedule KindOfSchedule(const Metric& metric, const GeodesicOptions& options) {
  if (options.schedule != GeodesicSchedule::kAutomatic || metric.options.bending > 0) {
    return options.schedule;
  }
  return GeodesicSchedule::kFlat;
}

// Whether the way in which a level ended says something about the path. One that has stalled is a
// start for the next one, and as good as any other start, unless it is the last of its piece.
bool Counts(const std::vector<GeodesicSummary::Level>& levels, size_t i) {
  if (!levels[i].kept) return false;
  if (levels[i].termination != Termination::kStalled) return true;
  for (size_t k = i + 1; k < levels.size(); ++k) {
    if (levels[k].kept && levels[k].piece == levels[i].piece) return false;
  }
  return true;
}

// Says so if a way round contacts was not found by the solver that was asked for.
void WarnOfSolver(GeodesicSolver asked, GeodesicSummary* summary) {
  if (asked != GeodesicSolver::kLbfgs && asked != GeodesicSolver::kTrustRegion) return;
  const auto is_contact = [](const auto& level) { return level.start == "contact"; };
  if (std::none_of(summary->levels.begin(), summary->levels.end(), is_contact)) return;
  summary->warnings.push_back(
      "the way round contacts was found by this library's own L-BFGS, not by the solver that was "
      "asked for, which knows none");
}

// Appends warnings about results that are valid but probably not wanted. Past an obstacle
// neither the bound, which knows of none, nor an even speed is to be expected.
void Warn(bool past_obstacle, GeodesicSummary* summary) {
  for (size_t i = 0; i < summary->levels.size(); ++i) {
    const GeodesicSummary::Level& level = summary->levels[i];
    if (Counts(summary->levels, i) && level.termination != Termination::kConverged &&
        level.termination != Termination::kCancelled) {
      summary->warnings.push_back(
          "the level of " + std::to_string(level.shapes) + " shapes of piece " +
          std::to_string(level.piece) +
          (level.termination == Termination::kMaxIterations
               ? " ran out of iterations; raise max_iterations or the tolerance"
               : " stalled: no step leads farther down, although the estimate of what is left is "
                 "above the tolerance; are there triangles far thinner than the others?"));
    }
  }
  if (summary->termination == Termination::kCancelled) {
    summary->warnings.push_back(
        "cancelled: the path is the best so far; shapes that were not solved yet are lifted or "
        "refined from others");
    return;  // further warnings would only follow from the cancellation
  }
  if (summary->uncertified_segments > 0) {
    summary->warnings.push_back(internal::WarningOfUncertified(summary->uncertified_segments));
  } else if (summary->intersections > internal::kManyIntersections) {
    summary->warnings.push_back("the body intersects itself: inner shapes have " +
                                std::to_string(std::lround(summary->intersections)) +
                                " more pairs of intersecting triangles than the poses; "
                                "avoid_contact prevents this");
  }
  constexpr double kPoorRatio = 1.5, kManyFolds = 1e-3, kUneven = 1.15;
  if (!past_obstacle && summary->Ratio() > kPoorRatio) {
    summary->warnings.push_back("the energy is " + std::to_string(summary->Ratio()) +
                                " times its lower bound: the path may be a poor local minimum");
  }
  if (!past_obstacle && summary->quality.speed_max > kUneven) {
    summary->warnings.push_back(
        "some segment is " + std::to_string(summary->quality.speed_max) +
        " times as fast as the mean: a part may rest and then jump; check the pictures");
  }
  if (summary->quality.folds > kManyFolds * summary->hinges) {
    summary->warnings.push_back("inner shapes have " +
                                std::to_string(std::lround(summary->quality.folds)) +
                                " folds that the poses do not have: check the pictures");
  }
}

}  // namespace

void GeodesicOptions::Validate() const {
  metric.Validate();
  if (shapes < 1) throw InvalidOptions("shapes", "must be 1 or more");
  internal::CheckTolerance(tolerance);
  internal::CheckMaxIterations(max_iterations);
  internal::CheckMemoryLimit(memory_limit);
  if (!via.empty() && !avoid_contact) {
    throw InvalidOptions("via", "is for paths that avoid contact: set avoid_contact");
  }
  internal::CheckObstacle(obstacle, avoid_contact);
}

GeodesicResult Interpolate(const std::shared_ptr<const Connectivity>& connectivity,
                           const std::vector<Shape>& poses, const GeodesicOptions& options,
                           Progress* progress) {
  options.Validate();
  if (poses.size() < 2) throw MeshError("a geodesic needs at least two poses");
  const internal::Stopwatch freezing;
  ReportProgress(progress, "freezing the metric", 0, 0);
  const auto metric = FreezeMetric(options.metric, connectivity, poses);
  const double freeze_seconds = freezing.Seconds();
  GeodesicResult result = Interpolate(metric, poses, options, progress);
  result.summary.freeze_seconds = freeze_seconds;
  result.summary.total_seconds += freeze_seconds;
  return result;
}

namespace internal {

// The data shared by all solves between poses of one mesh.
class GeodesicLevels {
 public:
  GeodesicLevels(const std::shared_ptr<const Metric>& metric, const std::vector<Shape>& aligned,
                 PosePairs pairs, const GeodesicOptions& options, Progress* progress = nullptr)
      : metric_(metric),
        options_(options),
        kind_(KindOfSchedule(*metric, options)),
        hierarchy_(metric->connectivity, aligned, MakeHierarchyOptions(), progress),
        levels_(PrepareLevels(hierarchy_, metric, aligned, pairs)),
        without_cost_(VerticesWithoutCost(*metric)) {}

  const std::shared_ptr<const Metric>& GetMetric() const { return metric_; }
  /// The path through `poses`. Several threads may solve at a time.
  GeodesicResult Solve(const AlignedPoses& poses, Progress* progress) const;

 private:
  // What one solve at a time works on: each level.
  using Workspace = std::vector<Resolution>;

  HierarchyOptions MakeHierarchyOptions() const {
    HierarchyOptions result;
    result.coarsest = kind_ == GeodesicSchedule::kFlat
                          ? std::max(options_.coarsest, metric_->connectivity->NumTriangles())
                          : options_.coarsest;
    return result;
  }
  // A workspace for a path through these poses: one of an earlier solve, if any is idle.
  Workspace TakeWorkspace(const std::vector<Shape>& aligned) const;
  void GiveBack(Workspace workspace) const;
  void SolvePieces(const AlignedPoses& poses, Progress* progress, Workspace* workspace,
                   GeodesicResult* result) const;
  void AvoidContact(Workspace* workspace, Workload* workload, GeodesicResult* result) const;
  void Describe(GeodesicSummary* summary) const;

  const std::shared_ptr<const Metric> metric_;
  const GeodesicOptions options_;
  const GeodesicSchedule kind_;
  const Hierarchy hierarchy_;
  const std::vector<SharedLevel> levels_;
  const std::vector<int> without_cost_;  // vertices of the mesh itself
  mutable std::mutex mutex_;
  mutable std::vector<Workspace> idle_;  // guarded by mutex_
};

GeodesicLevels::Workspace GeodesicLevels::TakeWorkspace(const std::vector<Shape>& aligned) const {
  Workspace workspace;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!idle_.empty()) {
      workspace = std::move(idle_.back());
      idle_.pop_back();
    }
  }
  if (workspace.empty()) workspace = Workspace(levels_.begin(), levels_.end());
  for (int level = 0; level < hierarchy_.NumLevels(); ++level) {
    workspace[level].SetPoses(Restrict(hierarchy_, aligned, level));
  }
  return workspace;
}

void GeodesicLevels::GiveBack(Workspace workspace) const {
  const std::lock_guard<std::mutex> lock(mutex_);
  idle_.push_back(std::move(workspace));
}

GeodesicResult GeodesicLevels::Solve(const AlignedPoses& poses, Progress* progress) const {
  GeodesicResult result;
  const internal::Stopwatch solving;
  Workspace workspace = TakeWorkspace(poses.shapes);
  double factored = 0;
  for (const Resolution& resolution : workspace) factored += resolution.FactorSeconds();
  SolvePieces(poses, progress, &workspace, &result);
  GeodesicSummary& summary = result.summary;
  summary.solve_seconds = solving.Seconds();
  for (const Resolution& resolution : workspace) {
    summary.factor_seconds += resolution.FactorSeconds();
    summary.factor_nonzeros += resolution.FactorNonzeros();
  }
  summary.factor_seconds -= factored;
  Describe(&summary);
  summary.poses = static_cast<int>(result.path.poses.size());
  for (size_t i = 0; i < summary.levels.size(); ++i) {
    if (!Counts(summary.levels, i)) continue;
    summary.termination = std::max(summary.termination, summary.levels[i].termination);
  }
  result.path.converged = summary.termination == Termination::kConverged;
  MeasureEnergy(result.path, options_, &workspace.back(), &summary);
  GiveBack(std::move(workspace));
  if (options_.assess) Assess(result.path, options_, &summary);
  WarnOfSolver(options_.solver, &summary);
  Warn(options_.obstacle.has_value(), &summary);
  return result;
}

// Solves piece by piece, from coarse to fine.
void GeodesicLevels::SolvePieces(const AlignedPoses& poses, Progress* progress,
                                 Workspace* workspace, GeodesicResult* result) const {
  const std::vector<Shape>& aligned = poses.shapes;
  const std::vector<RigidMotion>& motions = poses.motions;
  GeodesicSummary& summary = result->summary;
  summary.termination = Termination::kConverged;
  Path& path = result->path;
  const int pieces = static_cast<int>(aligned.size()) - 1;
  const std::vector<ScheduleStep> schedule =
      MakeSchedule(kind_, hierarchy_.NumLevels(), options_.shapes);
  path.metric = metric_;
  path.poses = {0};
  path.shapes = {aligned[0]};
  path.parameters = {0};
  path.motions = {motions[0]};
  Workload workload(progress, options_.tolerance, options_.max_iterations);
  const bool more_shapes_allowed = MostShapes(*metric_, pieces, options_) > options_.shapes;
  for (int i = 0; i < pieces; ++i) {
    internal::Plan(i, schedule, *workspace, options_.start, &workload);
  }
  for (int i = 0; i < pieces; ++i) {
    std::vector<Shape> shapes;
    if (workload.Stopped() || AreNear(aligned[i], aligned[i + 1])) {
      shapes = Blend(aligned[i], aligned[i + 1], options_.shapes);
    }
    if (!workload.Stopped() &&
        (shapes.empty() || !IsSolved(i, shapes, options_, &workspace->back(), &summary))) {
      GeodesicPiece piece(i, hierarchy_, workspace, options_, &workload, &summary);
      piece.Run(schedule, more_shapes_allowed);
      shapes = std::move(piece).Result();
      MoveStraight(without_cost_, &shapes);
      if (workload.Stopped() && i + 1 < pieces) {
        summary.warnings.push_back("cancelled: the pieces from " + std::to_string(i + 1) +
                                   " on are straight-line blends of their poses");
      }
    }
    for (int k = 1; k <= options_.shapes + 1; ++k) {
      const double t = static_cast<double>(k) / (options_.shapes + 1);
      metric_->connectivity->CopyToTwins(&shapes[k]);
      path.shapes.push_back(std::move(shapes[k]));
      path.parameters.push_back((i + t) / pieces);
      path.motions.push_back(InterpolateMotion(motions[i], motions[i + 1], t));
    }
    path.poses.push_back(path.NumShapes() - 1);
  }
  if (options_.avoid_contact) AvoidContact(workspace, &workload, result);
  if (workload.Stopped()) summary.termination = Termination::kCancelled;
}

// Replaces each piece of the path by one without contact; all of it if it leads near other shapes.
void GeodesicLevels::AvoidContact(Workspace* workspace, Workload* workload,
                                  GeodesicResult* result) const {
  Path& path = result->path;
  if (!options_.via.empty()) path.poses = {0, path.NumShapes() - 1};
  std::vector<Shape> guide = path.shapes;
  std::optional<Obstacle> obstacle = options_.obstacle;
  const Eigen::Vector3d origin = path.motions.front().translation;
  if (obstacle) {
    obstacle = internal::InFrame(*obstacle, origin, metric_->unit);
    for (int k = 0; k < path.NumShapes(); ++k) {
      guide[k] = (path.Placed(k).colwise() - origin) / metric_->unit;
    }
  }
  const int pieces = static_cast<int>(path.poses.size()) - 1, segments = options_.shapes + 1;
  std::vector<Shape> shapes = {guide.front()};
  std::vector<double> parameters = {0};
  std::vector<RigidMotion> motions = {path.motions.front()};
  std::vector<int> poses = {0};
  for (int i = 0; i < pieces; ++i) {
    const int from = path.poses[i], to = path.poses[i + 1];
    const std::vector<Shape> piece =
        ContactPiece(i, hierarchy_, workspace, options_, obstacle ? &*obstacle : nullptr, workload,
                     &result->summary)
            .Run({guide.begin() + from, guide.begin() + to + 1});
    for (int k = 1; k <= segments; ++k) {
      const double t = static_cast<double>(k) / segments;
      shapes.push_back(piece[k]);
      metric_->connectivity->CopyToTwins(&shapes.back());
      parameters.push_back((i + t) / pieces);
      motions.push_back(to - from == segments
                            ? path.motions[from + k]
                            : InterpolateMotion(path.motions[from], path.motions[to], t));
    }
    poses.push_back(static_cast<int>(shapes.size()) - 1);
  }
  if (obstacle) {
    for (Shape& shape : shapes) shape = (metric_->unit * shape).colwise() + origin;
    AlignedPoses aligned = AlignPoses(*metric_, shapes);
    shapes = std::move(aligned.shapes);
    motions = std::move(aligned.motions);
  }
  path.shapes = std::move(shapes);
  path.parameters = std::move(parameters);
  path.motions = std::move(motions);
  path.poses = std::move(poses);
}

// Fills in the fields of the summary that are the same for all paths.
void GeodesicLevels::Describe(GeodesicSummary* summary) const {
  const Connectivity& connectivity = *metric_->connectivity;
  for (const SharedLevel& level : levels_) {
    summary->hierarchy.push_back(level.metric->connectivity->NumVertices());
  }
  summary->hierarchy_stopped_early = hierarchy_.StoppedEarly();
  summary->metric = DescribeMetric(metric_->options);
  summary->vertices = connectivity.NumVertices();
  summary->triangles = connectivity.NumTriangles();
  summary->edges = connectivity.NumEdges();
  summary->hinges = connectivity.NumHinges();
  summary->shapes = options_.shapes;
  summary->unit = metric_->unit;
  summary->threads = NumThreads();
}

}  // namespace internal

GeodesicResult Interpolate(const std::shared_ptr<const Metric>& metric,
                           const std::vector<Shape>& poses, const GeodesicOptions& options,
                           Progress* progress) {
  options.Validate();
  if (poses.size() < 2) throw MeshError("a geodesic needs at least two poses");
  if (!options.via.empty() && poses.size() > 2) throw InvalidOptions("via", "is for two poses");
  std::vector<Shape> shapes = poses;
  shapes.insert(shapes.end() - 1, options.via.begin(), options.via.end());
  for (const Shape& shape : shapes) CheckShape(shape, *metric);
  const int count = static_cast<int>(shapes.size());
  const double bytes =
      internal::GeodesicBytes(*metric, count, MostShapes(*metric, count - 1, options));
  CheckFinest(*metric, bytes, options);
  const internal::Stopwatch total;
  ReportProgress(progress, "decimating", 0, 0);
  const AlignedPoses aligned = internal::AlignFolds(*metric, AlignPoses(*metric, shapes));
  const internal::GeodesicLevels levels(metric, aligned.shapes, PosePairs::kConsecutive, options,
                                        progress);
  const double hierarchy_seconds = total.Seconds();
  GeodesicResult result = levels.Solve(aligned, progress);
  result.summary.hierarchy_seconds = hierarchy_seconds;
  result.summary.estimated_bytes = bytes;
  result.summary.total_seconds = total.Seconds();
  return result;
}

Interpolator::Interpolator(const std::shared_ptr<const Connectivity>& connectivity,
                           const std::vector<Shape>& poses, const GeodesicOptions& options) {
  options.Validate();
  if (!options.via.empty()) throw InvalidOptions("via", "is for one path between two poses");
  if (options.obstacle) {
    throw InvalidOptions("obstacle", "is for one path: shapes of an Interpolator have no place");
  }
  const auto metric = FreezeMetric(options.metric, connectivity, poses, 0, PosePairs::kAll);
  const double pose_bytes = 2.0 * sizeof(double) * poses.size() * poses.front().size();
  const int most_shapes = MostShapes(*metric, 1, options);
  estimated_bytes_ = internal::GeodesicBytes(*metric, 2, most_shapes) + pose_bytes;
  CheckFinest(*metric, estimated_bytes_, options);
  const double left = options.memory_limit - estimated_bytes_;
  constexpr double kMostThreads = 1e6;
  most_at_once_ =
      1 + static_cast<int>(std::clamp(left / internal::FurtherGeodesicBytes(*metric, most_shapes),
                                      0.0, kMostThreads));
  levels_ = std::make_unique<internal::GeodesicLevels>(metric, AlignPoses(*metric, poses).shapes,
                                                       PosePairs::kAll, options);
}

Interpolator::~Interpolator() = default;
Interpolator::Interpolator(Interpolator&&) noexcept = default;
Interpolator& Interpolator::operator=(Interpolator&&) noexcept = default;

const std::shared_ptr<const Metric>& Interpolator::GetMetric() const {
  return levels_->GetMetric();
}

int Interpolator::MostAtOnce() const { return most_at_once_; }

GeodesicResult Interpolator::Between(const Shape& from, const Shape& to, Progress* progress) const {
  CheckShape(from, *GetMetric());
  CheckShape(to, *GetMetric());
  const internal::Stopwatch total;
  const AlignedPoses aligned =
      internal::AlignFolds(*GetMetric(), AlignPoses(*GetMetric(), {from, to}));
  GeodesicResult result = levels_->Solve(aligned, progress);
  result.summary.estimated_bytes = estimated_bytes_;
  result.summary.total_seconds = total.Seconds();
  return result;
}

GeodesicResult Interpolate(const Poses& poses, const GeodesicOptions& options, Progress* progress) {
  GeodesicResult result = Interpolate(poses.connectivity, poses.shapes, options, progress);
  result.path.appearance = poses.soup.appearance;
  return result;
}

}  // namespace shapespace
