#include <shapespace/deformation/detail/contact_deformation.h>

#include <algorithm>
#include <utility>

#include <shapespace/contact/internal/avoid_contact.h>
#include <shapespace/contact/internal/follow.h>
#include <shapespace/contact/internal/path_contact.h>
#include <shapespace/geodesic/internal/arc_length.h>
#include <shapespace/path/path.h>

namespace shapespace::internal {
namespace {

// Steps in which the handles are followed, at least.
constexpr int kSteps = 24;

class HandleFollower {
 public:
  HandleFollower(const ContactModel& model, double stiffness, HeldLevel* level)
      : model_(model), stiffness_(stiffness), level_(*level) {}

  // Moves the handles of the last shape of `way` to their targets, and the rest of it near to
  // `guide`; appends the shapes on the way there. Returns false if something is in the way of the
  // handles.
  bool Move(const Shape& handle_positions, Shape guide, std::vector<Shape>* way) {
    level_.Place(handle_positions, true, &guide);
    if (model_.IsFree(way->back(), guide)) {
      way->push_back(std::move(guide));
      return true;
    }
    // A share of the way in each move, because the body gives way in between.
    constexpr int kMostMoves = 40;
    constexpr double kLeastShare = 1. / 128;
    for (int move = 0; move < kMostMoves; ++move) {
      const Shape from = way->back(), moved = level_.WithHardHandlesAt(handle_positions, from);
      double share = 1;
      while (!model_.IsFree(from, Between(from, moved, share))) {
        share /= 2;
        if (share < kLeastShare) return false;
      }
      way->push_back(Between(from, moved, share));
      Shape shape = way->back();
      StepAside(handle_positions, guide, &shape);
      way->push_back(std::move(shape));
      if (share == 1) return true;
    }
    return false;
  }

 private:
  static Shape Between(const Shape& from, const Shape& to, double share) {
    return share == 1 ? to : (1 - share) * from + share * to;
  }

  void StepAside(const Shape& handle_positions, const Shape& guide, Shape* shape) {
    MinimiseOptions options;
    options.tolerance = kRoughApproach.tolerance;
    options.max_iterations = kRoughApproach.max_iterations;
    options.keep_going = UntilLittleIsGained(options.tolerance);
    const ConstrainedPath::Contact contact = {model_, stiffness_, {{1, 1}}, 1};
    std::vector<Shape> pair = {guide, *shape};
    level_.Path().Relax(level_.Target(handle_positions), options, &pair, &contact);
    *shape = std::move(pair[1]);
  }

  const ContactModel& model_;
  const double stiffness_;
  HeldLevel& level_;
};

// From each shape the motion to the next, if it is free of contact; else the shape alone. So also
// for the last, which nothing but its own potential keeps off contact: that of a motion is of the
// times before its end.
std::vector<PathContact::Motion> FreeMotions(const ContactModel& model,
                                             const std::vector<Shape>& shapes) {
  const int last = static_cast<int>(shapes.size()) - 1;
  std::vector<PathContact::Motion> motions;
  for (int i = 0; i <= last; ++i) {
    if (i < last && model.IsFree(shapes[i], shapes[i + 1])) {
      motions.push_back({i, i + 1});
    } else if (i > 0) {  // the first does not move
      motions.push_back({i, i});
    }
  }
  return motions;
}

// Whether no hard handle moves, so that a shape may be reached at any time.
bool HardHandlesRest(const HandleTargets& targets, const HeldLevel& level) {
  Shape first = level.Rest(), last = first;
  level.Place(targets.At(0), true, &first);
  level.Place(targets.At(1), true, &last);
  return first == last;
}

}  // namespace

ContactFreeDeformation DeformWithoutContact(const ContactModel& model, const HandleTargets& targets,
                                            double stiffness, const std::vector<Shape>& guide,
                                            const MinimiseOptions& options,
                                            const std::function<bool()>& go_on, HeldLevel* level) {
  const int segments = static_cast<int>(guide.size()) - 1;
  const int between = (kSteps + segments - 1) / segments, steps = between * segments;
  const std::vector<Shape> guides =
      Resample(guide, UniformTimes(segments - 1), UniformTimes(steps - 1));
  HandleFollower follower(model, stiffness, level);
  ContactFreeDeformation result;
  std::vector<Shape> shapes = {guide.front()}, way = shapes;
  for (int step = 1; step <= steps; ++step) {
    if (!go_on()) return result;
    const double time = static_cast<double>(step) / steps;
    const size_t before = way.size();
    if (!follower.Move(targets.At(time), guides[step], &way)) return result;
    result.reached = time;
    if (step % between == 0) shapes.push_back(way.back());
    if (model.IsFree(way[before - 1], way.back())) way.erase(way.begin() + before, way.end() - 1);
  }
  const auto relax = [&](std::vector<Shape> from) {
    const ConstrainedPath::Contact contact = {model, 2 * stiffness / segments,
                                              FreeMotions(model, from), PathContact::kTimes};
    result.result = level->Path().Relax(level->Target(targets.At(1)), options, &from, &contact);
    result.shapes = std::move(from);
  };
  relax(std::move(shapes));
  if (SegmentsWithContact(model, result.shapes).empty() || !HardHandlesRest(targets, *level)) {
    return result;
  }
  // Again, from shapes of the way between which nothing touches, whenever they were reached: what
  // is free of contact at the beginning stays so. If parts of the way are not straight, or too many
  // are, from its first ones, from which soft handles draw on as far as they can.
  const std::vector<int> touching = SegmentsWithContact(model, way);
  if (!touching.empty()) {
    way.resize(touching.front() + 1);
    way.push_back(way.back());
  }
  way = Shorten(model, std::move(way), segments);
  if (static_cast<int>(way.size()) - 1 > segments) way.resize(segments + 1);
  relax(Divide(*model.GetMetric(), way, segments));
  return result;
}

}  // namespace shapespace::internal
