#include <shapespace/contact/internal/avoid_contact.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <numeric>
#include <optional>
#include <utility>

#include <shapespace/base/parallel.h>
#include <shapespace/contact/detail/increments.h>
#include <shapespace/contact/detail/separation_potential.h>
#include <shapespace/contact/internal/follow.h>
#include <shapespace/contact/internal/path_contact.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/metric/internal/cost_of_position.h>
#include <shapespace/minimise/internal/preconditioner.h>
#include <shapespace/path/energy.h>

namespace shapespace::internal {

std::vector<Shape> Divide(const Metric& metric, const std::vector<Shape>& states, int segments) {
  const std::vector<double> lengths = ChordLengths(metric, states);
  std::vector<int> parts(lengths.size(), 1);
  for (int rest = segments - static_cast<int>(parts.size()); rest > 0; --rest) {
    size_t longest = 0;
    for (size_t i = 0; i < parts.size(); ++i) {
      if (lengths[i] / parts[i] > lengths[longest] / parts[longest]) longest = i;
    }
    ++parts[longest];
  }
  std::vector<Shape> shapes = {states.front()};
  for (size_t i = 0; i < parts.size(); ++i) {
    for (int k = 1; k <= parts[i]; ++k) {
      const double t = static_cast<double>(k) / parts[i];
      shapes.push_back((1 - t) * states[i] + t * states[i + 1]);
    }
  }
  return shapes;
}

namespace {

// Relaxes the energy, or, unless `guide` is null, as KeepIncrements.
MinimiseResult Relax(const ContactModel& model, const std::shared_ptr<const Metric>& metric,
                     const CholeskyFactor<float>& factor, double stiffness,
                     const std::vector<Shape>* guide, MinimiseOptions options,
                     std::vector<Shape>* shapes) {
  const int segments = static_cast<int>(shapes->size()) - 1;
  PathEnergy energy(metric, segments - 1);
  Preconditioner preconditioner(factor, energy);
  std::vector<double> unknowns(energy.Size());
  energy.Load(*shapes, unknowns.data());
  PathContact contact(model, energy, *shapes, PathContact::Segments(segments + 1),
                      PathContact::kTimes);
  std::optional<Increments> increments;
  if (guide != nullptr) increments.emplace(metric, energy, *guide);
  options.rank = HistoryRank(static_cast<double>(unknowns.size()));
  contact.Limit(&options);
  const MinimiseResult result = MinimiseThreadedLbfgs(
      [&](const double* x, double* gradient) {
        double value = energy.Evaluate(x, gradient);
        if (increments) value += increments->Evaluate(x, gradient);
        return value + contact.Evaluate(x, 2 * stiffness / segments, gradient);
      },
      PreconditionOf(&preconditioner), options, &unknowns);
  energy.Store(unknowns.data(), shapes);
  return result;
}

}  // namespace

std::vector<int> SegmentsWithContact(const ContactModel& model, const std::vector<Shape>& shapes) {
  const int segments = static_cast<int>(shapes.size()) - 1;
  std::vector<char> free(segments);
  ParallelFor(segments, [&](int i) { free[i] = model.IsFree(shapes[i], shapes[i + 1]) ? 1 : 0; });
  std::vector<int> found;
  for (int i = 0; i < segments; ++i) {
    if (!free[i]) found.push_back(i);
  }
  return found;
}

double LeastDistance(const ContactModel& model, const std::vector<Shape>& shapes) {
  const int segments = static_cast<int>(shapes.size()) - 1;
  std::vector<double> least(segments, std::numeric_limits<double>::infinity());
  ParallelFor(segments, [&](int i) {
    const Shape &from = shapes[i], &to = shapes[i + 1];
    for (const NearPair& pair : model.Find(from, to, ContactModel::kReach, 0)) {
      for (int t = 0; t <= PathContact::kTimes; ++t) {
        const double time = static_cast<double>(t) / PathContact::kTimes;
        if (time < pair.begin || time > pair.end) continue;
        const FourPoints points = (1 - time) * model.At(pair, from) + time * model.At(pair, to);
        least[i] = std::min(least[i], NearestPoints(pair.kind, points).Distance());
      }
    }
  });
  const double distance = *std::min_element(least.begin(), least.end());
  return std::isfinite(distance) ? model.GetMetric()->unit * distance
                                 : std::numeric_limits<double>::quiet_NaN();
}

int FirstLevelOfContact(int finest, int intersections,
                        const std::function<ContactModel(int)>& model) {
  // With fewer triangles the way round is hardly the mesh's own.
  constexpr int kFewestTriangles = 800;
  for (int level = 0; level < finest; ++level) {
    const ContactModel its_model = model(level);
    if (its_model.GetMetric()->connectivity->NumTriangles() >= kFewestTriangles &&
        its_model.NumIntersections() <= intersections) {
      return level;
    }
  }
  return finest;
}

std::string WarningOfIntersections(const std::string& what, const ContactModel& model) {
  const bool has_segments = !model.GetMetric()->connectivity->Segments().empty();
  return what + " (" + std::to_string(model.NumIntersections()) + " pairs of triangles" +
         (has_segments ? " or segments" : "") + "); contact is not avoided there";
}

std::string WarningOfUncertified(int segments) {
  return std::to_string(segments) + " segments have not been shown to be free of contact";
}

namespace {

// Without the rigid motions of inner shapes that contact has caused, unless something touches then.
std::vector<Shape> WithoutDrift(const ContactModel& model, const std::vector<Shape>& shapes) {
  if (model.HasObstacle() || !model.GetMetric()->RigidInvariantButForPosition()) return shapes;
  std::vector<Shape> moved = shapes;
  RemoveRigidDrift(&moved, model.GetMetric()->vertex_area);
  return SegmentsWithContact(model, moved).empty() ? moved : shapes;
}

// A way from the first shape of `guide` to the last, or else from the last to the first.
FreeWay FollowFromEitherEnd(const ContactModel& model, const Attraction& attraction,
                            double stiffness, std::vector<Shape> guide,
                            const std::function<bool()>& go_on) {
  FreeWay way = Follow(model, attraction, stiffness, guide, go_on);
  if (way.arrives) return way;
  std::reverse(guide.begin(), guide.end());
  way = Follow(model, attraction, stiffness, guide, go_on);
  std::reverse(way.shapes.begin(), way.shapes.end());
  return way;
}

// As FollowFromEitherEnd; if that does not arrive, because parts press against each other, of paths
// on which parts have been pushed out of each other, more and more.
FreeWay FindWay(const ContactModel& model, const CholeskyFactor<float>& factor, double energy,
                const std::vector<Shape>& guide, const std::function<bool()>& go_on) {
  const std::shared_ptr<const Metric>& metric = model.GetMetric();
  const Attraction attraction = {metric, factor, kRoughApproach};
  const double stiffness = kContactStiffness * energy;
  FreeWay way = FollowFromEitherEnd(model, attraction, stiffness, guide, go_on);
  if (way.arrives) return way;

  constexpr int kMostSegments = 8;
  const int rest = static_cast<int>(guide.size()) - 1, segments = std::min(kMostSegments, rest);
  std::vector<Shape> parted;
  for (int i = 0; i <= segments; ++i) parted.push_back(guide[i * rest / segments]);
  // Limbs are about as thick.
  const double reach = 0.1 * std::sqrt(metric->vertex_area.sum());
  SeparationPotential separation(*metric, {guide.front(), guide.back()}, reach);
  PathEnergy path_energy(metric, segments - 1);
  Preconditioner preconditioner(factor, path_energy);
  std::vector<double> unknowns(path_energy.Size());
  path_energy.Load(parted, unknowns.data());
  MinimiseOptions options;
  options.tolerance = 1e-5;  // parts that overlap entirely are near a saddle
  options.max_iterations = 200;
  options.keep_going = [&](int, double) { return go_on(); };
  constexpr double kLeast = 64, kMost = 65536;
  size_t touching = SegmentsWithContact(model, parted).size();
  for (double strength = kLeast; strength <= kMost && !way.arrives && go_on(); strength *= 4) {
    MinimiseThreadedLbfgs(
        [&](const double* x, double* gradient) {
          return path_energy.Evaluate(x, gradient) +
                 separation.Evaluate(path_energy, x, 2 * strength * energy / segments, &parted,
                                     gradient);
        },
        PreconditionOf(&preconditioner), options, &unknowns);
    path_energy.Store(unknowns.data(), &parted);
    const size_t before = std::exchange(touching, SegmentsWithContact(model, parted).size());
    if (touching < before) way = FollowFromEitherEnd(model, attraction, stiffness, parted, go_on);
  }
  return way;
}

// A cost of position that draws a body through an opening in which it has to become narrower, and
// keeps it from rigid motion in steps of the solver, which contact would cut short.
constexpr double kDrawingLambda = 1;

}  // namespace

double EnergyAlong(const Metric& metric, const std::vector<Shape>& shapes) {
  const std::vector<double> lengths = ChordLengths(metric, shapes);
  const double length = std::accumulate(lengths.begin(), lengths.end(), 0.);
  return length * length / 2;
}

ContactFreePath AvoidContact(const ContactModel& model, const CholeskyFactor<float>& factor,
                             double energy, const std::vector<Shape>& guide, int segments,
                             const MinimiseOptions& options) {
  ContactFreePath result;
  const auto go_on = [&] { return !options.keep_going || options.keep_going(0, 0); };
  const std::shared_ptr<const Metric>& metric = model.GetMetric();
  std::optional<CholeskyFactor<float>> its_factor;
  const CholeskyFactor<float>* preconditioner = &factor;
  FreeWay way;
  if (model.HasObstacle()) {
    const auto drawing = WithCostOfPosition(metric, kDrawingLambda);
    its_factor.emplace(ScalarMetric(*drawing, {guide.front(), guide.back()}, 0));
    preconditioner = &*its_factor;
    way = FollowFromEitherEnd(model, {drawing, *its_factor, kCloseApproach},
                              kContactStiffness * EnergyAlong(*drawing, guide), guide, go_on);
    energy = EnergyAlong(*metric, way.shapes);
  } else {
    way = FindWay(model, factor, energy, guide, go_on);
  }
  if (!way.arrives) return result;

  std::vector<Shape> states = Shorten(model, std::move(way.shapes), segments);
  // A way with more straight parts than that needs fewer of them once it is relaxed.
  while (true) {
    const int parts = static_cast<int>(states.size()) - 1;
    const int multiple = (parts + segments - 1) / segments;
    states = WithoutDrift(model, Divide(*metric, states, multiple * segments));
    result.result = Relax(model, metric, *preconditioner, kContactStiffness * energy, nullptr,
                          options, &states);
    if (multiple == 1) {
      result.shapes = WithoutDrift(model, states);
      return result;
    }
    states = Shorten(model, std::move(states), segments);
    result.parts = static_cast<int>(states.size()) - 1;
    if (result.parts >= parts || !go_on()) return result;
  }
}

MinimiseResult KeepIncrements(const ContactModel& model, const std::vector<Shape>& guide,
                              const MinimiseOptions& options, std::vector<Shape>* shapes) {
  const std::shared_ptr<const Metric> metric =
      model.HasObstacle() ? WithCostOfPosition(model.GetMetric(), kDrawingLambda)
                          : model.GetMetric();
  const CholeskyFactor<float> factor(ScalarMetric(*metric, {guide.front(), guide.back()}, 0));
  const double stiffness = kContactStiffness * EnergyAlong(*metric, guide);
  return Relax(model, metric, factor, stiffness, &guide, options, shapes);
}

}  // namespace shapespace::internal
