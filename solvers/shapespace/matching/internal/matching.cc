#include <shapespace/matching/internal/matching.h>

#include <algorithm>
#include <functional>
#include <set>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/check_range.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/base/internal/task_group.h>
#include <shapespace/base/parallel.h>
#include <shapespace/matching/detail/assignments.h>
#include <shapespace/matching/detail/candidate_figures.h>
#include <shapespace/matching/detail/candidate_maps.h>
#include <shapespace/matching/detail/compare_bodies.h>
#include <shapespace/matching/detail/extremities.h>
#include <shapespace/matching/detail/farthest_points.h>
#include <shapespace/matching/detail/known_ends.h>
#include <shapespace/matching/detail/landmarks.h>
#include <shapespace/matching/detail/laplacian.h>
#include <shapespace/matching/detail/markers.h>
#include <shapespace/matching/detail/matching_body.h>
#include <shapespace/matching/detail/nearest_columns.h>
#include <shapespace/matching/detail/part_maps.h>
#include <shapespace/matching/detail/surface_graph.h>
#include <shapespace/matching/detail/working_surface.h>

namespace shapespace::internal {
namespace {

// Weight of the curvature in a candidate's cost.
constexpr double kCurvatureWeight = 0.3;
// Candidates that cost less are kept, also if one of them costs nothing: of a body onto itself.
constexpr double kNothing = 0.03;
// Fewer vertices have too few eigenfunctions.
constexpr int kFewestVertices = 20;
// Three landmarks are the fewest that determine a map.
constexpr size_t kFewestLandmarks = 3;
// Given pairs that serve as landmarks; all of them are markers. Landmarks cost time with the square
// of their number, and more of them tell nothing that these do not.
constexpr size_t kMostKnown = 8;
// A map contradicts a given pair if it misses the given vertex of the target by more than this.
// Maps of bodies that differ much are 0.1 off, and those with a wrong limb more than 0.5.
constexpr float kContradicts = 0.25F;
// A refined marker farther than this from the place of its vertex in the fit is left out.
constexpr double kAgrees = 0.08;

void CheckPairs(const VertexPairs& pairs, const WorkingSurface& on_template,
                const WorkingSurface& on_target) {
  const auto check = [](const std::string& name, const WorkingSurface& surface, int v) {
    if (v >= 0 && v < static_cast<int>(surface.nearest.size())) return;
    throw MeshError("a marker is given at vertex " + std::to_string(v + 1) + " of the " + name +
                    ", which has " + std::to_string(surface.nearest.size()) + " vertices");
  };
  for (const auto& [from, to] : pairs) {
    check("template", on_template, from);
    check("target", on_target, to);
  }
}

// The given pairs on the working surfaces, but for those that are not on their components.
VertexPairs OnWorkingSurfaces(const VertexPairs& pairs, const WorkingSurface& on_template,
                              const WorkingSurface& on_target) {
  VertexPairs known;
  for (const auto& [from, to] : pairs) {
    const std::pair<int, int> pair(on_template.nearest[from], on_target.nearest[to]);
    if (pair.first >= 0 && pair.second >= 0) known.push_back(pair);
  }
  return known;
}

// A map of the target's vertices to the template as one of the target's working surface.
std::vector<int> OnSurfaces(const std::vector<int>& map, const WorkingSurface& on_target,
                            const WorkingSurface& on_template) {
  if (map.size() != on_target.nearest.size()) {
    throw MeshError("a map of the target has " + std::to_string(map.size()) + " entries for " +
                    std::to_string(on_target.nearest.size()) + " vertices");
  }
  std::vector<int> result;
  for (const int v : on_target.vertices) {
    const int image = map[v];
    if (image < 0 || image >= static_cast<int>(on_template.nearest.size())) {
      throw MeshError("vertex " + std::to_string(v + 1) + " of the target is mapped to vertex " +
                      std::to_string(image + 1) + ", which the template does not have");
    }
    // What a fit has placed on another component is as good as anywhere.
    result.push_back(std::max(0, on_template.nearest[image]));
  }
  return result;
}

std::string TooFewVertices(const std::string& name, const MatchingBody& body) {
  if (body.surface.num_own >= kFewestVertices) return {};
  return "the " + name + " has " + std::to_string(body.surface.num_own) +
         " vertices in its largest component; at least " + std::to_string(kFewestVertices) +
         " are needed";
}

// Extremities, and the points of known pairs on the same `side`.
Landmarks WithKnown(const MatchingBody& body, std::vector<int> extremities,
                    const VertexPairs& known, int std::pair<int, int>::*side) {
  for (size_t k = 0; k < std::min(known.size(), kMostKnown); ++k) {
    extremities.push_back(known[k].*side);
  }
  return {body, std::move(extremities)};
}

AlignedPoints AlignAll(const MatchingBody& on_template, const MatchingBody& on_target,
                       const SpectralMap& map) {
  const auto functions = [](const MatchingBody& body, Eigen::Index count) -> Eigen::MatrixXf {
    return body.spectrum.functions.leftCols(count).transpose().cast<float>();
  };
  return Align(functions(on_template, map.from_target.rows()),
               functions(on_target, map.from_target.cols()), map);
}

SpectralMap FunctionMap(const MapCandidate& candidate) {
  return {{}, {}, candidate.from_target, candidate.from_template};
}

// Whether the map of a body's points to another's misses one of the pairs.
bool Contradicts(const Eigen::MatrixXf& points, const MatchingBody& to_body,
                 const Eigen::MatrixXf& to_points, const VertexPairs& known) {
  for (const auto& [from, to] : known) {
    const int image = NearestColumns(points.col(from), to_points)[0];
    if (to_body.graph.From(to)(image) > kContradicts) return true;
  }
  return false;
}

// How far apart two vertices are, in a straight line.
double StraightDistance(const MatchingBody& body, int v, int w) {
  return (body.surface.shape.col(v) - body.surface.shape.col(w)).norm();
}

VertexPairs Swapped(VertexPairs pairs) {
  for (auto& pair : pairs) std::swap(pair.first, pair.second);
  return pairs;
}

VertexPairs InBodies(const VertexPairs& pairs, const WorkingSurface& on_template,
                     const WorkingSurface& on_target) {
  VertexPairs result;
  for (const auto& [from, to] : pairs) {
    result.emplace_back(on_template.vertices[from], on_target.vertices[to]);
  }
  return result;
}

// The given pairs, and markers of the map beside them.
VertexPairs AllMarkers(const MatchingBody& on_template, const MatchingBody& on_target,
                       const SpectralMap& map, const VertexPairs& extremities,
                       const VertexPairs& given, Directions directions,
                       const std::function<bool(int from, int to)>& admits) {
  const AlignedPoints points = AlignAll(on_template, on_target, map);
  const VertexPairs known = OnWorkingSurfaces(given, on_template.surface, on_target.surface);
  // Those of a part are spread over the part, away from its border.
  const VertexPairs found = InBodies(
      directions == Directions::kBoth
          ? ChooseMarkers(on_template, on_target, points, extremities, known, admits)
          : Swapped(ChooseMarkers(
                on_target, on_template, {points.on_target, points.on_template},
                Swapped(extremities), Swapped(known),
                [&](int from, int to) { return on_target.IsInner(from) && admits(to, from); })),
      on_template.surface, on_target.surface);
  VertexPairs all = given;
  all.insert(all.end(), found.begin(), found.end());
  return all;
}

bool HasLandmarks(const MatchingBody& body, size_t known) {
  return body.extremities.size() + known >= kFewestLandmarks;
}

// The best assignments of principal extremities, and those in which one is what sticks out less of
// the other body: a snout beside long ears.
std::vector<Assignment> AssignEnds(const MatchingBody& first, const Landmarks& on_template,
                                   const MatchingBody& second, const Landmarks& on_target,
                                   const Eigen::MatrixXd& difference, int count) {
  std::vector<Assignment> all;
  const size_t rows = first.extremities.size(), columns = second.extremities.size();
  const auto add = [&](size_t from, size_t to) {
    const bool with_minor = from > rows || to > columns;
    for (Assignment& assignment :
         AssignExtremities(
             {on_template.Between(static_cast<int>(from), first.all_extremities.size()),
              on_target.Between(static_cast<int>(to), second.all_extremities.size()),
              difference.topLeftCorner(from, to)},
             count, kFewestLandmarks)
             .best) {
      const bool has_minor =
          std::any_of(assignment.pairs.begin(), assignment.pairs.end(), [&](const auto& pair) {
            return pair.first >= static_cast<int>(rows) || pair.second >= static_cast<int>(columns);
          });
      if (has_minor == with_minor) all.push_back(std::move(assignment));
    }
  };
  add(rows, columns);
  if (second.all_extremities.size() > columns) add(rows, second.all_extremities.size());
  if (first.all_extremities.size() > rows) add(first.all_extremities.size(), columns);
  return all;
}

// Maps of the best assignments of extremities, beside pairs that are known. Where there are too
// few, the bodies are taken to be in similar poses.
std::vector<CandidateMap> FindMaps(const MatchingBody& first, const MatchingBody& second,
                                   const VertexPairs& known, int count, Progress* progress,
                                   Matching* matching) {
  const Stopwatch stopwatch;
  ReportProgress(progress, "extremities", 0, 0);
  const KnownEnds ends(first, first.all_extremities, second, second.all_extremities, known);
  const Eigen::MatrixXd difference =
      ends.difference + HeatDifference(first.spectrum, first.all_extremities, second.spectrum,
                                       second.all_extremities, kLimbTime, 1);
  std::vector<CandidateMap> starts;
  const auto start = [&](const VertexPairs& landmarks) {
    if (!HasLandmarks(first, landmarks.size()) || !HasLandmarks(second, landmarks.size())) return;
    const Stopwatch own;
    const Landmarks on_template =
        WithKnown(first, first.all_extremities, landmarks, &std::pair<int, int>::first);
    const Landmarks on_target =
        WithKnown(second, second.all_extremities, landmarks, &std::pair<int, int>::second);
    const std::vector<Assignment> assignments =
        AssignEnds(first, on_template, second, on_target, difference, count);
    matching->assignment_seconds += own.Seconds();
    for (CandidateMap& map : StartAtLandmarks(first, second, on_template, on_target, assignments)) {
      starts.push_back(std::move(map));
    }
  };
  // Of bodies of other proportions a pair on the trunk can make all maps worse.
  start({});
  if (!ends.landmarks.empty()) start(ends.landmarks);
  if (starts.empty()) starts = StartAtAxes(first, second);
  std::vector<CandidateMap> maps = MakeMaps(first, second, std::move(starts), progress);
  matching->map_seconds = stopwatch.Seconds() - matching->assignment_seconds;
  return maps;
}

std::vector<CandidateMap> FindPartMaps(const MatchingBody& first, const MatchingBody& second,
                                       const VertexPairs& known, int count, Progress* progress,
                                       Matching* matching) {
  Stopwatch stopwatch;
  ReportProgress(progress, "extremities", 0, 0);
  const KnownEnds ends(first, first.inner_extremities, second, second.part_extremities, known);
  const Landmarks on_template =
      WithKnown(first, first.inner_extremities, ends.landmarks, &std::pair<int, int>::first);
  const Landmarks on_target =
      WithKnown(second, second.part_extremities, ends.landmarks, &std::pair<int, int>::second);
  const std::vector<ScaledAssignment> assignments =
      AssignAtScales(first, on_template, second, on_target, ends.difference, count);
  matching->assignment_seconds = stopwatch.Seconds();
  stopwatch = Stopwatch();
  std::vector<CandidateMap> maps =
      MakePartMaps(first, on_template, second, on_target, assignments, progress);
  matching->map_seconds = stopwatch.Seconds();
  return maps;
}

// The maps that keep orientation and agree with the known pairs, with their figures. Extremities
// are vertices of the working surfaces.
std::vector<MapCandidate> Judge(const MatchingBody& first, const MatchingBody& second,
                                const std::vector<CandidateMap>& maps, const VertexPairs& known,
                                double least_orientation, Directions directions) {
  const bool is_part = directions == Directions::kToTemplate;
  const CandidateFigures figures(first, second, directions);
  std::vector<SpectralMap> whole(maps.size());
  std::vector<double> orientations(maps.size());
  ParallelFor(static_cast<int>(maps.size()), [&](int i) {
    whole[i] = figures.WithAllImages(maps[i].map);
    orientations[i] = figures.Orientation(whole[i]);
  });
  std::vector<MapCandidate> candidates;
  std::vector<SpectralMap> admitted;
  for (size_t i = 0; i < maps.size(); ++i) {
    SpectralMap& map = whole[i];
    if (orientations[i] < least_orientation) continue;
    if (!known.empty()) {
      const AlignedPoints points = AlignAll(first, second, map);
      if (is_part ? Contradicts(points.on_target, first, points.on_template, Swapped(known))
                  : Contradicts(points.on_template, second, points.on_target, known)) {
        continue;
      }
    }
    MapCandidate candidate;
    candidate.orientation = orientations[i];
    candidate.curvature = figures.Curvature(map);
    candidate.from_target = map.from_target;
    candidate.from_template = map.from_template;
    for (const auto& [a, b] : maps[i].assignment.pairs) {
      candidate.extremities.emplace_back(
          (is_part ? first.inner_extremities : first.all_extremities)[a],
          (is_part ? second.part_extremities : second.all_extremities)[b]);
    }
    candidates.push_back(std::move(candidate));
    admitted.push_back(std::move(map));
  }
  const std::vector<double> isometry = figures.Isometry(admitted);
  for (size_t i = 0; i < isometry.size(); ++i) candidates[i].isometry = isometry[i];
  return candidates;
}

void KeepCheapest(const MatchingOptions& options, std::vector<MapCandidate>* candidates) {
  std::stable_sort(candidates->begin(), candidates->end(),
                   [](const auto& a, const auto& b) { return a.Cost() < b.Cost(); });
  const double most = std::max(kNothing, options.cost_ratio * candidates->front().Cost());
  while (candidates->back().Cost() > most ||
         static_cast<int>(candidates->size()) > options.max_candidates) {
    candidates->pop_back();
  }
}

}  // namespace

void MatchingOptions::Validate() const {
  CheckRange("assignments", assignments, 1, 1000);
  CheckRange("max_candidates", max_candidates, 1, 1000);
  CheckRange("least_orientation", least_orientation, -1.0, 1.0);
  CheckRange("cost_ratio", cost_ratio, 1.0, 1e6);
}

double MapFigures::Cost() const {
  return (isometry + kAlike) * (curvature + kAlike) * (heat + kAlike);
}

double MapCandidate::Cost() const { return isometry + kCurvatureWeight * (1 - curvature); }

SurfaceMatcher::SurfaceMatcher(const Connectivity& template_connectivity,
                               const Shape& template_shape, const Connectivity& target_connectivity,
                               const Shape& target_shape, const MatchingOptions& options,
                               Progress* progress)
    : options_(options) {
  options_.Validate();
  const Stopwatch stopwatch;
  TaskGroup(progress, "eigenfunctions", 2).RunAll(2, [&](int i, Progress* own) {
    if (i == 0) {
      template_ =
          std::make_unique<MatchingBody>("template", template_connectivity, template_shape, own);
    } else {
      target_ = std::make_unique<MatchingBody>("target", target_connectivity, target_shape, own);
    }
  });
  seconds_ = stopwatch.Seconds();
}

SurfaceMatcher::~SurfaceMatcher() = default;

bool SurfaceMatcher::TargetIsPart() const {
  return target_->IsOpen() && !template_->IsOpen() &&
         target_->part_extremities.size() >= kFewestOfAPart &&
         template_->inner_extremities.size() >= kFewestOfAPart;
}

Matching SurfaceMatcher::FindCandidates(const std::vector<std::pair<int, int>>& given,
                                        Progress* progress) const {
  const MatchingBody &first = *template_, &second = *target_;
  CheckPairs(given, first.surface, second.surface);
  const VertexPairs known = OnWorkingSurfaces(given, first.surface, second.surface);
  Matching matching;
  const bool is_part = TargetIsPart();
  const Directions directions = is_part ? Directions::kToTemplate : Directions::kBoth;
  const auto extremities = [&](const MatchingBody& body) {
    return static_cast<int>((is_part ? body.part_extremities : body.extremities).size());
  };
  matching.template_extremities = extremities(first);
  matching.target_extremities = extremities(second);
  matching.problem = TooFewVertices("template", first);
  if (matching.problem.empty()) matching.problem = TooFewVertices("target", second);
  if (!matching.problem.empty()) return matching;
  const std::vector<CandidateMap> maps = (is_part ? FindPartMaps : FindMaps)(
      first, second, known, options_.assignments, progress, &matching);
  matching.maps = static_cast<int>(maps.size());

  Stopwatch stopwatch;
  ReportProgress(progress, "figures of maps", 0, matching.maps);
  matching.candidates = Judge(first, second, maps, known, options_.least_orientation, directions);
  matching.maps_refused = matching.maps - static_cast<int>(matching.candidates.size());
  matching.figure_seconds = stopwatch.Seconds();
  if (matching.candidates.empty()) {
    matching.problem = "none of the " + std::to_string(matching.maps) +
                       " maps of the bodies that were tried keeps their outsides outside" +
                       (known.empty() ? "" : " and agrees with the given markers");
    return matching;
  }
  KeepCheapest(options_, &matching.candidates);

  stopwatch = Stopwatch();
  ReportProgress(progress, "markers", 0, static_cast<int>(matching.candidates.size()));
  ParallelFor(static_cast<int>(matching.candidates.size()), [&](int i) {
    MapCandidate& candidate = matching.candidates[i];
    candidate.markers = AllMarkers(first, second, FunctionMap(candidate), candidate.extremities,
                                   given, directions, [](int, int) { return true; });
    candidate.extremities = InBodies(candidate.extremities, first.surface, second.surface);
  });
  matching.marker_seconds = stopwatch.Seconds();
  return matching;
}

MapFigures SurfaceMatcher::Compare(const std::vector<int>& vertices,
                                   const std::vector<int>& images) const {
  VertexPairs pairs;
  for (size_t i = 0; i < vertices.size(); ++i) pairs.emplace_back(vertices[i], images[i]);
  return (TargetIsPart() ? ComparePart : CompareBodies)(
      *template_, *target_, OnWorkingSurfaces(pairs, template_->surface, target_->surface));
}

std::vector<std::pair<int, int>> SurfaceMatcher::SpreadPairs(
    const std::vector<int>& to_template, size_t count,
    const std::vector<std::pair<int, int>>& given) const {
  VertexPairs pairs = given;
  std::set<int> from_taken, to_taken;
  for (const auto& [from, to] : given) {
    from_taken.insert(from);
    to_taken.insert(to);
  }
  for (const int v : target_->even.vertices) {
    const int to = target_->surface.vertices[v], from = to_template[to];
    if (pairs.size() >= count) break;
    if (from_taken.count(from) + to_taken.count(to) > 0) continue;
    from_taken.insert(from);
    to_taken.insert(to);
    pairs.emplace_back(from, to);
  }
  return pairs;
}

std::vector<int> SurfaceMatcher::NearestOf(const std::vector<int>& vertices) const {
  const WorkingSurface& surface = template_->surface;
  std::vector<int> sources, which;
  for (size_t i = 0; i < vertices.size(); ++i) {
    if (surface.nearest[vertices[i]] < 0) continue;
    sources.push_back(surface.nearest[vertices[i]]);
    which.push_back(static_cast<int>(i));
  }
  const std::vector<int> nearest = template_->graph.NearestOf(sources);
  std::vector<int> result;
  for (const int v : surface.nearest) result.push_back(v < 0 ? -1 : which[nearest[v]]);
  return result;
}

std::vector<int> SurfaceMatcher::MapVertices(const MapCandidate& candidate) const {
  const MatchingBody &first = *template_, &second = *target_;
  const AlignedPoints points = AlignAll(first, second, FunctionMap(candidate));
  const std::vector<int> images = NearestColumns(points.on_template, points.on_target);
  std::vector<int> map;
  for (const int v : first.surface.nearest) {
    map.push_back(v < 0 ? -1 : second.surface.vertices[images[v]]);
  }
  return map;
}

std::vector<std::pair<int, int>> SurfaceMatcher::RefinePartMarkers(
    const MapCandidate& candidate, const std::vector<int>& to_template,
    const std::vector<std::pair<int, int>>& given, Progress* progress) const {
  const MatchingBody &first = *template_, &second = *target_;
  CheckPairs(given, first.surface, second.surface);
  const std::vector<int> back = OnSurfaces(to_template, second.surface, first.surface);
  const SpectralMap map = RefinePartMap(first, second, back, progress);
  VertexPairs extremities;
  for (const auto& [from, to] : candidate.extremities) {
    extremities.emplace_back(first.surface.nearest[from], second.surface.nearest[to]);
  }
  return AllMarkers(
      first, second, map, extremities, given, Directions::kToTemplate,
      [&](int from, int to) { return StraightDistance(first, back[to], from) <= kAgrees; });
}

std::vector<LimbEnd> FindLimbEnds(const Connectivity& connectivity, const Shape& shape) {
  const WorkingSurface surface = MakeWorkingSurface("template", connectivity, shape, nullptr);
  const SurfaceGraph on_surface(*surface.connectivity, surface.shape);
  const Eigen::VectorXd areas = MakeLaplacian(*surface.connectivity, surface.shape).areas;
  const EvenSamples even =
      SampleEvenly(on_surface, surface.shape, areas, kEvenSamples, surface.num_own);
  const SurfaceGraph graph(connectivity, shape);
  std::vector<LimbEnd> ends;
  for (const int v :
       PrincipalExtremities(FindExtremities(on_surface, even, areas, kLeastPersistence))) {
    const int end = surface.vertices[v];
    ends.push_back({end, graph.From(end)});
  }
  return ends;
}

}  // namespace shapespace::internal
