#include <shapespace/geodesic/detail/contact_piece.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/base/parallel.h>
#include <shapespace/contact/internal/avoid_contact.h>
#include <shapespace/geodesic/internal/arc_length.h>
#include <shapespace/path/energy.h>
#include <shapespace/path/path.h>

namespace shapespace::internal {
namespace {

// Shapes of a path with contact that are followed.
constexpr int kGuides = 24;

// Of the levels on which the path only becomes the guide of the next one.
constexpr double kCoarseTolerance = 1e-3;

std::vector<Shape> WithSegments(const std::vector<Shape>& path, int segments) {
  const int now = static_cast<int>(path.size()) - 1;
  return now == segments ? path : Resample(path, UniformTimes(now - 1), UniformTimes(segments - 1));
}

}  // namespace

ContactPiece::ContactPiece(int index, const Hierarchy& hierarchy,
                           std::vector<Resolution>* resolutions, const GeodesicOptions& options,
                           const Obstacle* obstacle, Workload* workload, GeodesicSummary* summary)
    : index_(index),
      hierarchy_(hierarchy),
      resolutions_(*resolutions),
      options_(options),
      obstacle_(obstacle),
      workload_(*workload),
      summary_(*summary) {}

std::vector<Shape> ContactPiece::Run(const std::vector<Shape>& guide) {
  const Stopwatch stopwatch;
  const int segments = options_.shapes + 1, finest = hierarchy_.NumLevels() - 1;
  std::vector<Shape> result = WithSegments(guide, segments);
  using Intersections = ContactModel::Intersections;
  std::vector<int> touching =
      SegmentsWithContact(Model(finest, guide, Intersections::kNotExempt), result);
  // A guide that leads near other shapes is no geodesic, even if it is free.
  if (!touching.empty() || !options_.via.empty()) {
    const ContactModel model = Model(finest, guide, Intersections::kExempt);
    if (model.NumIntersections() > 0) {
      const std::string what = obstacle_ == nullptr ? "themselves" : "themselves or the obstacle";
      summary_.warnings.push_back(WarningOfIntersections(
          "piece " + std::to_string(index_) + ": its poses intersect " + what, model));
    }
    touching = AvoidOnAllLevels(model, guide, &result);
  }
  summary_.uncertified_segments =
      std::max(0, summary_.uncertified_segments) + static_cast<int>(touching.size());
  summary_.contact_seconds += stopwatch.Seconds();
  return result;
}

std::vector<int> ContactPiece::AvoidOnAllLevels(const ContactModel& model,
                                                const std::vector<Shape>& guide,
                                                std::vector<Shape>* result) {
  const int segments = options_.shapes + 1, finest = hierarchy_.NumLevels() - 1;
  std::vector<int> touching = SegmentsWithContact(model, *result);
  if ((!touching.empty() || !options_.via.empty()) && !workload_.Stopped()) {
    const double energy = ScaledEnergy(resolutions_[finest].Energy(*result, options_), segments);
    const std::vector<Shape> followed = WithSegments(guide, std::max(segments, kGuides));
    const std::vector<Shape> detail = *result;
    // A way that is not found on a coarse level is not found on finer ones either, in much more
    // time.
    int level = FirstLevelOfContact(finest, model.NumIntersections(), [&](int i) {
      return Model(i, guide, ContactModel::Intersections::kExempt);
    });
    std::vector<Shape> path = Avoid(level, energy, Restrict(followed, level));
    while (!path.empty() && level < finest && !workload_.Stopped()) {
      ++level;
      path = Avoid(level, energy, Lift(path, level - 1, detail));
    }
    if (!path.empty() && level == finest) {
      *result = std::move(path);
      touching = SegmentsWithContact(model, *result);
    } else if (!workload_.Stopped()) {
      summary_.warnings.push_back(
          "piece " + std::to_string(index_) +
          std::string(": no way was found on which the body does not pass through ") +
          (obstacle_ == nullptr ? "itself" : "itself or the obstacle") +
          "; it does in the path that is returned. " +
          (parts_ == 0
               ? std::string("Name a shape near which the way leads (via)")
               : "A way of " + std::to_string(parts_) + " straight parts was found: insert " +
                     std::to_string(parts_ - 1) + " shapes or more"));
    }
  }
  const double distance = LeastDistance(model, *result);
  if (std::isfinite(distance) && !(distance >= summary_.contact_distance)) {
    summary_.contact_distance = distance;
  }
  return touching;
}

std::vector<Shape> ContactPiece::Restrict(const std::vector<Shape>& shapes, int level) const {
  std::vector<Shape> restricted;
  for (const Shape& shape : shapes) restricted.push_back(hierarchy_.Restrict(shape, level));
  return restricted;
}

ContactModel ContactPiece::Model(int level, const std::vector<Shape>& guide,
                                 ContactModel::Intersections intersections) const {
  return {resolutions_[level].GetMetric(), Restrict({guide.front(), guide.back()}, level),
          intersections, obstacle_};
}

std::vector<Shape> ContactPiece::Avoid(int level, double energy, const std::vector<Shape>& guide) {
  const Stopwatch stopwatch;
  Resolution& resolution = resolutions_[level];
  const ContactModel model(resolution.GetMetric(), {guide.front(), guide.back()},
                           ContactModel::Intersections::kExempt, obstacle_);
  GeodesicSummary::Level row;
  row.piece = index_;
  row.vertices = static_cast<int>(guide.front().cols());
  row.shapes = options_.shapes;
  row.start = "contact";
  row.solver = "own L-BFGS";
  const bool last = level + 1 == hierarchy_.NumLevels();
  workload_.Plan(row.vertices, row.shapes, last);
  workload_.Begin(std::to_string(row.vertices) + " vertices, round contacts", row.vertices,
                  row.shapes, last);
  MinimiseOptions minimise;
  minimise.tolerance = last ? options_.tolerance : std::max(kCoarseTolerance, options_.tolerance);
  minimise.max_iterations = options_.max_iterations;
  minimise.keep_going = [&](int iteration, double energy) {
    return workload_.GoOn(iteration, energy);
  };
  const ContactFreePath path = AvoidContact(model, resolution.SingleFactor(0, row.shapes), energy,
                                            guide, options_.shapes + 1, minimise);
  workload_.End();
  parts_ = path.parts;
  if (path.shapes.empty()) return {};
  row.termination = path.result.termination;
  row.iterations = path.result.iterations;
  row.evaluations = path.result.evaluations;
  row.initial_energy = ScaledEnergy(path.result.initial_energy, row.shapes + 1);
  row.energy = ScaledEnergy(path.result.energy, row.shapes + 1);
  row.remaining = path.result.remaining;
  row.seconds = stopwatch.Seconds();
  summary_.levels.push_back(row);
  return path.shapes;
}

std::vector<Shape> ContactPiece::Lift(const std::vector<Shape>& path, int level,
                                      const std::vector<Shape>& guide) const {
  const std::vector<Shape> detail = Restrict(guide, level + 1);
  std::vector<Shape> lifted = detail;
  ParallelFor(options_.shapes, [&](int i) {
    lifted[i + 1] = hierarchy_.Lift(path[i + 1], level, detail[i + 1], detail[i + 1], 0);
  });
  return lifted;
}

}  // namespace shapespace::internal
