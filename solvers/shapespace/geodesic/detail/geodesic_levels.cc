#include <shapespace/geodesic/detail/geodesic_levels.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <utility>

#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/base/parallel.h>
#include <shapespace/geodesic/detail/assess.h>
#include <shapespace/geodesic/detail/contact_piece.h>
#include <shapespace/geodesic/detail/geodesic_piece.h>
#include <shapespace/geodesic/internal/memory.h>
#include <shapespace/hierarchy/freeze_level.h>
#include <shapespace/path/energy.h>

namespace shapespace::internal {
namespace {

GeodesicSchedule KindOfSchedule(const Metric& metric, const GeodesicOptions& options) {
  if (options.schedule != GeodesicSchedule::kAutomatic || metric.options.bending > 0) {
    return options.schedule;
  }
  return GeodesicSchedule::kFlat;
}

// Restricts all `shapes` to a level.
std::vector<Shape> Restrict(const Hierarchy& hierarchy, const std::vector<Shape>& shapes,
                            int level) {
  std::vector<Shape> restricted;
  for (const Shape& shape : shapes) restricted.push_back(hierarchy.Restrict(shape, level));
  return restricted;
}

// Prepares all levels, each with a metric of its own in the mesh's unit.
std::vector<SharedLevel> PrepareLevels(const Hierarchy& hierarchy,
                                       const std::shared_ptr<const Metric>& metric,
                                       const std::vector<Shape>& aligned, PosePairs pairs) {
  std::vector<SharedLevel> levels;
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
              Resolution* finest, GeodesicSummary* summary) {
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

}  // namespace

int MostShapes(const Metric& metric, int pieces, const GeodesicOptions& options) {
  constexpr double kVeryMuch = 8e9;
  if (options.shapes >= std::numeric_limits<int>::max() / 2) return options.shapes;
  const int twice = 2 * options.shapes + 1;
  return GeodesicBytes(metric, pieces + 1, twice) <= kVeryMuch ? twice : options.shapes;
}

GeodesicLevels::GeodesicLevels(const std::shared_ptr<const Metric>& metric,
                               const std::vector<Shape>& aligned, PosePairs pairs,
                               const GeodesicOptions& options, Progress* progress)
    : metric_(metric),
      options_(options),
      kind_(KindOfSchedule(*metric, options)),
      hierarchy_(metric->connectivity, aligned, MakeHierarchyOptions(), progress),
      levels_(PrepareLevels(hierarchy_, metric, aligned, pairs)),
      without_cost_(VerticesWithoutCost(*metric)) {}

HierarchyOptions GeodesicLevels::MakeHierarchyOptions() const {
  HierarchyOptions result;
  result.coarsest = kind_ == GeodesicSchedule::kFlat
                        ? std::max(options_.coarsest, metric_->connectivity->NumTriangles())
                        : options_.coarsest;
  return result;
}

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
  const Stopwatch solving;
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
  summary.termination = EndOf(summary);
  result.path.converged = summary.termination == Termination::kConverged;
  MeasureEnergy(result.path, options_, &workspace.back(), &summary);
  GiveBack(std::move(workspace));
  if (options_.assess) Assess(result.path, options_, &summary);
  Warn(options_, &summary);
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
    Plan(i, schedule, *workspace, options_.start, &workload);
  }
  // Appends piece i.
  const auto append = [&](int i, std::vector<Shape> shapes, Path* to) {
    for (int k = 1; k <= options_.shapes + 1; ++k) {
      const double t = static_cast<double>(k) / (options_.shapes + 1);
      metric_->connectivity->CopyToTwins(&shapes[k]);
      to->shapes.push_back(std::move(shapes[k]));
      to->parameters.push_back((i + t) / pieces);
      to->motions.push_back(InterpolateMotion(motions[i], motions[i + 1], t));
    }
    to->poses.push_back(to->NumShapes() - 1);
  };
  for (int i = 0; i < pieces; ++i) {
    std::vector<Shape> shapes;
    if (workload.Stopped() || AreNear(aligned[i], aligned[i + 1])) {
      shapes = Blend(aligned[i], aligned[i + 1], options_.shapes);
    }
    if (!workload.Stopped() &&
        (shapes.empty() || !IsSolved(i, shapes, options_, &workspace->back(), &summary))) {
      std::function<void(std::vector<Shape>)> show;
      if (options_.preview) {
        show = [&](std::vector<Shape> so_far) {
          Path preview = path;
          MoveStraight(without_cost_, &so_far);
          append(i, std::move(so_far), &preview);
          for (int j = i + 1; j < pieces; ++j) {
            append(j, Blend(aligned[j], aligned[j + 1], options_.shapes), &preview);
          }
          options_.preview(preview);
        };
      }
      GeodesicPiece piece(i, hierarchy_, workspace, options_, &workload, &summary, show);
      piece.Run(schedule, more_shapes_allowed);
      shapes = std::move(piece).Result();
      MoveStraight(without_cost_, &shapes);
      if (workload.Stopped() && i + 1 < pieces) {
        summary.warnings.push_back("cancelled: the pieces from " + std::to_string(i + 1) +
                                   " on are straight-line blends of their poses");
      }
    }
    append(i, std::move(shapes), &path);
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
    obstacle = InFrame(*obstacle, origin, metric_->unit);
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

}  // namespace shapespace::internal
