#include <shapespace/solvers/geodesic.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <memory>
#include <optional>

#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>
#include <shapespace/path/align.h>
#include <shapespace/path/energy.h>
#include <shapespace/solvers/optimise/minimise.h>
#include <shapespace/solvers/optimise/preconditioner.h>

namespace shapespace {
namespace {

using internal::ChangeOfVariables;
using internal::Cholesky;
using internal::MinimiseOptions;
using internal::MinimiseResult;

// Unknowns up to which the residual-block trust region takes milliseconds, and a few iterations
// where L-BFGS needs tens; beyond, it loses by factors.
constexpr int kTrustRegionUnknowns = 1000;
// A level with one inner shape whose energy is this close to the lower bound needs no other start:
// poor valleys on real poses were found at 1.8 times the bound and more.
constexpr double kCertified = 1.05;
// Starts are told apart after a solve to this multiple of the tolerance.
constexpr double kDraft = 10;
// History of L-BFGS: long where a level is small, short where the history would be the memory.
constexpr int kLongRank = 20, kShortRank = 5;
constexpr double kLongRankUnknowns = 3e5;
// Segments of the rigid metric turning by more than this are not resolved by a Cayley map.
constexpr double kMaxRigidTurn = 2 * M_PI / 3;

class Stopwatch {
 public:
  double Seconds() const {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

int Rank(double unknowns) { return unknowns <= kLongRankUnknowns ? kLongRank : kShortRank; }

// Numbers of inner shapes from one to `shapes`: each level halves the segments of the next.
std::vector<int> TimeLevels(int shapes) {
  std::vector<int> levels = {shapes};
  while (levels.back() > 1) levels.push_back(std::max(1, (levels.back() - 1) / 2));
  std::reverse(levels.begin(), levels.end());
  return levels;
}

std::vector<double> UniformTimes(int inner) {
  std::vector<double> times(inner + 2);
  for (int i = 0; i < inner + 2; ++i) times[i] = static_cast<double>(i) / (inner + 1);
  return times;
}

Termination Translate(internal::Stop stop) {
  switch (stop) {
    case internal::Stop::kConverged:
      return Termination::kConverged;
    case internal::Stop::kMaxIterations:
      return Termination::kMaxIterations;
    case internal::Stop::kStalled:
      break;
  }
  return Termination::kStalled;
}

// The solve between two neighbouring poses.
class Piece {
 public:
  Piece(const Metric& metric, const Shape& first, const Shape& last, int index,
        const GeodesicOptions& options, Progress* progress, GeodesicSummary* summary)
      : metric_(metric),
        first_(first),
        last_(last),
        index_(index),
        options_(options),
        progress_(progress),
        summary_(*summary) {}

  // One inner shape: the problem that decides which valley the path lies in. Solved from the linear
  // blend and from either pose; a start that comes close to the lower bound ends the search.
  std::vector<Shape> Start() {
    struct Candidate {
      const char* name;
      Shape shape;
    };
    const Candidate candidates[] = {
        {"blend", 0.5 * (first_ + last_)}, {"first", first_}, {"last", last_}};
    const double bound = ScaledEnergy(EnergyLowerBound(metric_, first_, last_, 2), 2);
    std::vector<Shape> best;
    size_t best_level = 0;
    for (const Candidate& candidate : candidates) {
      std::vector<Shape> shapes = {first_, candidate.shape, last_};
      Solve(candidate.name, kDraft * options_.tolerance, &shapes);
      GeodesicSummary::Level& level = summary_.levels.back();
      if (best.empty() || level.energy < summary_.levels[best_level].energy) {
        if (!best.empty()) summary_.levels[best_level].kept = false;
        best = std::move(shapes);
        best_level = summary_.levels.size() - 1;
      } else {
        level.kept = false;
      }
      if (summary_.levels[best_level].energy <= kCertified * bound) break;
    }
    Solve("refined", options_.tolerance, &best);
    return best;
  }

  // From one inner shape to all: refine in time, relax, and so on.
  void Refine(std::vector<Shape>* shapes) {
    for (int inner : TimeLevels(options_.shapes)) {
      const int before = static_cast<int>(shapes->size()) - 2;
      if (inner == before) continue;
      *shapes = Resample(*shapes, UniformTimes(before), UniformTimes(inner));
      Solve("refined", options_.tolerance, shapes);
    }
  }

 private:
  // Relaxes the inner shapes and appends a row to the summary's table.
  void Solve(const char* start, double tolerance, std::vector<Shape>* shapes) {
    const Stopwatch stopwatch;
    const int inner = static_cast<int>(shapes->size()) - 2;
    GeodesicSummary::Level level;
    level.piece = index_;
    level.shapes = inner;
    level.start = start;
    if (metric_.RigidInvariantButForPosition()) RemoveRigidDrift(shapes, metric_.vertex_area);

    const std::string stage = "level of " + std::to_string(inner) + " inner shapes";
    MinimiseOptions minimise;
    minimise.tolerance = tolerance;
    minimise.max_iterations = options_.max_iterations;
    minimise.keep_going = [&](int iteration) {
      return progress_ == nullptr || progress_->Report(stage, iteration, 0);
    };
    // A coarse level of the trapezoid that prepares a fine one would be biased by its quartic part,
    // which falls with the square of the number of segments.
    const double quartic_weight = std::pow((inner + 1.0) / (options_.shapes + 1.0), 2);

    PathEnergy energy(metric_, inner);
    energy.SetQuarticWeight(quartic_weight);
    ChangeOfVariables variables(Factor(inner), energy);
    std::vector<double> unknowns(energy.Size());
    const bool small = variables.Size() <= kTrustRegionUnknowns;
    MinimiseResult result;
    if (options_.solver == Solver::kTrustRegion ||
        (options_.solver == Solver::kAutomatic && small)) {
      level.solver = "trust region";
      result = internal::MinimiseTrustRegion(metric_, quartic_weight, minimise, shapes);
      energy.Load(*shapes, unknowns.data());
      result.remaining = internal::RemainingDecrease(&energy, &variables, unknowns);
    } else {
      level.solver = "L-BFGS";
      minimise.rank = Rank(variables.Size());
      energy.Load(*shapes, unknowns.data());
      result = internal::MinimiseLbfgs(&energy, &variables, minimise, &unknowns);
      energy.Store(unknowns.data(), shapes);
    }
    if (metric_.RigidInvariantButForPosition()) {
      RemoveRigidDrift(shapes, metric_.vertex_area);
      energy.Load(*shapes, unknowns.data());
      result.energy = energy.Evaluate(unknowns.data(), nullptr);
    }
    level.termination = Translate(result.stop);
    level.iterations = result.iterations;
    level.evaluations = result.evaluations;
    level.initial_energy = ScaledEnergy(result.initial_energy, inner + 1);
    level.energy = ScaledEnergy(result.energy, inner + 1);
    level.remaining = result.remaining;
    level.seconds = stopwatch.Seconds();
    summary_.levels.push_back(level);
  }

  // The preconditioner's factor depends on the level only through the trapezoid's quartic part.
  const Cholesky& Factor(int inner) {
    const bool trapezoid = metric_.options.discretization == Discretization::kTrapezoid;
    const int segments = trapezoid ? inner + 1 : 0;
    if (!factor_ || segments != factor_segments_) {
      const Stopwatch stopwatch;
      factor_.emplace(internal::ScalarMetric(metric_, {first_, last_}, segments));
      factor_segments_ = segments;
      summary_.factor_nonzeros = factor_->NumNonzeros();
      summary_.factor_seconds += stopwatch.Seconds();
    }
    return *factor_;
  }

  const Metric& metric_;
  const Shape& first_;
  const Shape& last_;
  const int index_;
  const GeodesicOptions& options_;
  Progress* const progress_;
  GeodesicSummary& summary_;
  std::optional<Cholesky> factor_;
  int factor_segments_ = -1;
};

// What the solve holds at its largest level; the factor is estimated from meshes of 2 K to 40 K
// vertices (120 to 250 numbers a vertex with bending, a seventh of it without).
double EstimateBytes(const Metric& metric, int poses, int shapes) {
  const double vertices = metric.connectivity->NumVertices();
  const double unknowns = 3 * vertices * shapes;
  const double vectors = 2.0 * Rank(unknowns) + 16;
  const double factor = metric.options.bending > 0 ? 300 : 45;
  const double all_shapes = 3 * vertices * (poses + (poses - 1.0) * shapes);
  return 8 * (vectors * unknowns + factor * vertices + 2 * all_shapes) +
         PathEnergy::EstimateBytes(metric, shapes);
}

void CheckRigidTurns(const Path& path) {
  for (int i = 0; i + 1 < path.NumShapes(); ++i) {
    const RigidMotion turn =
        FitRigidMotion(path.shapes[i], path.shapes[i + 1], path.metric->vertex_area);
    if (Eigen::AngleAxisd(turn.rotation).angle() > kMaxRigidTurn) {
      throw SolverError("the rigid metric: between shapes " + std::to_string(i) + " and " +
                        std::to_string(i + 1) +
                        " the body turns by more than 120 degrees; insert more shapes");
    }
  }
}

// The energy of the finished path by feature, and the bound, over all pieces.
void Assess(const Path& path, GeodesicSummary* summary) {
  const Metric& metric = *path.metric;
  for (const AnyFeature& any : metric.features) {
    summary->parts.emplace_back(
        std::visit([](const auto& feature) { return std::string(feature.kName); }, any), 0.0);
  }
  if (metric.rigid.Active()) summary->parts.emplace_back("rigid", 0.0);
  for (size_t piece = 0; piece + 1 < path.poses.size(); ++piece) {
    const std::vector<Shape> shapes(path.shapes.begin() + path.poses[piece],
                                    path.shapes.begin() + path.poses[piece + 1] + 1);
    const int segments = static_cast<int>(shapes.size()) - 1;
    PathEnergy energy(metric, segments - 1);
    std::vector<double> unknowns(energy.Size());
    energy.Load(shapes, unknowns.data());
    const std::vector<double> parts = energy.Parts(unknowns.data());
    for (size_t i = 0; i < parts.size(); ++i) {
      summary->parts[i].second += ScaledEnergy(parts[i], segments);
    }
    summary->lower_bound +=
        ScaledEnergy(EnergyLowerBound(metric, shapes.front(), shapes.back(), segments), segments);
  }
  for (const auto& part : summary->parts) summary->energy += part.second;
  summary->quality = MeasureQuality(path);
}

// Figures that are possible but hardly what a person wants to see.
void Warn(GeodesicSummary* summary) {
  for (const GeodesicSummary::Level& level : summary->levels) {
    if (level.kept && level.termination != Termination::kConverged) {
      summary->warnings.push_back(
          "the level of " + std::to_string(level.shapes) + " shapes of piece " +
          std::to_string(level.piece) +
          (level.termination == Termination::kMaxIterations
               ? " ran out of iterations; raise max_iterations or the tolerance"
               : " stalled: its line search found no better point"));
    }
  }
  constexpr double kPoorRatio = 1.5, kManyFolds = 1e-3;
  if (summary->Ratio() > kPoorRatio) {
    summary->warnings.push_back("the energy is " + std::to_string(summary->Ratio()) +
                                " times its lower bound: the path may lie in a poor valley");
  }
  if (summary->quality.folds > kManyFolds * summary->hinges) {
    summary->warnings.push_back("inner shapes hold " +
                                std::to_string(std::lround(summary->quality.folds)) +
                                " folds that the poses do not have: look at the pictures");
  }
}

}  // namespace

void GeodesicOptions::Validate() const {
  metric.Validate();
  if (shapes < 1) throw InvalidOptions("shapes: must be 1 or more");
  if (!(tolerance > 0) || !(tolerance < 1))
    throw InvalidOptions("tolerance: must be between 0 and 1");
  if (max_iterations < 1) throw InvalidOptions("max_iterations: must be 1 or more");
  if (!(memory_limit > 0)) throw InvalidOptions("memory_limit: must be positive");
}

GeodesicResult Interpolate(const std::shared_ptr<const Connectivity>& connectivity,
                           const std::vector<Shape>& poses, const GeodesicOptions& options,
                           Progress* progress) {
  options.Validate();
  if (poses.size() < 2) throw MeshError("a geodesic needs at least two poses");
  const Stopwatch total;
  GeodesicResult result;
  Path& path = result.path;
  GeodesicSummary& summary = result.summary;

  ReportProgress(progress, "freezing the metric", 0, 0);
  const auto metric =
      std::make_shared<const Metric>(FreezeMetric(options.metric, connectivity, poses));
  summary.freeze_seconds = total.Seconds();
  summary.estimated_bytes = EstimateBytes(*metric, static_cast<int>(poses.size()), options.shapes);
  if (summary.estimated_bytes > options.memory_limit) {
    throw SolverError("this solve needs about " +
                      std::to_string(std::lround(summary.estimated_bytes / 1e6)) +
                      " MB, more than the memory limit; insert fewer shapes or raise memory_limit");
  }

  path.metric = metric;
  const auto [aligned, motions] = AlignPoses(*metric, poses);
  const int pieces = static_cast<int>(poses.size()) - 1;
  path.poses = {0};
  path.shapes = {aligned[0]};
  path.parameters = {0};
  path.motions = {motions[0]};
  for (int i = 0; i < pieces; ++i) {
    Piece piece(*metric, aligned[i], aligned[i + 1], i, options, progress, &summary);
    const Stopwatch start;
    std::vector<Shape> shapes = piece.Start();
    summary.start_seconds += start.Seconds();
    const Stopwatch refine;
    piece.Refine(&shapes);
    summary.refine_seconds += refine.Seconds();
    for (int k = 1; k <= options.shapes + 1; ++k) {
      const double t = static_cast<double>(k) / (options.shapes + 1);
      path.shapes.push_back(std::move(shapes[k]));
      path.parameters.push_back((i + t) / pieces);
      path.motions.push_back(InterpolateMotion(motions[i], motions[i + 1], t));
    }
    path.poses.push_back(path.NumShapes() - 1);
  }
  if (metric->rigid.Active()) CheckRigidTurns(path);

  summary.metric = Describe(options.metric);
  summary.vertices = connectivity->NumVertices();
  summary.triangles = connectivity->NumTriangles();
  summary.edges = connectivity->NumEdges();
  summary.hinges = connectivity->NumHinges();
  summary.poses = static_cast<int>(poses.size());
  summary.shapes = options.shapes;
  summary.unit = metric->unit;
  summary.threads = Threads();
  for (const GeodesicSummary::Level& level : summary.levels) {
    if (level.kept) summary.termination = std::max(summary.termination, level.termination);
  }
  Assess(path, &summary);
  Warn(&summary);
  summary.total_seconds = total.Seconds();
  return result;
}

GeodesicResult Interpolate(const Poses& poses, const GeodesicOptions& options, Progress* progress) {
  return Interpolate(poses.connectivity, poses.shapes, options, progress);
}

}  // namespace shapespace
