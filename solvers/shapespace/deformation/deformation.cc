#include <shapespace/deformation/deformation.h>

#include <cmath>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include <shapespace/analysis/path_intersections.h>
#include <shapespace/base/error.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/base/parallel.h>
#include <shapespace/contact/internal/avoid_contact.h>
#include <shapespace/cost/internal/refuse_sums.h>
#include <shapespace/deformation/detail/contact_deformation.h>
#include <shapespace/deformation/detail/count_intersections.h>
#include <shapespace/deformation/detail/handle_targets.h>
#include <shapespace/deformation/detail/held_level.h>
#include <shapespace/deformation/detail/memory.h>
#include <shapespace/geodesic/internal/resolution.h>
#include <shapespace/geodesic/internal/workload.h>
#include <shapespace/hierarchy/freeze_level.h>
#include <shapespace/hierarchy/hierarchy.h>
#include <shapespace/mesh/different_meshes.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/mesh/topology.h>
#include <shapespace/path/align.h>
#include <shapespace/summary/internal/check_options.h>
#include <shapespace/summary/internal/memory.h>

namespace shapespace {
namespace {

using internal::ContactModel;
using internal::HandleTargets;
using internal::HeldLevel;

// Least number of steps in which handles are moved on the coarsest level.
constexpr int kFollowSteps = 10;

// A solve starts from the last one if no handle turns further than this, in radians, and no handle
// vertex moves further than this, in the unit that is the square root of the surface area.
constexpr double kLittle = 0.1;

// On all levels but the finest a solve may stop when a step is expected to gain less than this
// share of the total gain.
constexpr double kLeastGain = 1e-3;

// If a handle turns further than this between neighbouring shapes, a warning is given: bars lost
// turns of 180 degrees between neighbours, but not turns of 120.
constexpr double kFarthestTurn = 2 * internal::kPi / 3;

// If this share of the edges differs from the rest by more than its length there, a warning is
// given: one in a hundred edges is then more than twice as long.
constexpr double kTornEdge = 1;

// A hard handle that misses its target by more than this share of the unit is reported. The margin
// allows for rounding far from the origin; a handle without conflict is met.
constexpr double kContradiction = 1e-9;

// Handles on the vertices that have elements. Of several that are one point of the surface the
// first counts; vertices that do not exist, or are listed twice, remain for the check.
std::vector<DeformationHandle> HandlesOnRepresentatives(std::vector<DeformationHandle> handles,
                                                        const Connectivity& connectivity) {
  if (connectivity.Twins().empty()) return handles;
  for (DeformationHandle& handle : handles) {
    std::map<int, int> first;  // by representative, the vertex that was listed first
    std::vector<int> kept;
    std::vector<int> vertices;
    for (size_t k = 0; k < handle.vertices.size(); ++k) {
      int v = handle.vertices[k];
      if (v >= 0 && v < connectivity.NumVertices()) {
        const auto [found, is_new] = first.try_emplace(connectivity.Representative(v), v);
        if (!is_new && found->second != v) continue;
        v = found->first;
      }
      kept.push_back(static_cast<int>(k));
      vertices.push_back(v);
    }
    const bool fits =
        handle.positions && handle.positions->cols() == static_cast<int>(handle.vertices.size());
    if (fits) handle.positions = Shape((*handle.positions)(Eigen::all, kept));
    handle.vertices = std::move(vertices);
  }
  return handles;
}

}  // namespace

void DeformationOptions::Validate() const {
  if (metric) {
    metric->Validate();
    if (metric->rigid > 0) {
      throw InvalidOptions("rigid", "a deformation takes no rigid metric; use rigid 0");
    }
    if (metric->discretization != Discretization::kMidpoint) {
      throw InvalidOptions("discretization", "a deformation takes the midpoint form only");
    }
  }
  if (shapes < 1) throw InvalidOptions("shapes", "must be 1 or more");
  if (!(balance > 0) || !(balance <= 1)) throw InvalidOptions("balance", "must be in (0, 1]");
  internal::CheckTolerance(tolerance);
  internal::CheckMaxIterations(max_iterations);
  HierarchyOptions{coarsest, {}}.Validate();
  internal::CheckMemoryLimit(memory_limit);
  internal::CheckObstacle(obstacle, avoid_contact);
}

// Stores the data of a solve that the next one can reuse.
class Deformer::Solver {
 public:
  Solver(const std::shared_ptr<const Connectivity>& connectivity, const Shape& rest,
         const DeformationOptions& options);

  // `end` is the initial guess of the last shape, in the user's unit; if null, it is found by
  // following the handles.
  DeformationResult Solve(const std::vector<DeformationHandle>& handles, const Shape* end,
                          Progress* progress);

 private:
  void CheckEnd(const Shape& end) const;
  void Prepare(const HandleTargets& targets, DeformationSummary* summary);
  std::vector<Shape> Cascade(const HandleTargets& targets,
                             const std::vector<Shape>& handle_positions, const Shape* end,
                             Progress* progress, internal::Workload* workload,
                             DeformationSummary* summary);
  std::vector<Shape> Follow(const HandleTargets& targets, Progress* progress);
  std::vector<Shape> StartAt(const Shape& end, const Shape& handle_positions, Progress* progress);
  void Relax(const Shape& handle_positions, size_t level, const char* start,
             internal::Workload* workload, std::vector<Shape>* shapes, DeformationSummary* summary);
  std::vector<Shape> Lift(const std::vector<Shape>& path, size_t level,
                          const std::vector<Shape>& handle_positions);
  void AddRow(const char* start, int vertices, const internal::MinimiseResult& result,
              double seconds, DeformationSummary* summary) const;
  std::vector<Shape> AvoidContact(const HandleTargets& targets,
                                  const std::vector<Shape>& handle_positions,
                                  const std::vector<Shape>& shapes, internal::Workload* workload,
                                  DeformationSummary* summary);
  ContactModel Model(size_t level) const;
  std::vector<Shape> StepAside(const ContactModel& model, const HandleTargets& targets,
                               const std::vector<Shape>& guide, size_t level,
                               internal::Workload* workload, DeformationSummary* summary);
  void Assess(const std::vector<DeformationHandle>& handles, const HandleTargets& targets,
              const std::vector<Shape>& shapes, DeformationResult* result);
  void Warn(const HandleTargets& targets, DeformationSummary* summary) const;
  internal::MinimiseOptions Minimise() const;

  const DeformationOptions options_;
  const std::shared_ptr<const Connectivity> connectivity_;
  const Shape given_;  // the mesh, in the user's unit
  std::shared_ptr<const Metric> metric_;
  double estimated_bytes_ = 0;
  Eigen::Vector3d origin_;            // in the user's unit; subtracted from all shapes below
  Shape rest_;                        // the mesh, in the metric's unit
  std::optional<Obstacle> obstacle_;  // likewise
  std::vector<int> component_;
  std::optional<Hierarchy> hierarchy_;
  std::vector<HeldLevel> levels_;
  // The targets and the path of the last solve that was not cancelled. If there is no path, the
  // targets are those for which the levels were prepared.
  std::optional<HandleTargets> last_targets_;
  std::vector<Shape> last_shapes_;
};

Deformer::Solver::Solver(const std::shared_ptr<const Connectivity>& connectivity, const Shape& rest,
                         const DeformationOptions& options)
    : options_(options), connectivity_(connectivity), given_(rest) {
  options.Validate();
  metric_ = FreezeMetric(options.metric.value_or(MetricOptions::Deformation(*connectivity, rest)),
                         connectivity, {rest});
  if (options.solver == DeformationOptions::Solver::kTrustRegion) cost::RefuseDenseRows(*metric_);
  estimated_bytes_ = internal::DeformationBytes(*metric_, options.shapes);
  internal::CheckMemory("this deformation", estimated_bytes_, options.memory_limit,
                        "ask for fewer shapes");
  origin_ = Centroid(rest, metric_->vertex_area);
  rest_ = (rest.colwise() - origin_) / metric_->unit;
  obstacle_ = options.obstacle;
  if (obstacle_) obstacle_ = internal::InFrame(*obstacle_, origin_, metric_->unit);
  component_ = ComputeTopology(*connectivity).component;
}

DeformationResult Deformer::Solver::Solve(const std::vector<DeformationHandle>& given,
                                          const Shape* end, Progress* progress) {
  const internal::Stopwatch total;
  const std::vector<DeformationHandle> handles = HandlesOnRepresentatives(given, *connectivity_);
  ReportProgress(progress, "deforming", 0, 0);
  DeformationResult result;
  DeformationSummary& summary = result.summary;
  HandleTargets targets(handles, given_, origin_, metric_->unit);
  std::vector<Shape> handle_positions;  // targets of held vertices, at the parameters of the shapes
  for (int i = 0; i <= options_.shapes; ++i) {
    handle_positions.push_back(targets.At(static_cast<double>(i) / options_.shapes));
  }
  if (end != nullptr) CheckEnd(*end);
  if (!last_targets_ || !targets.HoldAlike(*last_targets_)) Prepare(targets, &summary);

  internal::Workload workload(progress, options_.tolerance, options_.max_iterations);
  const internal::Stopwatch solving;
  summary.warm = !last_shapes_.empty() && end == nullptr && targets.IsNear(*last_targets_, kLittle);
  std::vector<Shape> shapes;
  if (summary.warm) {
    workload.Plan(connectivity_->NumVertices(), options_.shapes, true);
    shapes = last_shapes_;
    levels_.back().MoveHandlesTo(handle_positions, &shapes);
    Relax(handle_positions.back(), levels_.size() - 1, "warm", &workload, &shapes, &summary);
  } else {
    shapes = Cascade(targets, handle_positions, end, progress, &workload, &summary);
  }
  summary.solve_seconds = solving.Seconds();
  summary.termination = summary.levels.back().termination;
  std::vector<Shape> around;
  if (options_.avoid_contact && !workload.Stopped()) {
    around = AvoidContact(targets, handle_positions, shapes, &workload, &summary);
  }
  if (workload.Stopped()) summary.termination = Termination::kCancelled;
  Assess(handles, targets, around.empty() ? shapes : around, &result);
  if (summary.termination != Termination::kCancelled) {
    last_targets_.emplace(std::move(targets));
    last_shapes_ = std::move(shapes);
  }
  summary.total_seconds = total.Seconds();
  return result;
}

void Deformer::Solver::CheckEnd(const Shape& end) const {
  if (end.cols() != given_.cols()) {
    throw MeshError(internal::OfOtherMesh("the end", end.cols(), static_cast<int>(given_.cols())));
  }
  for (int v = 0; v < end.cols(); ++v) {
    if (end.col(v).allFinite()) continue;
    throw MeshError("the end is not finite at vertex " + std::to_string(v + 1) +
                    " (counted from 1)");
  }
}

// Computes hierarchy and factors if handles hold other vertices than before, or in another way.
void Deformer::Solver::Prepare(const HandleTargets& targets, DeformationSummary* summary) {
  last_targets_.reset();
  last_shapes_.clear();
  levels_.clear();
  const internal::Stopwatch building;
  hierarchy_.emplace(connectivity_, std::vector<Shape>{rest_},
                     HierarchyOptions{options_.coarsest, targets.Pins()});
  summary->hierarchy_seconds = building.Seconds();
  const internal::Stopwatch factoring;
  const double strength = 2 * (1 - options_.balance) / options_.balance;
  for (int i = 0; i < hierarchy_->NumLevels(); ++i) {
    const std::vector<int>& vertices = hierarchy_->Vertices(i);
    Shape rest = hierarchy_->Restrict(rest_, i);
    auto metric = metric_;
    if (i + 1 < hierarchy_->NumLevels()) {
      metric = FreezeLevel(*metric_, *hierarchy_, i, {rest});
    }
    std::vector<int> component;
    for (int v : vertices) component.push_back(component_[v]);
    levels_.emplace_back(metric, std::move(rest), vertices, std::move(component), targets,
                         strength);
  }
  summary->factor_seconds = factoring.Seconds();
  last_targets_.emplace(targets);
}

std::vector<Shape> Deformer::Solver::Cascade(const HandleTargets& targets,
                                             const std::vector<Shape>& handle_positions,
                                             const Shape* end, Progress* progress,
                                             internal::Workload* workload,
                                             DeformationSummary* summary) {
  for (const HeldLevel& level : levels_) {
    workload->Plan(level.NumVertices(), options_.shapes, &level == &levels_.back());
  }
  std::vector<Shape> shapes =
      end == nullptr ? Follow(targets, progress) : StartAt(*end, handle_positions.back(), progress);
  const char* start = end == nullptr ? "handles" : "given";
  for (size_t i = 0; i < levels_.size(); ++i) {
    if (i > 0) {
      shapes = Lift(shapes, i, handle_positions);
      start = "lifted";
    }
    if (!workload->Stopped()) Relax(handle_positions.back(), i, start, workload, &shapes, summary);
  }
  return shapes;
}

// A path of the next coarser level on this one, with the detail of the mesh.
std::vector<Shape> Deformer::Solver::Lift(const std::vector<Shape>& path, size_t level,
                                          const std::vector<Shape>& handle_positions) {
  const Shape &rest = levels_[level].Rest(), &coarse_rest = levels_[level - 1].Rest();
  const int below = static_cast<int>(level) - 1;
  std::vector<Shape> lifted(options_.shapes);
  std::vector<std::vector<Eigen::Matrix3d>> gradients(options_.shapes);
  ParallelFor(options_.shapes, [&](int k) {
    lifted[k] = hierarchy_->Lift(path[k + 1], below, rest, rest, 0);
    gradients[k] = hierarchy_->LiftGradients(path[k + 1], below, coarse_rest);
    levels_[level].Place(handle_positions[k + 1], k + 1 == options_.shapes, &lifted[k]);
  });
  levels_[level].Path().Factors().Integrate(gradients, &lifted);
  lifted.insert(lifted.begin(), rest);
  return lifted;
}

internal::MinimiseOptions Deformer::Solver::Minimise() const {
  internal::MinimiseOptions minimise;
  minimise.tolerance = options_.tolerance;
  minimise.max_iterations = options_.max_iterations;
  return minimise;
}

// Follows the handles on the coarsest level in small steps (numerical continuation). Each step adds
// a shape to the path, which is then relaxed as a whole: a path keeps the number of revolutions of
// a part, which a single shape may lose when it is relaxed.
std::vector<Shape> Deformer::Solver::Follow(const HandleTargets& targets, Progress* progress) {
  HeldLevel& level = levels_.front();
  const int between = (kFollowSteps + options_.shapes - 1) / options_.shapes;
  const int steps = between * options_.shapes;
  internal::MinimiseOptions minimise = Minimise();
  std::vector<Shape> way = {level.Rest()}, result = way;
  for (int step = 1; step <= steps; ++step) {
    minimise.keep_going = [&](int, double) {
      ReportProgress(progress, "following the handles", step, steps);
      return true;
    };
    const Shape handle_positions = targets.At(static_cast<double>(step) / steps);
    std::vector<Shape> last = {way.back(), way.back()};
    level.MoveComponents(handle_positions, &last.back());
    level.MoveHandlesTo({{}, handle_positions}, &last);
    way.push_back(std::move(last.back()));
    level.Path().Relax(level.Target(handle_positions), minimise, &way);
  }
  for (int i = between; i <= steps; i += between) result.push_back(std::move(way[i]));
  return result;
}

// Starts from a given last shape, which is relaxed by itself. The shapes before it form a geodesic
// from the first.
std::vector<Shape> Deformer::Solver::StartAt(const Shape& end, const Shape& handle_positions,
                                             Progress* progress) {
  HeldLevel& level = levels_.front();
  std::vector<Shape> pair = {level.Rest(),
                             hierarchy_->Restrict((end.colwise() - origin_) / metric_->unit, 0)};
  internal::MinimiseOptions minimise = Minimise();
  minimise.keep_going = [&](int, double) {
    ReportProgress(progress, "deforming", 0, 0);
    return true;
  };
  level.MoveHandlesTo({{}, handle_positions}, &pair);
  level.Path().Relax(level.Target(handle_positions), minimise, &pair);
  if (options_.shapes == 1) return pair;
  GeodesicOptions geodesic;
  geodesic.shapes = options_.shapes - 1;
  geodesic.tolerance = options_.tolerance;
  const GeodesicResult result =
      Interpolate(level.Path().GetMetric()->connectivity, pair, geodesic, progress);
  if (result.summary.termination == Termination::kCancelled) throw Cancelled();
  return result.path.Placed();
}

void Deformer::Solver::Relax(const Shape& handle_positions, size_t level_index, const char* start,
                             internal::Workload* workload, std::vector<Shape>* shapes,
                             DeformationSummary* summary) {
  const internal::Stopwatch stopwatch;
  HeldLevel& level = levels_[level_index];
  const bool finest = level_index + 1 == levels_.size();
  const int vertices = level.NumVertices();
  workload->Begin(std::to_string(vertices) + " vertices, " + std::to_string(options_.shapes) +
                      (options_.shapes == 1 ? " shape" : " shapes"),
                  vertices, options_.shapes, finest);
  internal::MinimiseOptions minimise = Minimise();
  minimise.enough = finest ? 0 : kLeastGain;
  minimise.keep_going = [&](int iteration, double value) {
    return workload->GoOn(iteration, value);
  };
  const Shape target = level.Target(handle_positions);
  const internal::MinimiseResult result =
      options_.solver == DeformationOptions::Solver::kTrustRegion
          ? level.Path().RelaxByTrustRegion(target, minimise, shapes)
          : level.Path().Relax(target, minimise, shapes);
  workload->End();
  AddRow(start, vertices, result, stopwatch.Seconds(), summary);
}

void Deformer::Solver::AddRow(const char* start, int vertices,
                              const internal::MinimiseResult& result, double seconds,
                              DeformationSummary* summary) const {
  DeformationSummary::Level row;
  row.vertices = vertices;
  row.shapes = options_.shapes;
  row.start = start;
  row.termination = result.termination;
  row.iterations = result.iterations;
  row.evaluations = result.evaluations;
  row.initial_value = ScaledEnergy(result.initial_energy, options_.shapes);
  row.value = ScaledEnergy(result.energy, options_.shapes);
  row.seconds = seconds;
  summary->levels.push_back(row);
}

// The path without contact; empty if the given one has none, or, with a warning, if none is found.
std::vector<Shape> Deformer::Solver::AvoidContact(const HandleTargets& targets,
                                                  const std::vector<Shape>& handle_positions,
                                                  const std::vector<Shape>& shapes,
                                                  internal::Workload* workload,
                                                  DeformationSummary* summary) {
  const internal::Stopwatch stopwatch;
  const ContactModel model = Model(levels_.size() - 1);
  if (model.NumIntersections() > 0) {
    summary->warnings.push_back(internal::WarningOfIntersections(
        obstacle_ ? "the mesh intersects itself or the obstacle" : "the mesh intersects itself",
        model));
  }
  std::vector<int> touching = internal::SegmentsWithContact(model, shapes);
  std::vector<Shape> path;
  if (!touching.empty()) {
    // A way that is not found on a coarse level is not found on finer ones either, in much more
    // time.
    size_t level =
        internal::FirstLevelOfContact(static_cast<int>(levels_.size()) - 1,
                                      model.NumIntersections(), [&](int i) { return Model(i); });
    std::vector<Shape> guide;
    for (const Shape& shape : shapes) {
      guide.push_back(hierarchy_->Restrict(shape, static_cast<int>(level)));
    }
    while (level + 1 < levels_.size()) {
      path = StepAside(Model(level), targets, guide, level, workload, summary);
      if (path.empty() || workload->Stopped()) break;
      guide = Lift(path, ++level, handle_positions);
    }
    path.clear();
    if (level + 1 == levels_.size()) {
      path = StepAside(model, targets, guide, level, workload, summary);
    }
    if (!path.empty()) {
      summary->termination = summary->levels.back().termination;
      touching = internal::SegmentsWithContact(model, path);
      if (!touching.empty()) {
        summary->warnings.push_back(
            internal::WarningOfUncertified(static_cast<int>(touching.size())) +
            "; ask for more shapes");
      }
    }
    summary->contact_distance = internal::LeastDistance(model, path.empty() ? shapes : path);
  }
  summary->uncertified_segments = static_cast<int>(touching.size());
  summary->contact_seconds = stopwatch.Seconds();
  return path;
}

ContactModel Deformer::Solver::Model(size_t level) const {
  return {levels_[level].Path().GetMetric(),
          {levels_[level].Rest()},
          ContactModel::Intersections::kExempt,
          obstacle_ ? &*obstacle_ : nullptr};
}

// The deformation of a level without contact, with a row in the summary; empty, with a warning, if
// none is found.
std::vector<Shape> Deformer::Solver::StepAside(const ContactModel& model,
                                               const HandleTargets& targets,
                                               const std::vector<Shape>& guide, size_t level_index,
                                               internal::Workload* workload,
                                               DeformationSummary* summary) {
  const internal::Stopwatch stopwatch;
  HeldLevel& level = levels_[level_index];
  const bool finest = level_index + 1 == levels_.size();
  const int vertices = level.NumVertices();
  workload->Plan(vertices, options_.shapes, finest);
  workload->Begin(std::to_string(vertices) + " vertices, round contacts", vertices, options_.shapes,
                  finest);
  internal::MinimiseOptions minimise = Minimise();
  minimise.enough = finest ? 0 : kLeastGain;
  minimise.keep_going = [&](int iteration, double value) {
    return workload->GoOn(iteration, value);
  };
  const double energy = ScaledEnergy(level.Path().Energy(guide), options_.shapes);
  internal::ContactFreeDeformation found = internal::DeformWithoutContact(
      model, targets, internal::kContactStiffness * energy, guide, minimise,
      [&] { return workload->GoOn(0, energy); }, &level);
  workload->End();
  if (!found.shapes.empty()) {
    AddRow("contact", vertices, found.result, stopwatch.Seconds(), summary);
  } else if (!workload->Stopped()) {
    summary->warnings.push_back(
        std::string("no deformation was found in which the body does not pass through itself") +
        (obstacle_ ? " or the obstacle" : "") + ": the handles got " +
        std::to_string(std::lround(100 * found.reached)) +
        "% of their way; it does in the path that is returned");
  }
  return std::move(found.shapes);
}

void Deformer::Solver::Assess(const std::vector<DeformationHandle>& handles,
                              const HandleTargets& targets, const std::vector<Shape>& shapes,
                              DeformationResult* result) {
  DeformationSummary& summary = result->summary;
  summary.vertices = connectivity_->NumVertices();
  summary.triangles = connectivity_->NumTriangles();
  summary.shapes = options_.shapes;
  summary.metric = DescribeMetric(metric_->options);
  summary.unit = metric_->unit;
  summary.balance = options_.balance;
  summary.estimated_bytes = estimated_bytes_;
  summary.threads = NumThreads();
  summary.energy = ScaledEnergy(levels_.back().Path().Energy(shapes), options_.shapes);
  summary.error = CompareShapes(metric_, shapes.front(), shapes.back());
  for (int i = 0; i < hierarchy_->NumLevels(); ++i) {
    summary.hierarchy.push_back(static_cast<int>(hierarchy_->Vertices(i).size()));
  }
  std::vector<Shape> placed;
  for (const Shape& shape : shapes) placed.push_back((metric_->unit * shape).colwise() + origin_);
  for (const DeformationHandle& handle : handles) {
    DeformationSummary::HandleResult row;
    row.name = handle.name;
    row.vertices = static_cast<int>(handle.vertices.size());
    row.hard = handle.hard;
    double squares = 0, area = 0;
    for (size_t k = 0; k < handle.vertices.size(); ++k) {
      const int v = handle.vertices[k];
      const Eigen::Vector3d wanted = handle.Target(static_cast<int>(k), 1, given_.col(v));
      const double distance = (placed.back().col(v) - wanted).norm();
      squares += metric_->vertex_area(v) * distance * distance;
      area += metric_->vertex_area(v);
      row.residual_max = std::fmax(row.residual_max, distance);
    }
    row.residual_rms = std::sqrt(squares / area);
    summary.handles.push_back(row);
  }
  Warn(targets, &summary);

  Path& path = result->path;
  path.metric = metric_;
  AlignedPoses aligned = AlignPoses(*metric_, placed);
  path.shapes = std::move(aligned.shapes);
  path.motions = std::move(aligned.motions);
  for (int i = 0; i <= options_.shapes; ++i) {
    path.parameters.push_back(static_cast<double>(i) / options_.shapes);
  }
  path.poses = {0};
  path.converged = summary.Converged();
}

// Appends warnings for the user.
void Deformer::Solver::Warn(const HandleTargets& targets, DeformationSummary* summary) const {
  if (summary->termination == Termination::kMaxIterations) {
    summary->warnings.push_back("out of iterations; raise max_iterations or the tolerance");
  } else if (summary->termination == Termination::kStalled) {
    summary->warnings.push_back("stalled: the line search found no better point");
  } else if (summary->termination == Termination::kCancelled) {
    summary->warnings.push_back("cancelled: the shapes are the best so far");
  }
  const auto is_contact = [](const auto& level) { return level.start == "contact"; };
  if (options_.solver == DeformationOptions::Solver::kTrustRegion &&
      std::any_of(summary->levels.begin(), summary->levels.end(), is_contact)) {
    summary->warnings.push_back(
        "the deformation without contact was found by this library's own L-BFGS, not by the trust "
        "region, which knows no contact");
  }
  std::map<int, std::pair<int, int>> pieces;  // number of vertices, and the first vertex
  for (size_t v = 0; v < component_.size(); ++v) {
    if (component_[v] < 0) continue;
    ++pieces.try_emplace(component_[v], 0, static_cast<int>(v)).first->second.first;
  }
  for (int v : targets.Held()) pieces.erase(component_[v]);
  summary->free_components = static_cast<int>(pieces.size());
  constexpr int kNamed = 3;
  int named = 0;
  for (const auto& [component, piece] : pieces) {
    if (named++ == kNamed) {
      summary->warnings.push_back(std::to_string(pieces.size() - kNamed) +
                                  " further connected components have no handle and stay too");
      break;
    }
    summary->warnings.push_back("no handle holds the connected component of " +
                                std::to_string(piece.first) + " vertices that begins with vertex " +
                                std::to_string(piece.second + 1) +
                                " (counted from 1); it stays where it is");
  }
  const double turn = targets.GreatestTurn() / options_.shapes;
  if (turn > kFarthestTurn) {
    summary->warnings.push_back(
        "a handle turns by " + std::to_string(std::lround(turn * internal::kDegrees)) +
        " degrees from one shape to the next, and the body may lose such a turn; ask for " +
        std::to_string(static_cast<int>(std::ceil(targets.GreatestTurn() / (internal::kPi / 2)))) +
        " shapes or more");
  }
  if (summary->error.edge_p99 > kTornEdge) {
    summary->warnings.push_back(
        "one edge in a hundred has become longer by " +
        std::to_string(std::lround(100 * summary->error.edge_p99)) +
        " % or more: the handles ask for more than the body can give without being torn; move them "
        "less, or hold fewer vertices");
  }
  const double far = kContradiction * (summary->unit + 1e-3 * origin_.norm());
  for (const DeformationSummary::HandleResult& handle : summary->handles) {
    if (handle.hard && handle.residual_max > far) {
      summary->warnings.push_back(
          "the hard handle" + (handle.name.empty() ? "" : " \"" + handle.name + "\"") +
          " shares vertices with another that has different targets for them; they are at the mean "
          "of the targets");
    }
  }
}

void internal::CountIntersectionsOf(DeformationResult* result) {
  DeformationSummary& summary = result->summary;
  if (summary.termination == Termination::kCancelled) return;
  const internal::Stopwatch stopwatch;
  try {
    const std::vector<std::int64_t> pairs = MeasureIntersections(result->path).pairs;
    summary.intersections =
        static_cast<double>(*std::max_element(pairs.begin(), pairs.end()) - pairs.front());
  } catch (const Error& error) {  // no reason to discard the path
    summary.warnings.push_back(std::string("not counted: ") + error.what());
  }
  summary.total_seconds += stopwatch.Seconds();
  // Where contact was to be avoided and was not, a warning says so already.
  if (summary.uncertified_segments < 0 && summary.intersections > kManyIntersections) {
    summary.warnings.push_back("the body intersects itself: a shape has " +
                               std::to_string(std::lround(summary.intersections)) +
                               " more pairs of intersecting triangles than the mesh; avoid_contact "
                               "prevents this");
  }
}

Deformer::Deformer(const std::shared_ptr<const Connectivity>& connectivity, const Shape& rest,
                   const DeformationOptions& options)
    : solver_(std::make_unique<Solver>(connectivity, rest, options)) {}
Deformer::~Deformer() = default;
Deformer::Deformer(Deformer&&) noexcept = default;
Deformer& Deformer::operator=(Deformer&&) noexcept = default;

DeformationResult Deformer::Deform(const std::vector<DeformationHandle>& handles,
                                   Progress* progress) {
  return solver_->Solve(handles, nullptr, progress);
}

DeformationResult Deformer::DeformFrom(const Shape& end,
                                       const std::vector<DeformationHandle>& handles,
                                       Progress* progress) {
  return solver_->Solve(handles, &end, progress);
}

DeformationResult Deform(const std::shared_ptr<const Connectivity>& connectivity, const Shape& rest,
                         const std::vector<DeformationHandle>& handles,
                         const DeformationOptions& options, Progress* progress) {
  DeformationResult result = Deformer(connectivity, rest, options).Deform(handles, progress);
  internal::CountIntersectionsOf(&result);
  return result;
}

}  // namespace shapespace
