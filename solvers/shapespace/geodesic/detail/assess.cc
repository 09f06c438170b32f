#include <shapespace/geodesic/detail/assess.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <shapespace/analysis/intersections.h>
#include <shapespace/analysis/path_intersections.h>
#include <shapespace/base/error.h>
#include <shapespace/contact/internal/avoid_contact.h>
#include <shapespace/path/energy.h>

namespace shapespace::internal {
namespace {

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

}  // namespace

Termination EndOf(const GeodesicSummary& summary) {
  Termination end = summary.termination;
  for (size_t i = 0; i < summary.levels.size(); ++i) {
    if (Counts(summary.levels, i)) end = std::max(end, summary.levels[i].termination);
  }
  return end;
}

void MeasureEnergy(const Path& path, const GeodesicOptions& options, Resolution* finest,
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

void Warn(const GeodesicOptions& options, GeodesicSummary* summary) {
  WarnOfSolver(options.solver, summary);
  // Past an obstacle neither the bound, which knows of none, nor an even speed is to be expected.
  const bool past_obstacle = options.obstacle.has_value();
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
    summary->warnings.push_back(WarningOfUncertified(summary->uncertified_segments));
  } else if (summary->intersections > kManyIntersections) {
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

}  // namespace shapespace::internal
