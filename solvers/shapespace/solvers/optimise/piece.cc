#include <shapespace/solvers/optimise/piece.h>

#include <algorithm>
#include <utility>

#include <shapespace/base/parallel.h>
#include <shapespace/path/energy.h>
#include <shapespace/path/quality.h>

namespace shapespace::internal {
namespace {

// Meshes up to this size are solved from every start: they take milliseconds, and hold enough of
// the shape to tell good valleys from bad ones.
constexpr int kTrialVertices = 1000;
// A path with one inner shape whose energy is this close to the lower bound needs no other start:
// poor valleys on real poses were found at 1.8 times the bound and more.
constexpr double kCertified = 1.05;

// Where another level follows, a solve may stop when a further step is expected to gain less than
// this share of what it has gained. Refinement in time by cubics has an error of fourth order; the
// energy in excess goes with its square, and so falls by 256 from one level to the next. What the
// next one will add is thus at least a 256th of what this one added; this is an eighth of that.
constexpr double kEnough = 1.0 / 2048;

const char* Name(Start start) {
  switch (start) {
    case Start::kBlend:
      return "blend";
    case Start::kFirst:
      return "first";
    case Start::kLast:
      return "last";
    case Start::kRigid:
      return "rigid";
    case Start::kBest:
      break;
  }
  return "best";
}

std::vector<double> UniformTimes(int inner) {
  std::vector<double> times(inner + 2);
  for (int i = 0; i < inner + 2; ++i) times[i] = static_cast<double>(i) / (inner + 1);
  return times;
}

}  // namespace

void Plan(const std::vector<ScheduleStep>& schedule, size_t count,
          const std::vector<Resolution>& resolutions, Workload* workload) {
  for (size_t i = 0; i < count; ++i) {
    workload->Plan(resolutions[schedule[i].level].GetMetric().connectivity->NumVertices(),
                   schedule[i].shapes, i + 1 == schedule.size());
  }
}

Piece::Piece(int index, const Hierarchy& hierarchy, std::vector<Resolution>* resolutions,
             const GeodesicOptions& options, Workload* workload, GeodesicSummary* summary)
    : index_(index),
      hierarchy_(hierarchy),
      resolutions_(*resolutions),
      options_(options),
      workload_(*workload),
      summary_(*summary) {}

void Piece::Run(const std::vector<ScheduleStep>& schedule) {
  std::vector<Known> ends(resolutions_.size());
  for (size_t level = 0; level < ends.size(); ++level) {
    ends[level].shapes = {resolutions_[level].Pose(index_), resolutions_[level].Pose(index_ + 1)};
    if (level > 0) ends[level].base = ends[level - 1].shapes;
  }
  // How far it takes milliseconds to tell starts apart.
  size_t trial = 1;
  while (trial < schedule.size() && schedule[trial].shapes == 1 &&
         resolutions_[schedule[trial].level].GetMetric().connectivity->NumVertices() <=
             kTrialVertices) {
    ++trial;
  }
  const Resolution& judge = resolutions_[schedule[trial - 1].level];
  const double bound = ScaledEnergy(
      EnergyLowerBound(judge.GetMetric(), judge.Pose(index_), judge.Pose(index_ + 1), 2), 2);

  std::vector<Start> starts = {options_.start};
  if (options_.start == Start::kBest) starts = {Start::kBlend, Start::kFirst, Start::kLast};
  Attempt best;
  for (Start start : starts) {
    if (start != starts.front()) Plan(schedule, trial, resolutions_, &workload_);
    Keep(Take(schedule, 0, trial, {start, ends}), &best);
    if (best.energy <= kCertified * bound || workload_.Stopped()) break;
  }
  best = Take(schedule, trial, schedule.size(), std::move(best));
  // Second chances: the other starts, then all of them without coarse levels.
  const Start first = best.start;
  for (Start start : starts) {
    if (start != first && Snaps(best)) {
      Plan(schedule, schedule.size(), resolutions_, &workload_);
      Keep(Take(schedule, 0, schedule.size(), {start, ends}), &best);
    }
  }
  const std::vector<ScheduleStep> flat =
      MakeSchedule(Schedule::kFlat, static_cast<int>(ends.size()), options_.shapes);
  for (Start start : starts) {
    if (flat.size() < schedule.size() && starts.size() > 1 && Snaps(best)) {
      Plan(flat, flat.size(), resolutions_, &workload_);
      Keep(Take(flat, 0, flat.size(), {start, ends}), &best);
    }
  }
  known_ = std::move(best.known);
}

// Whether another start shall have its chance.
bool Piece::Snaps(const Attempt& attempt) const {
  if (workload_.Stopped()) return false;
  const std::vector<Shape>& shapes = attempt.known.back().shapes;
  return GreatestSpeed(resolutions_.back().GetMetric(), shapes,
                       UniformTimes(static_cast<int>(shapes.size()) - 2)) > kSnaps;
}

void Piece::Keep(Attempt attempt, Attempt* best) {
  const bool better =
      best->known.empty() || (attempt.energy < best->energy && !workload_.Stopped());
  for (size_t row : (better ? *best : attempt).rows) summary_.levels[row].kept = false;
  if (better) *best = std::move(attempt);
}

Piece::Attempt Piece::Take(const std::vector<ScheduleStep>& schedule, size_t begin, size_t end,
                           Attempt attempt) {
  known_ = std::move(attempt.known);
  for (size_t i = begin; i < end; ++i) {
    const size_t row = summary_.levels.size();
    Take(schedule[i], attempt.start, i + 1 == schedule.size());
    for (size_t k = row; k < summary_.levels.size(); ++k) attempt.rows.push_back(k);
  }
  attempt.energy = summary_.levels.back().energy;
  attempt.known = std::move(known_);
  return attempt;
}

void Piece::Take(const ScheduleStep& step, Start start, bool last) {
  Known& known = known_[step.level];
  const Known* const coarser = step.level > 0 ? &known_[step.level - 1] : nullptr;
  const int before = static_cast<int>(known.shapes.size()) - 2;
  std::vector<Shape> refined;
  if (before > 0) {
    refined = Resample(known.shapes, UniformTimes(before), UniformTimes(step.shapes));
  }

  std::vector<Shape> shapes;
  const char* name = nullptr;
  Resolution& resolution = resolutions_[step.level];
  if (coarser != nullptr && static_cast<int>(coarser->shapes.size()) - 2 == step.shapes) {
    shapes = Lift(step);
    name = "lifted";
    if (before > 0 && !coarser->refined.empty()) {
      std::vector<Shape> corrected = Correct(step, refined);
      if (resolution.Energy(corrected, options_) < resolution.Energy(shapes, options_)) {
        shapes = std::move(corrected);
        name = "corrected";
      }
    }
    known.base = coarser->shapes;
  } else if (before > 0) {
    shapes = refined;
    name = "refined";
  } else {
    shapes = OneInnerShape(start, step.level);
    name = Name(start);
  }
  known.refined = std::move(refined);

  if (!workload_.Stopped()) {
    GeodesicSummary::Level row =
        resolution.Relax(index_, last ? 0 : kEnough, options_, &workload_, &shapes);
    row.start = name;
    summary_.levels.push_back(row);
  }
  known.shapes = std::move(shapes);
}

std::vector<Shape> Piece::OneInnerShape(Start start, int level) {
  const std::vector<Shape>& ends = known_[level].shapes;
  const Shape blend = 0.5 * (ends[0] + ends[1]);
  switch (start) {
    case Start::kFirst:
      return {ends[0], ends[0], ends[1]};
    case Start::kLast:
      return {ends[0], ends[1], ends[1]};
    case Start::kRigid: {
      // The paper's advice for blends that degenerate: a first round as rigid as possible.
      Resolution rigid(
          std::make_shared<const Metric>(FreezeMetric(
              MetricOptions::Rigid(), resolutions_[level].GetMetric().connectivity, ends, 1)),
          ends);
      std::vector<Shape> shapes = {ends[0], blend, ends[1]};
      workload_.Plan(static_cast<int>(blend.cols()), 1, true);
      GeodesicSummary::Level row = rigid.Relax(0, 0, options_, &workload_, &shapes);
      row.piece = index_;
      row.start = "blend";
      row.solver += ", rigid metric";
      summary_.levels.push_back(row);
      return shapes;
    }
    case Start::kBlend:
    case Start::kBest:
      break;
  }
  return {ends[0], blend, ends[1]};
}

std::vector<Shape> Piece::Lift(const ScheduleStep& step) const {
  const std::vector<Shape>& coarse = known_[step.level - 1].shapes;
  const Known& known = known_[step.level];
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
  return shapes;
}

std::vector<Shape> Piece::Correct(const ScheduleStep& step, std::vector<Shape> refined) const {
  const Known& coarser = known_[step.level - 1];
  ParallelFor(step.shapes, [&](int i) {
    Shape& shape = refined[i + 1];
    const Shape& base = coarser.refined[i + 1];
    shape = hierarchy_.Lift(coarser.shapes[i + 1], step.level - 1, base, shape, base, shape, 0);
  });
  return refined;
}

}  // namespace shapespace::internal
