#include <shapespace/geodesic/detail/geodesic_piece.h>

#include <algorithm>
#include <limits>
#include <utility>

#include <shapespace/analysis/quality.h>
#include <shapespace/base/parallel.h>
#include <shapespace/geodesic/detail/turning_motion.h>
#include <shapespace/geodesic/detail/unwrap_hinges.h>
#include <shapespace/geodesic/internal/arc_length.h>
#include <shapespace/path/energy.h>

namespace shapespace::internal {
namespace {

// Meshes up to this size are solved from several starts: this takes milliseconds, and they have
// enough detail to distinguish good local minima from bad ones.
constexpr int kTrialVertices = 1000;

// A path whose energy is this multiple of its lower bound, or less, leaves other starts so little
// to gain that they are not tried.
constexpr double kGoodStart = 1.03;

// With so many inner shapes, a hinge that turns by 180 degrees in one jump costs more than three
// times as much as one that turns evenly.
constexpr int kShapesToTellJumps = 7;

// If another level follows, a solve may stop when a further step is expected to gain less than this
// share of the gain so far. Refinement in time by cubics has an error of fourth order, and the
// excess energy is of its square, so it decreases by a factor of 256 from one level to the next.
// The next level thus adds at least a 256th of the gain on this one; the limit is an eighth of
// that.
constexpr double kLeastGain = 1.0 / 2048;

// In a path with a segment that is faster than this, relative to the mean, a part rests and then
// turns over.
constexpr double kJump = 1.1;

// Where parts turn far between shapes, more shapes that are lifted, or on cubics in time, have much
// more energy than the path through the fewer shapes. From this multiple on another guess is tried.
constexpr double kPoorGuess = 1.5;

const char* Name(PieceStart start) {
  if (!start) return "turn";
  switch (*start) {
    case GeodesicStart::kBlend:
      return "blend";
    case GeodesicStart::kFirst:
      return "first";
    case GeodesicStart::kLast:
      return "last";
    case GeodesicStart::kRigid:
      return "rigid";
    case GeodesicStart::kBest:
      break;
  }
  return "best";
}

std::vector<PieceStart> Starts(GeodesicStart start) {
  if (start != GeodesicStart::kBest) return {start};
  return {GeodesicStart::kBlend, GeodesicStart::kFirst, GeodesicStart::kLast};
}

int NumVertices(const Resolution& resolution) {
  return resolution.GetMetric()->connectivity->NumVertices();
}

// The steps of a piece, the first of which select the valley from one start after the other.
struct PieceSteps {
  std::vector<ScheduleStep> steps;
  size_t trial = 1;
  std::vector<PieceStart> starts;
  double least_gain = 1;  // the ratio of energies from which on a later start is preferred

  PieceSteps(int index, const std::vector<ScheduleStep>& schedule,
             const std::vector<Resolution>& resolutions, GeodesicStart start);
};

PieceSteps::PieceSteps(int index, const std::vector<ScheduleStep>& schedule,
                       const std::vector<Resolution>& resolutions, GeodesicStart start)
    : starts(Starts(start)) {
  const int coarsest = schedule.front().level;
  const Resolution& resolution = resolutions[coarsest];
  const bool small = NumVertices(resolution) <= kTrialVertices;
  if (start != GeodesicStart::kBest ||
      !HasFolds(*resolution.GetMetric()->connectivity, resolution.Pose(index),
                resolution.Pose(index + 1))) {
    steps = schedule;
    while (trial < steps.size() && steps[trial].shapes == 1 &&
           NumVertices(resolutions[steps[trial].level]) <= kTrialVertices) {
      ++trial;
    }
    return;
  }
  // With one inner shape all angles of a hinge that turns by 180 degrees cost the same, and with
  // three a jump costs little more than even motion. So the coarsest level is solved first, with as
  // many shapes as tell one from the other, and finer levels with no fewer.
  int enough = 1;
  for (const ScheduleStep& step : schedule) {
    if (step.level == coarsest && step.shapes <= kShapesToTellJumps) enough = step.shapes;
  }
  for (const ScheduleStep& step : schedule) {
    if (step.level == coarsest || step.shapes >= enough) steps.push_back(step);
  }
  std::stable_sort(steps.begin(), steps.end(), [&](const ScheduleStep& a, const ScheduleStep& b) {
    return a.shapes <= enough && a.level == coarsest && b.level != coarsest;
  });
  while (trial < steps.size() && steps[trial].level == coarsest && steps[trial].shapes <= enough) {
    ++trial;
  }
  // Of paths that fold to one side or the other and cost nearly the same, that start's is taken:
  // its side does not depend on rounding, and it has no crumpled parts that finer levels would
  // keep.
  starts.insert(starts.begin(), std::nullopt);
  least_gain = kPoorGuess;
  if (!small) starts.resize(1);
}

}  // namespace

void Plan(int index, const std::vector<ScheduleStep>& schedule,
          const std::vector<Resolution>& resolutions, GeodesicStart start, Workload* workload) {
  const PieceSteps piece(index, schedule, resolutions, start);
  for (size_t i = 0; i < piece.steps.size(); ++i) {
    for (size_t k = 0; k < (i < piece.trial ? piece.starts.size() : 1); ++k) {
      workload->Plan(NumVertices(resolutions[piece.steps[i].level]), piece.steps[i].shapes,
                     i + 1 == piece.steps.size());
    }
  }
}

GeodesicPiece::GeodesicPiece(int index, const Hierarchy& hierarchy,
                             std::vector<Resolution>* resolutions, const GeodesicOptions& options,
                             Workload* workload, GeodesicSummary* summary,
                             std::function<void(std::vector<Shape>)> show)
    : index_(index),
      hierarchy_(hierarchy),
      resolutions_(*resolutions),
      options_(options),
      workload_(*workload),
      summary_(*summary),
      show_(std::move(show)) {}

void GeodesicPiece::Run(const std::vector<ScheduleStep>& schedule, bool more_shapes_allowed) {
  std::vector<Known> ends(resolutions_.size());
  for (size_t level = 0; level < ends.size(); ++level) {
    ends[level].shapes = {resolutions_[level].Pose(index_), resolutions_[level].Pose(index_ + 1)};
    if (level > 0) ends[level].base = ends[level - 1].shapes;
  }
  const PieceSteps piece(index_, schedule, resolutions_, options_.start);
  Attempt best;
  for (const PieceStart start : piece.starts) {
    Attempt attempt = TakeSteps(piece.steps, 0, piece.trial, {start, ends});
    const bool better = best.known.empty() ||
                        (piece.least_gain * attempt.energy < best.energy && !workload_.Stopped());
    for (size_t row : (better ? best : attempt).rows) summary_.levels[row].kept = false;
    if (better) best = std::move(attempt);
    const ScheduleStep& last = piece.steps[piece.trial - 1];
    const Resolution& resolution = resolutions_[last.level];
    const double bound =
        ScaledEnergy(EnergyLowerBound(*resolution.GetMetric(), resolution.Pose(index_),
                                      resolution.Pose(index_ + 1), last.shapes + 1),
                     last.shapes + 1);
    if (workload_.Stopped() || best.energy <= kGoodStart * bound) break;
  }
  known_ = TakeSteps(piece.steps, piece.trial, piece.steps.size(), std::move(best)).known;
  if (more_shapes_allowed && !workload_.Stopped()) RemoveJump(schedule.back());
}

void GeodesicPiece::RemoveJump(const ScheduleStep& last) {
  Known& known = known_[last.level];
  const Metric& metric = *resolutions_[last.level].GetMetric();
  if (!(GreatestSpeed(metric, known.shapes, UniformTimes(last.shapes)) > kJump)) return;
  const std::vector<Shape> before = known.shapes;
  const size_t row = summary_.levels.size();
  const int more = 2 * last.shapes + 1;
  workload_.Plan(before.front().cols(), more, false);
  workload_.Plan(before.front().cols(), last.shapes, true);
  TakeStep({last.level, more}, GeodesicStart::kBlend, false);
  TakeStep(last, GeodesicStart::kBlend, true);
  if (!workload_.Stopped() && summary_.levels.back().energy < summary_.levels[row - 1].energy) {
    return;
  }
  known.shapes = before;
  for (size_t k = row; k < summary_.levels.size(); ++k) summary_.levels[k].kept = false;
}

GeodesicPiece::Attempt GeodesicPiece::TakeSteps(const std::vector<ScheduleStep>& schedule,
                                                size_t begin, size_t end, Attempt attempt) {
  known_ = std::move(attempt.known);
  for (size_t i = begin; i < end; ++i) {
    const bool mesh_itself = i > 0 && schedule[i - 1].level + 1 == hierarchy_.NumLevels();
    if (begin > 0 && (i == begin || mesh_itself)) Show(schedule, i);
    const size_t row = summary_.levels.size();
    TakeStep(schedule[i], attempt.start, i + 1 == schedule.size());
    for (size_t k = row; k < summary_.levels.size(); ++k) attempt.rows.push_back(k);
  }
  if (!attempt.rows.empty()) attempt.energy = summary_.levels.back().energy;
  attempt.known = std::move(known_);
  return attempt;
}

void GeodesicPiece::Show(const std::vector<ScheduleStep>& schedule, size_t begin) {
  if (!show_ || workload_.Stopped()) return;
  const std::vector<Known> known = known_;
  for (size_t i = begin; i < schedule.size(); ++i) {
    Guess guess = CanLift(schedule[i]) ? Lift(schedule[i]) : Refine(schedule[i]);
    known_[schedule[i].level].shapes = std::move(guess.shapes);
  }
  show_(std::move(known_.back().shapes));
  known_ = known;
}

void GeodesicPiece::TakeStep(const ScheduleStep& step, PieceStart start, bool last) {
  Guess guess = GuessFor(step, start);
  if (!workload_.Stopped()) {
    Resolution& resolution = resolutions_[step.level];
    resolution.PlaceThinVertices(index_, options_, &guess.shapes);
    UnwrapHinges(*resolution.GetMetric(), &guess.shapes);
    GeodesicSummary::Level row =
        resolution.Relax(index_, last ? 0 : kLeastGain, options_, &workload_, &guess.shapes);
    row.start = guess.name;
    summary_.levels.push_back(row);
  }
  known_[step.level].shapes = std::move(guess.shapes);
}

GeodesicPiece::Guess GeodesicPiece::GuessFor(const ScheduleStep& step, PieceStart start) {
  const std::vector<Shape>& known = known_[step.level].shapes;
  const bool lift = CanLift(step);
  if (known.size() == 2) return lift ? Lift(step) : OneInnerShape(start, step.level);

  const double good = kPoorGuess * Energy(step.level, known);
  Guess best;
  double least = std::numeric_limits<double>::infinity();
  if (lift) {
    best = Lift(step);
    least = Energy(step.level, best.shapes);
  }
  if (least > good) {
    Guess refined = Refine(step);
    const double energy = Energy(step.level, refined.shapes);
    if (energy < least) {
      least = energy;
      best = std::move(refined);
    }
  }
  const bool one_between_each_two = step.shapes + 1 == 2 * (static_cast<int>(known.size()) - 1);
  if (least > good && one_between_each_two &&
      NumVertices(resolutions_[step.level]) <= kTrialVertices) {
    return InsertShapes(step.level, best.shapes);
  }
  return best;
}

double GeodesicPiece::Energy(int level, const std::vector<Shape>& path) {
  return ScaledEnergy(resolutions_[level].Energy(path, options_),
                      static_cast<int>(path.size()) - 1);
}

bool GeodesicPiece::CanLift(const ScheduleStep& step) const {
  if (step.level == 0) return false;
  const Known& known = known_[step.level];
  return static_cast<int>(known_[step.level - 1].shapes.size()) - 2 == step.shapes &&
         known.base.size() == known.shapes.size();
}

GeodesicPiece::Guess GeodesicPiece::Lift(const ScheduleStep& step) {
  const std::vector<Shape>& coarse = known_[step.level - 1].shapes;
  Known& known = known_[step.level];
  const int segments = static_cast<int>(known.shapes.size()) - 1;
  std::vector<Shape> shapes(coarse.size());
  shapes.front() = known.shapes.front();
  shapes.back() = known.shapes.back();
  ParallelFor(step.shapes, [&](int i) {
    const double at = (i + 1.0) / (step.shapes + 1) * segments;
    const int from = std::min(static_cast<int>(at), segments - 1);
    shapes[i + 1] =
        hierarchy_.Lift(coarse[i + 1], step.level - 1, known.base[from], known.shapes[from],
                        known.base[from + 1], known.shapes[from + 1], at - from);
  });
  known.base = coarse;
  return {std::move(shapes), "lifted"};
}

GeodesicPiece::Guess GeodesicPiece::Refine(const ScheduleStep& step) const {
  const std::vector<Shape>& known = known_[step.level].shapes;
  const Metric& metric = *resolutions_[step.level].GetMetric();
  return {Resample(known, ArcLengthTimes(metric, known), UniformTimes(step.shapes)), "refined"};
}

GeodesicPiece::Guess GeodesicPiece::InsertShapes(int level, const std::vector<Shape>& guess) {
  const std::vector<Shape>& known = known_[level].shapes;
  Resolution& resolution = resolutions_[level];
  std::vector<Shape> shapes = guess;
  for (size_t i = 0; i + 1 < known.size() && !workload_.Stopped(); ++i) {
    double least = std::numeric_limits<double>::infinity();
    for (const Shape& start : {guess[2 * i + 1], known[i], known[i + 1]}) {
      std::vector<Shape> three = {known[i], start, known[i + 1]};
      workload_.Plan(NumVertices(resolution), 1, false);
      const double energy =
          resolution.Relax(index_, kLeastGain, options_, &workload_, &three).energy;
      if (energy >= least) continue;
      least = energy;
      shapes[2 * i + 1] = three[1];
    }
    shapes[2 * i] = known[i];
  }
  return {std::move(shapes), "inserted"};
}

GeodesicPiece::Guess GeodesicPiece::OneInnerShape(PieceStart start, int level) {
  const char* const name = Name(start);
  const std::vector<Shape>& ends = known_[level].shapes;
  if (!start) {
    const TurningMotion motion(*resolutions_[level].GetMetric()->connectivity, ends[0], ends[1]);
    return {{ends[0], motion.At(0.5), ends[1]}, name};
  }
  const Shape blend = 0.5 * (ends[0] + ends[1]);
  switch (*start) {
    case GeodesicStart::kFirst:
      return {{ends[0], ends[0], ends[1]}, name};
    case GeodesicStart::kLast:
      return {{ends[0], ends[1], ends[1]}, name};
    case GeodesicStart::kRigid: {
      // The paper's advice for degenerate blends: a first solve that is as rigid as possible.
      Resolution rigid({FreezeMetric(MetricOptions::Rigid(),
                                     resolutions_[level].GetMetric()->connectivity, ends, 1),
                        ends});
      rigid.SetPoses(ends);
      std::vector<Shape> shapes = {ends[0], blend, ends[1]};
      workload_.Plan(static_cast<int>(blend.cols()), 1, true);
      GeodesicSummary::Level row = rigid.Relax(0, 0, options_, &workload_, &shapes);
      row.piece = index_;
      row.start = "blend";
      row.solver += ", rigid metric";
      summary_.levels.push_back(row);
      return {std::move(shapes), name};
    }
    case GeodesicStart::kBlend:
    case GeodesicStart::kBest:
      break;
  }
  return {{ends[0], blend, ends[1]}, name};
}

}  // namespace shapespace::internal
