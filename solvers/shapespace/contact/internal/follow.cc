#include <shapespace/contact/internal/follow.h>

#include <limits>
#include <utility>

#include <shapespace/contact/internal/path_contact.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/minimise/internal/minimise.h>
#include <shapespace/minimise/internal/preconditioner.h>
#include <shapespace/path/energy.h>

namespace shapespace::internal {
namespace {

// Moves a shape towards another as far as it gets without contact.
class Approach {
 public:
  Approach(const ContactModel& model, const Attraction& attraction, double stiffness)
      : model_(model),
        attraction_(attraction),
        stiffness_(stiffness),
        energy_(attraction.metric, 1),
        preconditioner_(attraction.factor, energy_) {}

  // The shapes on the way there, each of which is reached from the one before on a straight way.
  std::vector<Shape> Run(const Shape& shape, const Shape& target) {
    // Both ends of the path are the target, so its energy is four times the squared distance.
    path_ = {target, shape, target};
    std::vector<double> unknowns(energy_.Size());
    energy_.Load(path_, unknowns.data());
    PathContact contact(model_, energy_, path_, {{1, 1}}, 1);
    std::vector<Shape> way;
    MinimiseOptions options;
    options.tolerance = attraction_.end.tolerance;
    options.max_iterations = attraction_.end.max_iterations;
    options.keep_going = UntilLittleIsGained(attraction_.end.tolerance);
    options.longest_step = [&](const double* x, const float* direction) {
      energy_.Store(x, &path_);
      way.push_back(path_[1]);
      return contact.LongestStep(x, direction);
    };
    MinimiseThreadedLbfgs(
        [&](const double* x, double* gradient) {
          const double energy = energy_.Evaluate(x, gradient);
          return energy + contact.Evaluate(x, 2 * stiffness_, gradient);
        },
        PreconditionOf(&preconditioner_), options, &unknowns);
    energy_.Store(unknowns.data(), &path_);
    way.push_back(path_[1]);
    return way;
  }

 private:
  const ContactModel& model_;
  const Attraction& attraction_;
  const double stiffness_;
  PathEnergy energy_;
  Preconditioner preconditioner_;
  std::vector<Shape> path_;
};

}  // namespace

std::function<bool(int iteration, double energy)> UntilLittleIsGained(double tolerance) {
  constexpr int kMostLittle = 10;
  return [tolerance, little = 0, before = std::numeric_limits<double>::infinity()](
             int, double energy) mutable {
    little = before - energy < tolerance * energy ? little + 1 : 0;
    before = energy;
    return little < kMostLittle;
  };
}

std::vector<Shape> Shorten(const ContactModel& model, std::vector<Shape> way, int most_parts) {
  const Metric& metric = *model.GetMetric();
  // How much shorter the way gets by leaving out a shape.
  const auto gain = [&](size_t i) {
    const double past = ChordLengths(metric, {way[i - 1], way[i + 1]})[0];
    const std::vector<double> through = ChordLengths(metric, {way[i - 1], way[i], way[i + 1]});
    return through[0] + through[1] - past;
  };
  std::vector<double> gains(way.size(), 0.);
  std::vector<char> needed(way.size(), 0);
  for (size_t i = 1; i + 1 < way.size(); ++i) gains[i] = gain(i);
  while (static_cast<int>(way.size()) - 1 > most_parts) {
    size_t least = 0;
    for (size_t i = 1; i + 1 < way.size(); ++i) {
      if (!needed[i] && (least == 0 || gains[i] < gains[least])) least = i;
    }
    if (least == 0) break;
    if (!model.IsFree(way[least - 1], way[least + 1])) {
      needed[least] = 1;
      continue;
    }
    way.erase(way.begin() + least);
    gains.erase(gains.begin() + least);
    needed.erase(needed.begin() + least);
    for (const size_t i : {least - 1, least}) {
      if (i == 0 || i + 1 >= way.size()) continue;
      gains[i] = gain(i);
      needed[i] = 0;
    }
  }
  return way;
}

FreeWay Follow(const ContactModel& model, const Attraction& attraction, double stiffness,
               const std::vector<Shape>& guide, const std::function<bool()>& go_on) {
  Approach approach(model, attraction, stiffness);
  const Eigen::VectorXd& area = model.GetMetric()->vertex_area;
  FreeWay way = {{guide.front()}, false, {0}};
  for (size_t k = 1; k < guide.size(); ++k) {
    if (!go_on()) return way;
    if (model.IsFree(way.shapes.back(), guide[k])) {
      way.shapes.push_back(guide[k]);
      way.reached.push_back(way.shapes.size() - 1);
      way.arrives = k + 1 == guide.size();
      continue;
    }
    const std::vector<Shape> steps = approach.Run(way.shapes.back(), guide[k]);
    // Contact turns the whole body too, at no cost.
    const Shape turned_back = FitRigidMotion(steps.back(), guide[k], area)(steps.back());
    if (model.IsFree(steps.front(), turned_back)) {
      way.shapes.push_back(turned_back);
      way.reached.push_back(way.shapes.size() - 1);
      continue;
    }
    for (size_t at = 0; at + 1 < steps.size();) {
      size_t next = steps.size() - 1;
      while (next > at + 1 && !model.IsFree(steps[at], steps[next])) next = at + (next - at) / 2;
      way.shapes.push_back(steps[next]);
      at = next;
    }
    way.reached.push_back(way.shapes.size() - 1);
  }
  if (!way.arrives && model.IsFree(way.shapes.back(), guide.back())) {
    way.shapes.push_back(guide.back());
    way.reached.back() = way.shapes.size() - 1;
    way.arrives = true;
  }
  return way;
}

}  // namespace shapespace::internal
