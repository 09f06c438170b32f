#include <shapespace/solvers/optimise/piece.h>

#include <algorithm>
#include <utility>

#include <shapespace/base/parallel.h>
#include <shapespace/path/energy.h>

namespace shapespace::internal {
namespace {

// Meshes up to this size are solved from every start: they take milliseconds, and hold enough of
// the shape to tell good valleys from bad ones.
constexpr int kTrialVertices = 1000;
// A path with one inner shape whose energy is this close to the lower bound needs no other start:
// poor valleys on real poses were found at 1.8 times the bound and more.
constexpr double kCertified = 1.05;

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

Piece::Piece(int index, const Hierarchy& hierarchy, std::vector<Resolution>* resolutions,
             const GeodesicOptions& options, Progress* progress, GeodesicSummary* summary)
    : index_(index),
      hierarchy_(hierarchy),
      resolutions_(*resolutions),
      options_(options),
      progress_(progress),
      summary_(*summary) {}

void Piece::Run(const std::vector<ScheduleStep>& schedule) {
  known_.resize(resolutions_.size());
  for (size_t level = 0; level < known_.size(); ++level) {
    known_[level].shapes = {resolutions_[level].Pose(index_), resolutions_[level].Pose(index_ + 1)};
    if (level > 0) known_[level].base = known_[level - 1].shapes;
  }
  size_t trial = 1;
  while (trial < schedule.size() && schedule[trial].shapes == 1 &&
         resolutions_[schedule[trial].level].GetMetric().connectivity->NumVertices() <=
             kTrialVertices) {
    ++trial;
  }
  std::vector<Start> starts = {options_.start};
  if (options_.start == Start::kBest) starts = {Start::kBlend, Start::kFirst, Start::kLast};
  const Resolution& judge = resolutions_[schedule[trial - 1].level];
  const double bound = ScaledEnergy(
      EnergyLowerBound(judge.GetMetric(), judge.Pose(index_), judge.Pose(index_ + 1), 2), 2);
  const std::vector<Known> ends = known_;
  std::vector<Known> best;
  double best_energy = 0;
  size_t best_begin = 0, best_end = 0;  // rows of the summary
  const auto reject = [&](size_t begin, size_t end) {
    for (size_t row = begin; row < end; ++row) summary_.levels[row].kept = false;
  };
  for (Start start : starts) {
    known_ = ends;
    const size_t begin = summary_.levels.size();
    for (size_t i = 0; i < trial; ++i) Take(schedule[i], start);
    const double energy = summary_.levels.back().energy;
    if (best.empty() || energy < best_energy) {
      reject(best_begin, best_end);
      best = std::move(known_);
      best_energy = energy;
      best_begin = begin;
      best_end = summary_.levels.size();
    } else {
      reject(begin, summary_.levels.size());
    }
    if (best_energy <= kCertified * bound) break;
  }
  known_ = std::move(best);
  for (size_t i = trial; i < schedule.size(); ++i) {
    Take(schedule[i], options_.start);
  }
}

void Piece::Take(const ScheduleStep& step, Start start) {
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

  GeodesicSummary::Level row =
      resolution.Relax(index_, options_.tolerance, 0, options_, progress_, &shapes);
  row.start = name;
  summary_.levels.push_back(row);
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
      GeodesicSummary::Level row =
          rigid.Relax(0, options_.tolerance, 0, options_, progress_, &shapes);
      row.piece = index_;
      row.start = "blend, rigid metric";
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
