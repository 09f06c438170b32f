#include <shapespace/contact/detail/motion_contact.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace shapespace::internal {
namespace {

// In a step every pair keeps this part of its distance.
constexpr double kKeptOfStep = 0.2;

FourPoints Between(const FourPoints& from, const FourPoints& to, double time) {
  return (1 - time) * from + time * to;
}

// A pair whose points move straight on.
struct MovingPair {
  PairKind kind;
  const FourPoints &from, &to;
  double speed;     // of its elements relative to each other
  double enough;    // a distance that is not to be known better
  double shortest;  // parts of the motion of less time than this are not divided

  double DistanceAt(double time) const {
    return NearestPoints(kind, Between(from, to, time)).Distance();
  }

  // The least distance during a part of the motion, from the distances at its ends, or less; at
  // least `enough` if it may be. Of two times the distance in between is at least half the sum of
  // those at both, less half the way that the elements move relative to each other.
  double LeastDistance(double begin, double end, double at_begin, double at_end) const {
    const double least = (at_begin + at_end - speed * (end - begin)) / 2;
    if (least >= enough || end - begin <= shortest) return least;
    const double middle = (begin + end) / 2, at_middle = DistanceAt(middle);
    return std::min(LeastDistance(begin, middle, at_begin, at_middle),
                    LeastDistance(middle, end, at_middle, at_end));
  }
};

}  // namespace

double GreatestNorm(const Tangent& tangent) {
  return std::sqrt(tangent.colwise().squaredNorm().maxCoeff());
}

int MotionContact::Entry::FirstTime() const {
  return std::clamp(static_cast<int>(std::floor(pair.begin * times)), 0, times - 1);
}

int MotionContact::Entry::LastTime() const {
  return std::clamp(static_cast<int>(std::ceil(pair.end * times)), 0, times - 1);
}

void MotionContact::Refine(const std::vector<NearPair>& pairs) {
  constexpr int kMostTimes = 10240;
  for (const NearPair& pair : pairs) {
    int& times = refined_.emplace(std::make_pair(pair.kind, pair.vertices), times_).first->second;
    if (times < kMostTimes) times *= 2;
  }
  room_ = -1;
}

void MotionContact::Prepare(const Shape& from, const Shape& to, double room) {
  from_ = from;
  to_ = to;
  room_ = room;
  entries_.clear();
  for (const NearPair& pair : model_.Find(from, to, ContactModel::kReach, 2 * room)) {
    const FourPoints first = model_.At(pair, from), last = model_.At(pair, to);
    const double begin = std::max(0.f, pair.begin), end = std::min(1.f, pair.end);
    const double reach = ContactModel::kReach * model_.Length(pair);
    const MovingPair moving = {
        pair.kind,        first,      last, RelativeSpeed(pair.kind, last - first),
        reach + 2 * room, 1. / times_};
    const double least =
        moving.LeastDistance(begin, end, moving.DistanceAt(begin), moving.DistanceAt(end));
    if (least >= reach + 2 * room) continue;
    const PairPotential potential = model_.PotentialOf(pair);
    const double excess = least - potential.reach;
    if (excess >= 2 * room) continue;
    const auto refined = refined_.find({pair.kind, pair.vertices});
    entries_.push_back(
        {pair, potential, refined == refined_.end() ? times_ : refined->second, excess});
  }
  std::stable_sort(entries_.begin(), entries_.end(),
                   [](const Entry& a, const Entry& b) { return a.excess < b.excess; });
}

double MotionContact::Displacement(const Shape& from, const Shape& to) const {
  return std::max(GreatestNorm(from - from_), GreatestNorm(to - to_));
}

double MotionContact::Room(const Shape& from, const Shape& to) const {
  return room_ < 0 ? room_ : room_ - Displacement(from, to);
}

size_t MotionContact::NumActive(const Shape& from, const Shape& to) const {
  const double closer = 2 * Displacement(from, to);
  return std::partition_point(entries_.begin(), entries_.end(),
                              [&](const Entry& entry) { return entry.excess < closer; }) -
         entries_.begin();
}

double MotionContact::Evaluate(const Shape& from, const Shape& to,
                               std::vector<VertexForce>* forces) const {
  double sum = 0;
  const size_t active = NumActive(from, to);
  for (size_t i = 0; i < active; ++i) {
    const Entry& entry = entries_[i];
    const FourPoints first = model_.At(entry.pair, from), last = model_.At(entry.pair, to);
    FourPoints by_first = FourPoints::Zero(), by_last = FourPoints::Zero();
    bool any = false;
    for (int t = entry.FirstTime(); t <= entry.LastTime(); ++t) {
      const double time = static_cast<double>(t) / entry.times;
      const FourPoints points = Between(first, last, time);
      const Separation separation = NearestPoints(entry.pair.kind, points);
      FourPoints gradient = FourPoints::Zero();
      const double value = entry.potential.Add(points, separation, 1. / entry.times, &gradient);
      if (value == 0) continue;
      any = true;
      sum += value;
      by_first += (1 - time) * gradient;
      by_last += time * gradient;
    }
    if (!any || forces == nullptr) continue;
    for (int k = 0; k < 4; ++k) {
      if (!model_.IsOfBody(entry.pair.vertices[k])) continue;
      forces->push_back({entry.pair.vertices[k], by_first.col(k), by_last.col(k)});
    }
  }
  return sum;
}

double MotionContact::SafeStep(const Shape& from, const Shape& to, const Tangent& from_change,
                               const Tangent& to_change) const {
  double step = 1;
  const double closer =
      2 * std::max(GreatestNorm(from_change), GreatestNorm(to_change)) + 2 * Displacement(from, to);
  for (const Entry& entry : entries_) {
    if (entry.excess >= closer) break;
    const FourPoints first = model_.At(entry.pair, from), last = model_.At(entry.pair, to);
    const FourPoints first_change = model_.ChangeAt(entry.pair, from_change),
                     last_change = model_.ChangeAt(entry.pair, to_change);
    for (int t = entry.FirstTime(); t <= entry.LastTime(); ++t) {
      const double time = static_cast<double>(t) / entry.times;
      step *= shapespace::SafeStep(entry.pair.kind, Between(first, last, time),
                                   step * Between(first_change, last_change, time), kKeptOfStep);
    }
  }
  return step;
}

std::vector<NearPair> MotionContact::Touching(const Shape& from, const Shape& to) const {
  std::vector<NearPair> touching;
  const size_t active = NumActive(from, to);
  for (size_t i = 0; i < active; ++i) {
    const Entry& entry = entries_[i];
    const FourPoints first = model_.At(entry.pair, from), last = model_.At(entry.pair, to);
    const FourPoints change = (last - first) / entry.times;
    const double length = model_.Length(entry.pair);
    for (int t = entry.FirstTime(); t <= entry.LastTime(); ++t) {
      const FourPoints begin = Between(first, last, static_cast<double>(t) / entry.times);
      if (internal::IsFree(entry.pair.kind, begin, begin + change, length)) continue;
      touching.push_back(entry.pair);
      break;
    }
  }
  return touching;
}

}  // namespace shapespace::internal
