#include <shapespace/spline/spline.h>

#include <algorithm>
#include <cmath>
#include <sstream>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/base/parallel.h>
#include <shapespace/contact/internal/avoid_contact.h>
#include <shapespace/files/display_names.h>
#include <shapespace/path/energy.h>
#include <shapespace/path/internal/velocity.h>
#include <shapespace/spline/detail/memory.h>
#include <shapespace/spline/detail/smooth_chain.h>
#include <shapespace/summary/internal/memory.h>

namespace shapespace {
namespace {

// Of geodesics, as a share of the chain's length, up to which their ends are one pose; and in the
// metric's unit, for chains of rigid copies, whose lengths are rounding.
constexpr double kNoLength = 1e-6, kRounding = 1e-9;

// The shortest time from one shape to the next, as a share of the whole: velocities in shorter
// times are rounding.
constexpr double kShortest = 1e-12;

// A body that moves by less than this share of its size is still.
constexpr double kStill = 1e-9;

// Greater jumps of velocity are told of, as a share of the mean speed: with seven shapes in each
// interval those of healthy meshes are below 0.2.
constexpr double kJump = 0.5;

// A path between two neighbouring poses.
struct PieceMeasures {
  double length = 0, energy = 0;
};

std::vector<PieceMeasures> MeasurePieces(const Path& path) {
  const std::vector<double> squared = SquaredLengths(path.metric, path.shapes);
  std::vector<PieceMeasures> pieces;
  for (size_t i = 0; i + 1 < path.poses.size(); ++i) {
    PieceMeasures& piece = pieces.emplace_back();
    for (int k = path.poses[i]; k < path.poses[i + 1]; ++k) {
      piece.length += std::sqrt(squared[k]);
      piece.energy += squared[k] * (path.poses[i + 1] - path.poses[i]);
    }
  }
  return pieces;
}

// The times of the chain's poses, from 0 to 1.
std::vector<double> PoseTimes(const SplineOptions& options, const Path& chain) {
  std::vector<double> times = options.times;
  if (times.empty()) times.push_back(0);
  if (options.by_length) {
    const std::vector<PieceMeasures> pieces = MeasurePieces(chain);
    double length = 0;
    for (const PieceMeasures& piece : pieces) length += piece.length;
    for (size_t i = 0; i < pieces.size(); ++i) {
      if (!(pieces[i].length > std::max(kNoLength * length, kRounding))) {
        throw InvalidOptions("by_length", "poses " + std::to_string(i + 1) + " and " +
                                              std::to_string(i + 2) +
                                              " are the same up to a rigid motion, so that no time "
                                              "is between them; give times");
      }
      times.push_back(times.back() + pieces[i].length);
    }
  }
  while (times.size() < chain.poses.size()) times.push_back(times.back() + 1);
  const double first = times.front(), length = times.back() - first;
  for (double& t : times) t = (t - first) / length;
  return times;
}

// Refuses times of poses between which velocities would be rounding.
void CheckTimes(const std::vector<double>& times, int shapes) {
  if (times.empty()) return;
  const double whole = times.back() - times.front();
  if (!std::isfinite(whole)) throw InvalidOptions("times", "are farther apart than numbers can be");
  for (size_t i = 0; i + 1 < times.size(); ++i) {
    if ((times[i + 1] - times[i]) / whole > kShortest * (shapes + 1)) continue;
    throw InvalidOptions(
        "times", "between poses " + std::to_string(i + 1) + " and " + std::to_string(i + 2) +
                     " there is so small a part of the whole time that velocities are rounding; "
                     "give them more time, or leave one of them out");
  }
}

// The metric of a motion that returns to the first of `poses`. All of them count alike, and the way
// back counts as the others do, so that it is the same wherever the motion begins.
std::shared_ptr<const Metric> FreezeCycle(const MetricOptions& options,
                                          const std::shared_ptr<const Connectivity>& connectivity,
                                          const std::vector<Shape>& poses) {
  std::vector<Shape> twice = poses;
  twice.insert(twice.end(), poses.begin(), poses.end());
  return FreezeMetric(options, connectivity, twice);
}

// Gives the chain's shapes, which are evenly spaced between its poses, these times.
void SetTimes(const std::vector<double>& times, Path* chain) {
  for (size_t piece = 0; piece + 1 < chain->poses.size(); ++piece) {
    const int begin = chain->poses[piece], end = chain->poses[piece + 1];
    for (int k = begin; k <= end; ++k) {
      const double s = static_cast<double>(k - begin) / (end - begin);
      chain->parameters[k] = times[piece] + s * (times[piece + 1] - times[piece]);
    }
  }
}

// The greatest way that counts as none: a share of the size, and rounding far from the origin.
double LeastWay(const Shape& shape) {
  constexpr double kRoundingOfPlace = 1e-13;
  const double extent = (shape.rowwise().maxCoeff() - shape.rowwise().minCoeff()).norm();
  return kStill * extent + kRoundingOfPlace * shape.cwiseAbs().maxCoeff();
}

// The greatest jump of velocity at a pose, as a share of the mean speed; 0 if nothing moves.
double GreatestJump(const Path& path, bool periodic) {
  const Eigen::VectorXd& area = path.metric->vertex_area;
  const auto norm = [&](const Shape& x) {
    return std::sqrt(area.dot(x.colwise().squaredNorm().transpose()) / area.sum());
  };
  double way = 0;
  Shape before = path.Placed(0);
  for (int k = 1; k < path.NumShapes(); ++k) {
    Shape shape = path.Placed(k);
    way += norm(shape - before);
    before = std::move(shape);
  }
  if (!(way > LeastWay(before))) return 0;
  double greatest = 0;
  for (size_t i = 1; i + 1 < path.poses.size(); ++i) {
    const int at = path.poses[i];
    greatest = std::max(greatest, norm(internal::OneSidedVelocity(path, at, 1) -
                                       internal::OneSidedVelocity(path, at, -1)));
  }
  if (periodic) {
    greatest = std::max(greatest, norm(internal::OneSidedVelocity(path, 0, 1) -
                                       internal::OneSidedVelocity(path, path.NumShapes() - 1, -1)));
  }
  return greatest / way;
}

void WarnOfJumps(SplineSummary* summary) {
  if (!(summary->jump_after > kJump)) return;
  std::ostringstream jump;
  jump.precision(2);
  jump << summary->jump_after;
  summary->warnings.push_back("at a pose the velocity still jumps by " + jump.str() +
                              " times the mean speed, as far as it is seen in the shapes: insert "
                              "more of them, and check triangles that collapse in a pose");
}

void WarnOfContact(SplineSummary* summary) {
  if (!summary->smooth) {
    summary->uncertified_segments = summary->geodesic.uncertified_segments;
    summary->contact_distance = summary->geodesic.contact_distance;
    return;
  }
  if (summary->uncertified_segments > 0) {
    summary->warnings.push_back("of the smooth motion " +
                                internal::WarningOfUncertified(summary->uncertified_segments));
  }
}

}  // namespace

void SplineOptions::Validate() const {
  geodesic.Validate();
  for (size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i]) || (i > 0 && !(times[i] > times[i - 1]))) {
      throw InvalidOptions("times", "must be finite numbers in ascending order");
    }
  }
  if (by_length && !times.empty()) throw InvalidOptions("by_length", "goes without times");
  if (!(hold_limit >= 0) || !std::isfinite(hold_limit)) {
    throw InvalidOptions("hold_limit", "must be a number, zero or more");
  }
  const bool has_velocities = first_velocity.size() > 0 && last_velocity.size() > 0;
  if (ends == SplineEnds::kClamped && !has_velocities) {
    throw InvalidOptions("first_velocity, last_velocity", "are needed for clamped ends");
  }
  if (ends != SplineEnds::kClamped && (first_velocity.size() > 0 || last_velocity.size() > 0)) {
    throw InvalidOptions("first_velocity, last_velocity", "go with clamped ends only");
  }
}

SplineResult Spline(const std::shared_ptr<const Connectivity>& connectivity,
                    const std::vector<Shape>& given, const SplineOptions& options,
                    Progress* progress) {
  const internal::Stopwatch total;
  options.Validate();
  const bool periodic = options.ends == SplineEnds::kPeriodic;
  std::vector<Shape> poses = given;
  if (periodic && !given.empty()) {
    if (given.size() > 1 && given.front() == given.back()) {
      throw MeshError(
          "the last pose is the first: leave it out, since a periodic spline returns there");
    }
    poses.push_back(given.front());
  }
  if (!options.times.empty() && options.times.size() != poses.size()) {
    throw InvalidOptions("times", "must be " + std::to_string(poses.size()) +
                                      ", one for each pose, not " +
                                      std::to_string(options.times.size()));
  }
  CheckTimes(options.times, options.geodesic.shapes);
  for (const Tangent* velocity : {&options.first_velocity, &options.last_velocity}) {
    if (velocity->size() == 0) continue;
    if (velocity->cols() != connectivity->NumVertices() || !velocity->allFinite()) {
      throw InvalidOptions("first_velocity, last_velocity",
                           "must be finite, with a column for each vertex");
    }
  }
  const double bytes =
      internal::SplineBytes(*connectivity, static_cast<int>(poses.size()), options.geodesic.shapes);
  internal::CheckMemory("this spline", bytes, options.geodesic.memory_limit, "insert fewer shapes");
  GeodesicResult chain =
      periodic && given.size() > 1
          ? Interpolate(FreezeCycle(options.geodesic.metric, connectivity, given), poses,
                        options.geodesic, progress)
          : Interpolate(connectivity, poses, options.geodesic, progress);
  SplineResult result{std::move(chain.path), {}};
  SplineSummary& summary = result.summary;
  summary.geodesic = std::move(chain.summary);
  summary.ends = options.ends;
  summary.estimated_bytes = std::max(bytes, summary.geodesic.estimated_bytes);
  summary.warnings = summary.geodesic.warnings;
  const std::vector<double> times = PoseTimes(options, result.path);
  SetTimes(times, &result.path);
  summary.jump_before = summary.jump_after = GreatestJump(result.path, periodic);
  const bool straight = poses.size() == 2 && options.ends != SplineEnds::kClamped;
  if (straight) {
    summary.warnings.push_back("there are only two poses: the motion is the geodesic between them");
  } else if (summary.geodesic.termination != Termination::kCancelled) {
    const internal::Stopwatch stopwatch;
    try {
      const internal::SmoothContact contact =
          internal::SmoothChain(options, times, progress, &result.path);
      summary.uncertified_segments = contact.uncertified_segments;
      summary.contact_distance = contact.contact_distance;
      result.path.smooth = summary.smooth = true;
      summary.jump_after = GreatestJump(result.path, periodic);
      WarnOfJumps(&summary);
    } catch (const Cancelled&) {
      summary.geodesic.termination = Termination::kCancelled;
    }
    summary.spline_seconds = stopwatch.Seconds();
  }
  if (!summary.smooth && !straight) {
    summary.warnings.push_back("stopped: the motion is the chain of geodesics, with corners");
  }
  if (options.geodesic.avoid_contact) WarnOfContact(&summary);
  result.path.converged = result.path.converged && summary.Converged();
  summary.energy = 0;
  for (const PieceMeasures& piece : MeasurePieces(result.path)) summary.energy += piece.energy;
  if (options.geodesic.assess) summary.quality = MeasureQuality(result.path);
  summary.total_seconds = total.Seconds();
  return result;
}

SplineResult Spline(const Poses& poses, const SplineOptions& options, Progress* progress) {
  SplineResult result = Spline(poses.connectivity, poses.shapes, options, progress);
  result.path.appearance = poses.soup.appearance;
  std::vector<std::string>& names = result.path.pose_names;
  for (const std::string& name : poses.names) names.push_back(DisplayName(name));
  if (options.ends == SplineEnds::kPeriodic && !names.empty()) names.push_back(names.front());
  return result;
}

}  // namespace shapespace
