#include <shapespace/exploration/explore.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/random.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/base/parallel.h>
#include <shapespace/exploration/detail/pair_solver.h>
#include <shapespace/exploration/detail/refinement.h>
#include <shapespace/exploration/triangulation.h>
#include <shapespace/hierarchy/freeze_level.h>
#include <shapespace/mesh/different_meshes.h>
#include <shapespace/mesh/rigid_motion.h>

namespace shapespace {
namespace {

using internal::Pair;
using internal::PairResult;
using internal::PairSolver;

// Centres poses and aligns them with the first, in the metric's unit.
std::vector<Shape> TurnOntoFirst(const Metric& metric, const std::vector<Shape>& poses) {
  std::vector<Shape> turned;
  for (const Shape& pose : poses) {
    turned.emplace_back((pose.colwise() - Centroid(pose, metric.vertex_area)) / metric.unit);
    if (turned.size() == 1) continue;
    turned.back() =
        FitRigidMotion(turned.back(), turned.front(), metric.vertex_area).rotation * turned.back();
  }
  return turned;
}

GeodesicOptions WithoutAssessment(GeodesicOptions options) {
  options.assess = false;
  return options;
}

// The poses at the resolution on which distances are measured, and the solver there.
struct Measuring {
  Measuring(const std::shared_ptr<const Connectivity>& connectivity,
            const std::vector<Shape>& poses, const ExploreOptions& options, ProcessPool* crew);

  // Restricts a shape of the mesh itself to that resolution.
  Shape Restrict(const Shape& shape) const {
    return vertices.empty() ? shape : Shape(shape(Eigen::all, vertices));
  }

  std::vector<int> vertices;  // of the mesh; empty for the mesh itself
  std::unique_ptr<PairSolver> solver;
  std::vector<Shape> poses;  // turned onto the first
};

Measuring::Measuring(const std::shared_ptr<const Connectivity>& connectivity,
                     const std::vector<Shape>& all_poses, const ExploreOptions& options,
                     ProcessPool* crew) {
  std::shared_ptr<const Connectivity> coarse = connectivity;
  std::vector<Shape> restricted = all_poses;
  GeodesicOptions geodesic = WithoutAssessment(options.geodesic);
  if (options.resolution > 0 && connectivity->NumTriangles() > options.resolution) {
    HierarchyOptions hierarchy_options;
    hierarchy_options.coarsest = options.geodesic.coarsest;
    const Hierarchy hierarchy(connectivity, all_poses, hierarchy_options);
    int level = hierarchy.NumLevels() - 1;
    while (level > 0 && hierarchy.LevelConnectivity(level)->NumTriangles() > options.resolution) {
      --level;
    }
    coarse = hierarchy.LevelConnectivity(level);
    vertices = hierarchy.Vertices(level);
    for (Shape& pose : restricted) pose = Restrict(pose);
    geodesic.metric = RestrictOptions(geodesic.metric, *connectivity, hierarchy, level);
  }
  solver = std::make_unique<PairSolver>(coarse, restricted, geodesic, crew, options.records);
  poses = TurnOntoFirst(*solver->GetMetric(), restricted);
}

Eigen::MatrixXd MeasureDistances(Measuring* measuring, Progress* progress) {
  const int count = static_cast<int>(measuring->poses.size());
  std::vector<Pair> pairs;
  for (int j = 0; j < count; ++j) {
    for (int i = 0; i < j; ++i) pairs.push_back({&measuring->poses[i], &measuring->poses[j], -1});
  }
  const std::vector<PairResult> results = measuring->solver->Solve(pairs, "distances", progress);
  Eigen::MatrixXd distances = Eigen::MatrixXd::Zero(count, count);
  size_t k = 0;
  for (int j = 0; j < count; ++j) {
    for (int i = 0; i < j; ++i) distances(i, j) = distances(j, i) = results[k++].length;
  }
  return distances;
}

void CheckPoses(const Connectivity& connectivity, const std::vector<Shape>& poses) {
  if (poses.size() < 2) throw MeshError("a space needs at least two poses");
  for (size_t i = 0; i < poses.size(); ++i) {
    const std::string name = "pose " + std::to_string(i);
    if (poses[i].cols() != connectivity.NumVertices()) {
      throw MeshError(internal::OfOtherMesh(name, poses[i].cols(), connectivity.NumVertices()));
    }
    if (!poses[i].allFinite()) throw MeshError(name + " has a coordinate that is not finite");
  }
}

// Computes the positions of the poses on the plane.
void EmbedPoses(const ExploreOptions& options, PoseSpace* space, ExploreSummary* summary) {
  // Distances below this are due to rounding; the metric's distances are pure numbers.
  constexpr double kNoDistance = 1e-9;
  if (space->distances.maxCoeff() < kNoDistance) {
    throw SolverError("all poses are copies of one: there is nothing to explore");
  }
  const Embedding embedding = Embed(space->distances, options.embedding);
  space->points = embedding.points;
  space->stress = summary->stress = embedding.stress;
  summary->stress_iterations = static_cast<int>(embedding.stresses.size()) - 1;
  summary->embedded = embedding.converged;
  const Triangulation triangulation = DelaunayTriangulation(space->points);
  space->triangles = triangulation.triangles;
  space->segments = triangulation.segments;
  for (int i : triangulation.left_out) {
    summary->warnings.push_back(
        "pose " + std::to_string(i) + " (" + space->names[i] +
        ") is at the position of an earlier pose, and no triangle contains it");
  }
}

void Add(const PairSolver& solver, ExploreSummary* summary) {
  const internal::PairCounts& counts = solver.Counts();
  summary->solved += counts.solved;
  summary->found += counts.found;
  summary->damaged += counts.damaged;
  summary->not_converged += counts.not_converged;
}

void Warn(ExploreSummary* summary) {
  if (summary->not_converged > 0) {
    summary->warnings.push_back(std::to_string(summary->not_converged) +
                                " geodesics have not converged; raise max_iterations or the "
                                "tolerance");
  }
  if (!summary->embedded) {
    summary->warnings.push_back("the positions on the plane have not converged");
  }
  constexpr double kMuchStress = 0.2;  // "poor" in Kruskal 1964
  if (summary->stress > kMuchStress) {
    summary->warnings.push_back(
        "the plane does not reproduce the distances between these poses (stress " +
        std::to_string(summary->stress) + "): neighbours on it may differ much");
  }
}

std::vector<PlaneLocation> RandomLocations(const PoseSpace& space, int samples) {
  const bool is_line = space.triangles.cols() == 0;
  const Eigen::Index cells = is_line ? space.segments.cols() : space.triangles.cols();
  std::vector<double> up_to;  // cumulative lengths or areas
  for (Eigen::Index i = 0; i < cells; ++i) {
    const Eigen::Vector2d a =
        space.points.col(is_line ? space.segments(0, i) : space.triangles(0, i));
    const Eigen::Vector2d b =
        space.points.col(is_line ? space.segments(1, i) : space.triangles(1, i)) - a;
    double size = b.norm();
    if (!is_line) {
      const Eigen::Vector2d c = space.points.col(space.triangles(2, i)) - a;
      size = b.x() * c.y() - b.y() * c.x();
    }
    up_to.push_back((i > 0 ? up_to.back() : 0) + size);
  }
  std::mt19937_64 random(1);
  std::vector<PlaneLocation> locations;
  for (int k = 0; k < samples; ++k) {
    const double at = internal::Uniform(&random) * up_to.back();
    const auto i = std::upper_bound(up_to.begin(), up_to.end() - 1, at) - up_to.begin();
    double u = internal::Uniform(&random), v = internal::Uniform(&random);
    PlaneLocation location;
    if (is_line) {
      location.nodes = {space.segments(0, i), space.segments(1, i), space.segments(0, i)};
      location.weights = {1 - u, u, 0};
    } else {
      if (u + v > 1) {
        u = 1 - u;
        v = 1 - v;
      }
      location.nodes = {space.triangles(0, i), space.triangles(1, i), space.triangles(2, i)};
      location.weights = {1 - u - v, u, v};
    }
    // The two nodes of greatest weight first.
    for (int pass : {0, 1, 0}) {
      if (location.weights[pass] >= location.weights[pass + 1]) continue;
      std::swap(location.weights[pass], location.weights[pass + 1]);
      std::swap(location.nodes[pass], location.nodes[pass + 1]);
    }
    locations.push_back(location);
  }
  return locations;
}

}  // namespace

GeodesicOptions ExploreOptions::Defaults() {
  GeodesicOptions options;
  options.shapes = 7;
  return options;
}

void ExploreOptions::Validate() const {
  geodesic.Validate();
  embedding.Validate();
  if (geodesic.shapes % 2 == 0) throw InvalidOptions("shapes", "must be odd, to have one half way");
  if (geodesic.metric.rigid > 0) {
    throw InvalidOptions("rigid", "under the rigid metric paths have no length; use 0");
  }
  if (resolution < 0) throw InvalidOptions("resolution", "must be 0 or more triangles");
  if (!(threshold > 0) || !std::isfinite(threshold)) {
    throw InvalidOptions("threshold", "must be a positive share");
  }
  if (depth < 0 || depth > 10) throw InvalidOptions("depth", "must be from 0 to 10");
}

Eigen::MatrixXd DistanceMatrix(const std::shared_ptr<const Connectivity>& connectivity,
                               const std::vector<Shape>& poses, const ExploreOptions& options,
                               Progress* progress, ProcessPool* crew) {
  options.Validate();
  CheckPoses(*connectivity, poses);
  ProcessPool alone;
  Measuring measuring(connectivity, poses, options, crew != nullptr ? crew : &alone);
  return MeasureDistances(&measuring, progress);
}

ExploreResult Explore(const std::shared_ptr<const Connectivity>& connectivity,
                      const std::vector<Shape>& poses, std::vector<std::string> names,
                      const ExploreOptions& options, Progress* progress, ProcessPool* crew) {
  options.Validate();
  CheckPoses(*connectivity, poses);
  if (names.empty()) {
    for (size_t i = 0; i < poses.size(); ++i) names.push_back("pose " + std::to_string(i));
  }
  if (names.size() != poses.size()) throw InvalidOptions("names", "must be one for each pose");
  ProcessPool alone;
  if (crew == nullptr) crew = &alone;
  const internal::Stopwatch total;
  ExploreResult result;
  PoseSpace& space = result.space;
  ExploreSummary& summary = result.summary;
  space.names = std::move(names);

  ReportProgress(progress, "freezing the metric, decimating", 0, 0);
  Measuring measuring(connectivity, poses, options, crew);
  space.distances = MeasureDistances(&measuring, progress);
  summary.distance_vertices = static_cast<int>(measuring.poses.front().cols());
  summary.distance_seconds = total.Seconds();

  const internal::Stopwatch embedding;
  EmbedPoses(options, &space, &summary);
  summary.embedding_seconds = embedding.Seconds();

  // Midpoints are solved on the mesh itself.
  const internal::Stopwatch refining;
  if (!measuring.vertices.empty()) {
    Add(*measuring.solver, &summary);
    ExploreOptions fine = options;
    fine.resolution = 0;
    measuring = Measuring(connectivity, poses, fine, crew);
  }
  space.metric = measuring.solver->GetMetric();
  space.nodes = std::move(measuring.poses);
  space.translation = Centroid(poses.front(), space.metric->vertex_area);
  internal::Refine(options, measuring.solver.get(), progress, &space, &summary);
  Add(*measuring.solver, &summary);
  summary.refinement_seconds = refining.Seconds();

  summary.vertices = connectivity->NumVertices();
  summary.triangles = connectivity->NumTriangles();
  summary.poses = space.NumPoses();
  summary.nodes = space.NumNodes();
  summary.cells = static_cast<int>(space.triangles.cols() + space.segments.cols());
  summary.metric = DescribeMetric(space.metric->options);
  summary.unit = space.metric->unit;
  summary.threshold = options.threshold;
  summary.threads = NumThreads();
  summary.processes = crew->Size();
  Warn(&summary);
  summary.total_seconds = total.Seconds();
  return result;
}

void RemoveRecords(const std::string& folder) { internal::Records(folder).Remove(); }

BlendErrors MeasureBlends(const PoseSpace& space, int samples, const ExploreOptions& given,
                          Progress* progress, ProcessPool* crew) {
  ExploreOptions options = given;
  options.geodesic.metric = space.metric->options;
  options.Validate();
  if (samples < 1) throw InvalidOptions("samples", "must be 1 or more");
  ProcessPool alone;
  std::vector<Shape> poses;
  for (int i = 0; i < space.NumPoses(); ++i) poses.push_back(space.metric->unit * space.nodes[i]);
  Measuring measuring(space.metric->connectivity, poses, options, crew != nullptr ? crew : &alone);
  PairSolver& solver = *measuring.solver;
  // Nodes at that resolution, in the unit of its metric.
  std::vector<Shape> nodes;
  for (const Shape& node : space.nodes) {
    Shape shape = space.metric->unit / solver.GetMetric()->unit * measuring.Restrict(node);
    shape.colwise() -= Centroid(shape, solver.GetMetric()->vertex_area);
    nodes.push_back(std::move(shape));
  }

  const std::vector<PlaneLocation> locations = RandomLocations(space, samples);
  const auto solve = [&](const char* stage, const auto& pair) {
    std::vector<Pair> pairs;
    for (int k = 0; k < samples; ++k) pairs.push_back(pair(k));
    return solver.Solve(pairs, stage, progress);
  };
  const std::vector<PairResult> between = solve("blends of two", [&](int k) {
    const auto& [n, w, point, inside] = locations[k];
    return Pair{&nodes[n[0]], &nodes[n[1]], w[1] / (w[0] + w[1])};
  });
  const std::vector<PairResult> blended = solve("blends of three", [&](int k) {
    return Pair{&between[k].shape, &nodes[locations[k].nodes[2]], locations[k].weights[2]};
  });
  std::vector<Shape> linear;
  for (const PlaneLocation& location : locations) linear.push_back(BlendNodes(nodes, location));
  const std::vector<PairResult> off = solve("deviations of blends", [&](int k) {
    return Pair{&linear[k], &blended[k].shape, -1};
  });

  BlendErrors errors;
  errors.samples = samples;
  errors.vertices = static_cast<int>(nodes.front().cols());
  const double greatest = space.distances.maxCoeff();
  int within = 0;
  errors.mean = errors.max = 0;
  for (const PairResult& result : off) {
    const double share = result.length / greatest;
    errors.mean += share / samples;
    errors.max = std::max(errors.max, share);
    if (share <= options.threshold) ++within;
  }
  errors.within = static_cast<double>(within) / samples;
  return errors;
}

}  // namespace shapespace
