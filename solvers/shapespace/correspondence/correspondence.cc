#include <shapespace/correspondence/correspondence.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/base/parallel.h>
#include <shapespace/correspondence/detail/check_input.h>
#include <shapespace/correspondence/detail/closest.h>
#include <shapespace/correspondence/detail/gradient_fit.h>
#include <shapespace/correspondence/detail/marker_check.h>
#include <shapespace/correspondence/detail/marker_distances.h>
#include <shapespace/correspondence/detail/memory.h>
#include <shapespace/correspondence/detail/shell_fit.h>
#include <shapespace/correspondence/detail/similarity.h>
#include <shapespace/correspondence/detail/unfold.h>
#include <shapespace/hierarchy/hierarchy.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/mesh/ties.h>
#include <shapespace/mesh/topology.h>
#include <shapespace/mesh/volume.h>
#include <shapespace/path/align.h>
#include <shapespace/summary/internal/check_options.h>
#include <shapespace/summary/internal/memory.h>

namespace shapespace {
namespace {

using internal::Level;
using internal::MarkerDistances;
using internal::Target;

// Weights of the closest-point terms, ascending; their meaning is explained where they are used.
// With these values all pairs reach the figures of docs/measurements.md; half or twice as many
// rounds change the figures by less than a tenth.
constexpr double kCoarseWeights[] = {1, 3, 10, 30, 100};
constexpr int kCoarseRounds = 6;
constexpr double kFineWeight = 100, kLastWeight = 1000;
constexpr int kFineRounds = 3;
// Factor of the bending weight during the search for the pose.
constexpr double kCoarseBending = 3;
// Vertices of the target nearer than this are covered; share of the square root of its area.
constexpr double kCovered = 0.03;

// A body's own frame, in which its area is 1 and its centroid is at the origin.
struct OwnFrame {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double unit = 1;

  OwnFrame(const Connectivity& connectivity, const Shape& shape) {
    // In two steps, to avoid cancellation far from the origin and overflow of squares.
    const Eigen::Vector3d low = shape.rowwise().minCoeff();
    const double extent = (shape.rowwise().maxCoeff() - low).maxCoeff();
    const Shape near = (shape.colwise() - low) / extent;
    double area = 0;
    for (const auto& triangle : connectivity.Triangles().colwise()) {
      area += internal::TriangleArea(near, triangle);
    }
    centre = low + extent * (near * internal::VertexAreas(connectivity, near));
    unit = extent * std::sqrt(area);
  }

  Shape In(const Shape& shape) const { return (shape.colwise() - centre) / unit; }
  Shape Out(const Shape& shape) const { return (unit * shape).colwise() + centre; }
};

// Markers on vertices that have elements; vertices that do not exist remain for the check.
std::vector<CorrespondenceMarker> MarkersOnRepresentatives(
    std::vector<CorrespondenceMarker> markers, const Connectivity& template_connectivity,
    const Connectivity& target_connectivity) {
  const auto represent = [](const Connectivity& connectivity, int* v) {
    if (*v >= 0 && *v < connectivity.NumVertices()) *v = connectivity.Representative(*v);
  };
  for (CorrespondenceMarker& marker : markers) {
    represent(template_connectivity, &marker.template_vertex);
    represent(target_connectivity, &marker.target_vertex);
  }
  return markers;
}

// Checks the arguments of `Correspond`, and says in the summary how large they are.
void CheckInput(const Connectivity& template_connectivity, const Shape& template_shape,
                const Connectivity& target_connectivity, const Shape& target_shape,
                const std::vector<CorrespondenceMarker>& markers,
                const CorrespondenceOptions& options, CorrespondenceSummary* summary) {
  options.Validate();
  internal::CheckBody("template", template_connectivity, template_shape);
  internal::CheckBody("target", target_connectivity, target_shape);
  internal::CheckMarkers(markers, template_connectivity, target_connectivity);
  summary->estimated_bytes = internal::CorrespondenceBytes(
      template_connectivity, target_connectivity, static_cast<int>(markers.size()));
  internal::CheckMemory("this fit", summary->estimated_bytes, options.memory_limit,
                        "use meshes of fewer vertices");
  summary->template_vertices = template_connectivity.NumVertices();
  summary->template_triangles = template_connectivity.NumTriangles();
  summary->target_vertices = target_connectivity.NumVertices();
  summary->target_triangles = target_connectivity.NumTriangles();
}

// Ratio of the bodies' sizes: the median ratio of the distances between markers along the surface,
// which do not depend on poses or holes.
double RelativeSize(const Eigen::MatrixXf& on_template, const Eigen::MatrixXf& on_target,
                    const std::vector<int>& template_vertices,
                    const std::vector<int>& target_vertices) {
  std::vector<double> ratios;
  for (size_t k = 0; k < template_vertices.size(); ++k) {
    for (size_t l = 0; l < k; ++l) {
      const auto column = static_cast<Eigen::Index>(l);
      const double ratio =
          on_target(target_vertices[k], column) / on_template(template_vertices[k], column);
      if (std::isfinite(ratio) && ratio > 0) ratios.push_back(ratio);
    }
  }
  if (ratios.empty()) return 1;
  const auto middle = ratios.begin() + static_cast<std::ptrdiff_t>(ratios.size() / 2);
  std::nth_element(ratios.begin(), middle, ratios.end());
  return *middle;
}

// What the distances between markers along both surfaces say.
struct MeasuredMarkers {
  std::vector<CorrespondenceSummary::Doubt> doubtful;
  double size;  // of the target relative to the template
  MarkerDistances distances;
};

// `rest` and `goal`: template and target, each in its own frame.
MeasuredMarkers Measure(const std::vector<CorrespondenceMarker>& markers,
                        const Connectivity& template_connectivity, const Shape& rest,
                        const Connectivity& target_connectivity, const Shape& goal) {
  std::vector<int> on_template, on_target;
  for (const CorrespondenceMarker& marker : markers) {
    on_template.push_back(marker.template_vertex);
    on_target.push_back(marker.target_vertex);
  }
  Eigen::MatrixXf first = internal::DistancesFrom(template_connectivity, rest, on_template);
  Eigen::MatrixXf second = internal::DistancesFrom(target_connectivity, goal, on_target);
  const double size = RelativeSize(first, second, on_template, on_target);
  first *= static_cast<float>(size);
  return {internal::FindDoubtfulMarkers(first, second, on_template, on_target), size,
          MarkerDistances(std::move(first), std::move(second))};
}

// Fits the template level by level.
class Fit {
 public:
  Fit(const CorrespondenceOptions& options, const Target& target, std::vector<int> held,
      Shape places, Progress* progress, CorrespondenceSummary* summary)
      : options_(options),
        target_(target),
        held_(std::move(held)),
        places_(std::move(places)),
        progress_(progress),
        summary_(summary) {}

  // `rest`: the template at rest, in the target's frame. \return the fitted template.
  Shape operator()(const std::shared_ptr<const Connectivity>& connectivity, const Shape& rest) {
    const internal::Stopwatch stopwatch;
    HierarchyOptions hierarchy_options;
    hierarchy_options.coarsest = options_.coarsest;
    hierarchy_options.pinned = held_;
    const Hierarchy hierarchy(connectivity, {rest}, hierarchy_options);
    summary_->hierarchy_seconds = stopwatch.Seconds();
    num_levels_ = hierarchy.NumLevels();
    Shape shape = hierarchy.Restrict(rest, 0);
    for (level_ = 0; level_ < num_levels_; ++level_) {
      const Shape level_rest = hierarchy.Restrict(rest, level_);
      const Level level = {hierarchy.LevelConnectivity(level_), hierarchy.Vertices(level_),
                           internal::BorderOf(*hierarchy.LevelConnectivity(level_))};
      if (level_ == 0) FindPose(level, level_rest, &shape);
      if (level_ + 1 == num_levels_) {
        Finish(level, level_rest, &shape);
      } else {
        if (level_ > 0) {
          internal::ShellFit fit = MakeFit(level, level_rest, options_.bending);
          Rounds(level, &fit, kFineWeight, kFineRounds, &shape);
        }
        const Shape finer = hierarchy.Restrict(rest, level_ + 1);
        shape = hierarchy.Lift(shape, level_, finer, finer, 0);
      }
    }
    summary_->fit_seconds = stopwatch.Seconds() - summary_->hierarchy_seconds;
    return shape;
  }

 private:
  std::vector<int> HeldOn(const Level& level) const {
    std::vector<int> held;
    for (const int v : held_) {
      const auto found = std::lower_bound(level.vertices.begin(), level.vertices.end(), v);
      held.push_back(static_cast<int>(found - level.vertices.begin()));
    }
    return held;
  }

  // If asked to stop, the last level ends early; before that there is no result worth returning.
  bool Stops() {
    if (summary_->cancelled) return true;
    if (progress_ == nullptr || progress_->Report("fitting, level", level_ + 1, num_levels_)) {
      return false;
    }
    if (level_ + 1 < num_levels_ || !is_last_) throw Cancelled();
    summary_->cancelled = true;
    return true;
  }

  // Starts from the markers alone, approaches the pose with the gradient fit, then continues under
  // strain and bending.
  void FindPose(const Level& level, const Shape& rest, Shape* shape) {
    const internal::Stopwatch stopwatch;
    Stops();
    *shape = internal::GradientFit(*level.connectivity, rest, HeldOn(level),
                                   internal::kIdentity)(places_);
    level.connectivity->CopyToTwins(shape);
    CorrespondenceSummary::Stage stage;
    stage.vertices = static_cast<int>(shape->cols());
    stage.name = "gradients";
    stage.weight = 0;
    stage.rounds = 1;
    stage.seconds = stopwatch.Seconds();
    summary_->stages.push_back(stage);
    internal::ShellFit shell = MakeFit(level, rest, kCoarseBending * options_.bending);
    for (const double weight : kCoarseWeights) {
      Rounds(level, &shell, weight, kCoarseRounds, shape);
    }
  }

  void Finish(const Level& level, const Shape& rest, Shape* shape) {
    internal::ShellFit fit = MakeFit(level, rest, options_.bending);
    is_last_ = true;
    Rounds(level, &fit, kFineWeight, kFineRounds, shape);
    summary_->converged =
        Rounds(level, &fit, kLastWeight, options_.max_iterations, shape) && !summary_->cancelled;
    const internal::Stopwatch stopwatch;
    internal::Unfold(level, rest, target_, held_, shape);
    level.connectivity->CopyToTwins(shape);
    summary_->unfold_seconds = stopwatch.Seconds();
  }

  internal::ShellFit MakeFit(const Level& level, const Shape& rest, double bending) const {
    return {level.connectivity, rest, HeldOn(level), bending, options_.proportions};
  }

  // \return whether the vertices stopped moving.
  bool Rounds(const Level& level, internal::ShellFit* fit, double weight, int rounds,
              Shape* shape) {
    const internal::Stopwatch stopwatch;
    CorrespondenceSummary::Stage stage;
    stage.vertices = static_cast<int>(shape->cols());
    stage.name = "shell";
    stage.weight = weight;
    // It is enough to use about as many of the target's vertices as the level has.
    const int stride = std::max(1, target_.GetConnectivity().NumVertices() / (2 * stage.vertices));
    bool at_rest = false;
    while (!at_rest && stage.rounds < rounds && !Stops()) {
      const std::vector<internal::PointToPlaneTerm> terms = internal::FindTerms(
          level, *shape, fit->VertexAreas(), target_, stride, weight, &stage.distance);
      stage.motion = fit->Step(terms, shape);
      ++stage.rounds;
      at_rest = stage.motion < options_.tolerance;
    }
    stage.seconds = stopwatch.Seconds();
    summary_->stages.push_back(stage);
    return at_rest;
  }

  const CorrespondenceOptions& options_;
  const Target& target_;
  const std::vector<int> held_;  // ascending
  const Shape places_;
  Progress* const progress_;
  CorrespondenceSummary* const summary_;
  int level_ = 0, num_levels_ = 0;
  bool is_last_ = false;
};

SurfacePoints PointsOf(const std::vector<ClosestPoint>& closest) {
  SurfacePoints points;
  points.triangle.resize(static_cast<Eigen::Index>(closest.size()));
  points.barycentric.resize(3, static_cast<Eigen::Index>(closest.size()));
  for (Eigen::Index i = 0; i < points.triangle.size(); ++i) {
    points.triangle(i) = closest[i].triangle;
    points.barycentric.col(i) = closest[i].barycentric;
  }
  return points;
}

// The template's vertices on the target, and how near the fitted template is to them.
void MapToTarget(const Level& level, const Shape& fitted, const Target& target, SurfaceMap* map,
                 CorrespondenceSummary* summary) {
  const std::vector<ClosestPoint> closest = internal::MapVertices(level, fitted, target);
  map->to_target = PointsOf(closest);
  const Eigen::VectorXd areas = internal::VertexAreas(*level.connectivity, fitted);
  double squares = 0;
  for (int v = 0; v < fitted.cols(); ++v) {
    squares += areas(v) * closest[v].distance * closest[v].distance;
    summary->distance_max = std::fmax(summary->distance_max, closest[v].distance);
  }
  summary->distance_rms = std::sqrt(squares);
  const std::vector<bool> turned = internal::TurnedTriangles(level, fitted, target, closest);
  summary->turned = static_cast<double>(std::count(turned.begin(), turned.end(), true)) /
                    static_cast<double>(turned.size());
}

// The target's vertices on the template; those that it does not cover take the image of the nearest
// covered one along the surface.
void MapToTemplate(const Level& level, const Shape& fitted, const Target& target, SurfaceMap* map,
                   CorrespondenceSummary* summary) {
  const MeshSurface surface(level.connectivity, fitted);
  const int num_others = target.GetConnectivity().NumVertices();
  std::vector<ClosestPoint> others(num_others);
  map->gap.resize(num_others);
  ParallelFor(num_others, [&](int y) {
    others[y] = internal::NearestOnTemplate(surface, level, target, y);
    map->gap(y) = others[y].triangle >= 0 ? std::min(1.0, others[y].distance) : 1;
  });
  std::vector<int> covered;
  summary->uncovered = 0;
  for (int y = 0; y < num_others; ++y) {
    if (map->gap(y) < kCovered) {
      covered.push_back(y);
    } else {
      summary->uncovered += target.VertexAreas()(y);
    }
  }
  const std::vector<int> nearest =
      internal::NearestOf(target.GetConnectivity(), target.GetShape(), covered);
  for (int y = 0; y < num_others; ++y) {
    if (map->gap(y) < kCovered) continue;
    map->gap(y) = 1;
    others[y] = nearest[y] >= 0 ? others[nearest[y]] : surface.Nearest(target.GetShape().col(y));
  }
  map->to_template = PointsOf(others);
}

// Point `from` becomes the vertex `to`. A vertex lies in several triangles, so the nearest point
// may differ from it by rounding.
void Snap(const Eigen::Matrix3Xi& triangles, int from, int to, SurfacePoints* points) {
  for (int f = 0; f < triangles.cols(); ++f) {
    for (int k = 0; k < 3; ++k) {
      if (triangles(k, f) != to) continue;
      points->triangle(from) = f;
      points->barycentric.col(from) = Eigen::Vector3d::Unit(k);
      return;
    }
  }
}

void CopyToTwins(const Connectivity& connectivity, SurfacePoints* points) {
  connectivity.CopyToTwins(&points->triangle);
  connectivity.CopyToTwins(&points->barycentric);
}

// Computes both directions of the map, and their figures of quality.
SurfaceMap MakeMap(const Level& level, const Shape& fitted, const Shape& rest, const Target& target,
                   const std::vector<CorrespondenceMarker>& held, CorrespondenceSummary* summary) {
  SurfaceMap map;
  MapToTarget(level, fitted, target, &map, summary);
  MapToTemplate(level, fitted, target, &map, summary);
  for (const auto& [on_template, on_target] : held) {
    Snap(target.GetConnectivity().Triangles(), on_template, on_target, &map.to_target);
    Snap(level.connectivity->Triangles(), on_target, on_template, &map.to_template);
  }
  CopyToTwins(*level.connectivity, &map.to_target);
  CopyToTwins(target.GetConnectivity(), &map.to_template);
  const Shape back = PullBack(map.to_template, level.connectivity->Triangles(), rest);
  const Shape there_and_back = PullBack(map.to_target, target.GetConnectivity().Triangles(), back);
  map.round_trip = (there_and_back - rest).colwise().norm();
  Eigen::VectorXd sorted = map.round_trip;
  std::sort(sorted.begin(), sorted.end());
  summary->round_trip_mean = sorted.mean();
  summary->round_trip_p95 = sorted(static_cast<Eigen::Index>(0.95 * (sorted.size() - 1)));
  return map;
}

std::string Percent(double share) {
  char text[32];
  std::snprintf(text, sizeof text, share < 0.1 ? "%.2g %%" : "%.0f %%", 100 * share);
  return text;
}

void Warn(const CorrespondenceOptions& options, const std::vector<CorrespondenceMarker>& markers,
          CorrespondenceSummary* summary) {
  for (const auto& doubt : summary->doubtful) {
    const CorrespondenceMarker& marker = markers[doubt.marker];
    std::string text = "marker " + std::to_string(doubt.marker + 1) + " (vertices " +
                       std::to_string(marker.template_vertex + 1) + " and " +
                       std::to_string(marker.target_vertex + 1) + ") contradicts the others";
    if (doubt.swapped >= 0) {
      text += "; it seems to be exchanged with marker " + std::to_string(doubt.swapped + 1);
    } else {
      text += "; they predict it near the target's vertex " + std::to_string(doubt.expected + 1);
    }
    summary->warnings.push_back(text +
                                (options.drop_doubtful ? ", and was ignored" : ", but was used"));
  }
  if (summary->cancelled) summary->warnings.push_back("cancelled: the fit ended early");
  if (!summary->converged && !summary->cancelled) {
    summary->warnings.push_back("the final rounds did not converge: check the picture");
  }
  constexpr double kWorthATurn = 2e-3, kWorthAHole = 0.02;
  if (summary->turned > kWorthATurn) {
    summary->warnings.push_back(Percent(summary->turned) +
                                " of the triangles have normals opposite to the target's: check "
                                "there for detail that only one of the bodies has");
  }
  if (summary->uncovered > kWorthAHole) {
    summary->warnings.push_back(Percent(summary->uncovered) +
                                " of the target's area is not near any part of the template: a "
                                "marker may be missing there");
  }
}

}  // namespace

void CorrespondenceOptions::Validate() const {
  if (!(proportions > 0) || !(proportions <= 10)) {
    throw InvalidOptions("proportions", "must be above 0 and at most 10");
  }
  if (!(bending >= 0) || !(bending <= 1e6)) {
    throw InvalidOptions("bending", "must be from 0 to 1e6");
  }
  internal::CheckTolerance(tolerance);
  internal::CheckMaxIterations(max_iterations);
  if (coarsest < 1) throw InvalidOptions("coarsest", "must be 1 or more");
  internal::CheckMemoryLimit(memory_limit);
}

CorrespondenceResult Correspond(const std::shared_ptr<const Connectivity>& template_mesh,
                                const Shape& template_shape,
                                const std::shared_ptr<const Connectivity>& target_mesh,
                                const Shape& target_shape,
                                const std::vector<CorrespondenceMarker>& given_markers,
                                const CorrespondenceOptions& options, Progress* progress) {
  const internal::Stopwatch total;
  CorrespondenceResult result;
  CorrespondenceSummary& summary = result.summary;
  // Components that stiffeners connect are components all the same: each needs a marker.
  const auto template_connectivity = WithoutStiffeners(template_mesh);
  const auto target_connectivity = WithoutStiffeners(target_mesh);
  const std::vector<CorrespondenceMarker> all_markers =
      MarkersOnRepresentatives(given_markers, *template_connectivity, *target_connectivity);
  CheckInput(*template_connectivity, template_shape, *target_connectivity, target_shape,
             all_markers, options, &summary);
  ReportProgress(progress, "checking markers", 0, 0);

  const OwnFrame template_frame(*template_connectivity, template_shape);
  const OwnFrame target_frame(*target_connectivity, target_shape);
  Shape rest = template_frame.In(template_shape);
  const Shape goal = target_frame.In(target_shape);
  MeasuredMarkers measured =
      Measure(all_markers, *template_connectivity, rest, *target_connectivity, goal);
  summary.doubtful = measured.doubtful;
  std::vector<CorrespondenceMarker> markers = all_markers;
  if (options.drop_doubtful && !summary.doubtful.empty()) {
    markers = internal::Without(all_markers, summary.doubtful);
    internal::CheckMarkers(markers, *template_connectivity, *target_connectivity);
    measured = Measure(markers, *template_connectivity, rest, *target_connectivity, goal);
  }
  const double size = measured.size;
  summary.markers = static_cast<int>(markers.size());
  summary.scale = size * target_frame.unit / template_frame.unit;

  internal::CheckHandedness(*template_connectivity, rest, *target_connectivity, goal, markers,
                            measured.distances.OnTemplate());

  // In ascending order of the template's vertices, which is their order in the levels.
  std::sort(markers.begin(), markers.end(),
            [](const CorrespondenceMarker& a, const CorrespondenceMarker& b) {
              return a.template_vertex < b.template_vertex;
            });
  std::vector<int> held, images;
  for (const auto& [on_template, on_target] : markers) {
    held.push_back(on_template);
    images.push_back(on_target);
  }
  const Shape from = rest(Eigen::all, held), places = goal(Eigen::all, images);
  internal::CheckPlacement(from, places);
  rest = internal::MovedOnto(size * from, places, size * rest);
  const Target target(target_connectivity, goal, measured.distances);
  summary.marker_seconds = total.Seconds();

  Fit fit(options, target, held, places, progress, &summary);
  Shape fitted = fit(template_connectivity, rest);
  if (!internal::HasArea(*template_connectivity, fitted)) {
    throw MeshError(
        "the markers leave no area of the template: some that are apart on the template lie at one "
        "place of the target, or on one line");
  }

  const internal::Stopwatch map_stopwatch;
  Level all = {template_connectivity, {}, internal::BorderOf(*template_connectivity)};
  for (int v = 0; v < template_connectivity->NumVertices(); ++v) all.vertices.push_back(v);
  result.map = MakeMap(all, fitted, rest / size, target, markers, &summary);
  result.fitted = target_frame.Out(fitted);
  result.fitted(Eigen::all, held) = target_shape(Eigen::all, images);
  template_connectivity->CopyToTwins(&result.fitted);
  summary.map_seconds = map_stopwatch.Seconds();
  internal::WarnOfTopology(*template_connectivity, *target_connectivity, markers,
                           &summary.warnings);
  Warn(options, all_markers, &summary);
  summary.total_seconds = total.Seconds();
  return result;
}

Path CarryPath(const CorrespondenceResult& result, const Path& path,
               const std::shared_ptr<const Connectivity>& target_connectivity,
               const Shape& target_shape) {
  path.Validate();
  const int num_vertices = target_connectivity->NumVertices();
  if (target_shape.cols() != num_vertices || result.map.gap.size() != num_vertices) {
    throw MeshError("the target has " + std::to_string(num_vertices) + " vertices, its shape " +
                    std::to_string(target_shape.cols()) + ", and the map's target " +
                    std::to_string(result.map.gap.size()));
  }
  const OwnFrame frame(*target_connectivity, target_shape);
  std::vector<int> covered;
  for (int y = 0; y < result.map.gap.size(); ++y) {
    if (result.map.gap(y) < kCovered) covered.push_back(y);
  }
  // Where the template has no corresponding part, the target moves as its nearest covered part.
  std::optional<internal::GradientFit> fit;
  if (static_cast<int>(covered.size()) < num_vertices) {
    fit.emplace(*target_connectivity, frame.In(target_shape), covered, 0);
  }
  std::vector<Shape> carried;
  for (int i = 0; i < path.NumShapes(); ++i) {
    carried.push_back(CarryAlong(result.map.to_template, *path.metric->connectivity, result.fitted,
                                 path.Placed(i), target_shape));
    if (!fit) continue;
    const Shape places = frame.In(carried.back())(Eigen::all, covered);
    carried.back() = frame.Out((*fit)(places));
  }
  MetricOptions options = path.metric->options;
  if (!EnclosesVolume(target_connectivity->Triangles(), target_shape)) options.volume = 0;
  for (Eigen::VectorXd* field : {&options.stretching_stiffness, &options.bending_stiffness}) {
    if (field->size() == 0) continue;
    const Eigen::VectorXd of_vertices =
        VertexStiffness(*field, options.stiffness_on, *path.metric->connectivity);
    *field = PullBack(result.map.to_template, path.metric->connectivity->Triangles(),
                      of_vertices.transpose())
                 .transpose();
  }
  options.stiffness_on = StiffnessOn::kVertices;
  Path own =
      MakePath(FreezeMetric(options, target_connectivity, carried), carried, path.parameters);
  own.poses = path.poses;
  own.extrapolated = path.extrapolated;
  own.converged = path.converged && result.summary.Converged();
  own.provenance = path.provenance;
  return own;
}

}  // namespace shapespace
