#include <shapespace/contact/internal/path_contact.h>

#include <algorithm>
#include <numeric>
#include <utility>

#include <shapespace/base/parallel.h>

namespace shapespace::internal {
namespace {

// Lists of near pairs are made for steps of so many times the length of the next one, within these
// multiples of the mean length at the vertices.
constexpr double kStepsPerList = 3, kLeastRoom = 0.05, kMostRoom = 0.25;

}  // namespace

std::vector<PathContact::Motion> PathContact::Segments(int num_shapes) {
  std::vector<Motion> motions;
  for (int i = 0; i + 1 < num_shapes; ++i) motions.push_back({i, i + 1});
  return motions;
}

PathContact::PathContact(const ContactModel& model, const PathEnergy& energy,
                         std::vector<Shape> shapes, std::vector<Motion> motions, int times)
    : energy_(energy),
      mean_length_(model.MeanLength()),
      shapes_(std::move(shapes)),
      changes_(shapes_.size(), Tangent::Zero(3, shapes_.front().cols())),
      directions_(energy.Size()),
      motions_(std::move(motions)),
      contacts_(motions_.size(), MotionContact(model, times)),
      forces_(motions_.size()) {
  ParallelFor(NumMotions(), [&](int i) {
    contacts_[i].Prepare(shapes_[motions_[i].from], shapes_[motions_[i].to],
                         kLeastRoom * mean_length_);
  });
}

double PathContact::Evaluate(const double* unknowns, double factor, double* gradient) {
  energy_.Store(unknowns, &shapes_);
  std::vector<double> values(motions_.size());
  ParallelFor(NumMotions(), [&](int i) {
    forces_[i].clear();
    values[i] = contacts_[i].Evaluate(shapes_[motions_[i].from], shapes_[motions_[i].to],
                                      gradient == nullptr ? nullptr : &forces_[i]);
  });
  const int inner = energy_.Inner(), stride = energy_.Stride();
  const double share = factor / NumMotions();
  for (int i = 0; i < NumMotions(); ++i) {
    const auto [from, to] = motions_[i];
    for (const VertexForce& force : forces_[i]) {
      for (int axis = 0; axis < 3; ++axis) {
        double* const row =
            gradient + (3 * static_cast<size_t>(energy_.Row(force.vertex)) + axis) * stride;
        if (from > 0) row[from - 1] += share * force.from(axis);
        if (to <= inner) row[to - 1] += share * force.to(axis);
      }
    }
  }
  return share * std::accumulate(values.begin(), values.end(), 0.0);
}

double PathContact::LongestStep(const double* unknowns, const float* direction) {
  energy_.Store(unknowns, &shapes_);
  allowed_ = shapes_;
  std::copy_n(direction, directions_.size(), directions_.begin());
  energy_.Store(directions_.data(), &changes_);
  std::vector<double> steps(motions_.size());
  ParallelFor(NumMotions(), [&](int i) {
    const double move =
        std::max(GreatestNorm(changes_[motions_[i].from]), GreatestNorm(changes_[motions_[i].to]));
    double room = contacts_[i].Room(shapes_[motions_[i].from], shapes_[motions_[i].to]);
    if (room < std::min(move, kLeastRoom * mean_length_)) {
      room = std::clamp(kStepsPerList * move, kLeastRoom * mean_length_, kMostRoom * mean_length_);
      contacts_[i].Prepare(shapes_[motions_[i].from], shapes_[motions_[i].to], room);
    }
    const double within = move > room ? room / move : 1;
    steps[i] = within * contacts_[i].SafeStep(shapes_[motions_[i].from], shapes_[motions_[i].to],
                                              within * changes_[motions_[i].from],
                                              within * changes_[motions_[i].to]);
  });
  return *std::min_element(steps.begin(), steps.end());
}

void PathContact::Limit(MinimiseOptions* options) {
  options->longest_step = [this](const double* x, const float* direction) {
    return LongestStep(x, direction);
  };
  options->allows = [this](const double* x) { return Allows(x); };
}

bool PathContact::Allows(const double* unknowns) {
  energy_.Store(unknowns, &shapes_);
  std::vector<std::vector<NearPair>> touching(motions_.size());
  ParallelFor(NumMotions(), [&](int i) {
    touching[i] = contacts_[i].Touching(shapes_[motions_[i].from], shapes_[motions_[i].to]);
  });
  bool free = true;
  for (const std::vector<NearPair>& pairs : touching) free = free && pairs.empty();
  if (free) return true;
  ParallelFor(NumMotions(), [&](int i) {
    if (touching[i].empty()) return;
    contacts_[i].Refine(touching[i]);
    contacts_[i].Prepare(allowed_[motions_[i].from], allowed_[motions_[i].to],
                         kLeastRoom * mean_length_);
  });
  return false;
}

}  // namespace shapespace::internal
