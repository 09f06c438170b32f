#include <shapespace/correspondence/detail/limb_turns.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <Eigen/Geometry>

#include <shapespace/base/internal/task_group.h>
#include <shapespace/base/parallel.h>
#include <shapespace/correspondence/detail/shell_fit.h>
#include <shapespace/matching/internal/matching.h>
#include <shapespace/mesh/internal/submesh.h>

namespace shapespace::internal {
namespace {

// Distances from the end of a limb along the surface, as shares of the root of the area: up to the
// first all is turned, which is a hand of a person; to the second ever less, which is a forearm and
// the elbow; to the third the fit may move what is not turned. What is beyond, up to the last, is
// held.
constexpr double kTurned = 0.17, kTwisted = 0.45, kMoved = 0.48, kLimb = 0.55;
// What has more of the body's area is no limb: of people, the head with the shoulders.
constexpr double kLargest = 0.2;
// So many held vertices of a limb say how it is turned, and no time is spent on it.
constexpr int kEnoughHeld = 3;
// Of the fit of a limb: first with the former weight of closest points, then with the latter, which
// hardly lets it slide. It need not come to rest.
constexpr double kLooseWeight = 100, kTightWeight = 1000;
constexpr int kFirstRounds = 4, kLooseRounds = 6, kTightRounds = 4;
// A turned limb whose energy after the first rounds is this many times that of the other is given
// up, as are a third of them; of those that become better it is 0.6 to 1.8 times as much.
constexpr double kHopeless = 4;
// A limb is turned if its energy then is at most this share. Of 14 pairs of people those whose hand
// had been wrong by half a turn had .80 to .95, others .97 and more.
constexpr double kBetter = 0.95;

// The middle of a limb, as a function of the distance from its end.
class Axis {
 public:
  // `distances` of the vertices of `shape`.
  Axis(const Shape& shape, const Eigen::VectorXf& distances) {
    Eigen::VectorXd weights = Eigen::VectorXd::Zero(kPoints);
    points_.setZero();
    for (Eigen::Index v = 0; v < shape.cols(); ++v) {
      for (int i = 0; i < kPoints; ++i) {
        const double apart = distances(v) / kStep - i;
        const double weight = std::exp(-apart * apart);
        points_.col(i) += weight * shape.col(v);
        weights(i) += weight;
      }
    }
    for (int i = 0; i < kPoints; ++i) points_.col(i) /= weights(i);
  }

  // `point`, which is at this distance from the end, turned about the axis there.
  Eigen::Vector3d Turned(const Eigen::Vector3d& point, double distance, double angle) const {
    const int i = std::min(static_cast<int>(distance / kStep), kPoints - 2);
    const Eigen::Vector3d centre =
        points_.col(i) + (distance / kStep - i) * (points_.col(i + 1) - points_.col(i));
    // Of the very end the points are too near to each other to tell a direction.
    const Eigen::Vector3d direction =
        points_.col(std::min(i + 2, kPoints - 1)) - points_.col(std::max(i - 1, 1));
    return centre + Eigen::AngleAxisd(angle, direction.normalized()) * (point - centre);
  }

 private:
  static constexpr double kStep = 0.025;
  static constexpr int kPoints = static_cast<int>(kLimb / kStep);
  Eigen::Matrix<double, 3, kPoints> points_;
};

// A limb as a level of its own, and its part of what is fitted.
struct Limb {
  Limb(const Level& body, const Shape& rest, const std::vector<int>& held_of_body,
       const Eigen::VectorXf& from_end, const Eigen::VectorXd& areas)
      : part(MakeSubmesh(*body.connectivity, Near(from_end))),
        level{part.connectivity, {}, BorderOf(*part.connectivity)},
        distances(from_end(part.vertices)),
        rest(rest(Eigen::all, part.vertices)),
        share(areas(part.vertices).sum()) {
    std::vector<bool> is_held(rest.cols(), false);
    for (const int v : held_of_body) is_held[v] = true;
    for (size_t i = 0; i < part.vertices.size(); ++i) {
      level.vertices.push_back(body.vertices[part.vertices[i]]);
      const bool beyond = distances(i) > kMoved;
      if (is_held[part.vertices[i]] && !beyond) ++markers;
      if (is_held[part.vertices[i]] || beyond) held.push_back(static_cast<int>(i));
    }
  }

  static std::vector<bool> Near(const Eigen::VectorXf& from_end) {
    std::vector<bool> near;
    for (const float distance : from_end) near.push_back(distance < kLimb);
    return near;
  }

  Shape Turned(const Shape& shape, double angle) const {
    const Axis axis(shape, distances);
    Shape turned = shape;
    for (Eigen::Index v = 0; v < shape.cols(); ++v) {
      const double twist = (kTwisted - distances(v)) / (kTwisted - kTurned);
      if (twist <= 0) continue;
      turned.col(v) = axis.Turned(shape.col(v), distances(v), angle * std::min(1.0, twist));
    }
    for (const int v : held) turned.col(v) = shape.col(v);
    return turned;
  }

  Submesh part;
  Level level;
  Eigen::VectorXf distances;  // from the end
  Shape rest;
  std::vector<int> held;
  int markers = 0;  // of these, held by the user
  double share;     // of the body's area
};

// Where samples of the target are nearest to a template.
class NearestTriangles {
 public:
  NearestTriangles(const Level& level, const Shape& shape, const Target& target)
      : triangles_(level.connectivity->Triangles()),
        samples_(SampleTarget(target, 2 * static_cast<int>(shape.cols()))),
        nearest_(samples_.vertices.size()) {
    const MeshSurface surface(level.connectivity, shape);
    ParallelFor(static_cast<int>(nearest_.size()), [&](int i) {
      nearest_[i] = NearestOnTemplate(surface, level, target, samples_.vertices[i]).triangle;
    });
  }

  // Those nearest to a part of the template, of which `index` is -1 elsewhere, or to nothing.
  TargetSamples SamplesNear(const std::vector<int>& index) const {
    TargetSamples near{{}, samples_.area};
    for (size_t i = 0; i < nearest_.size(); ++i) {
      if (nearest_[i] < 0 || index[triangles_(0, nearest_[i])] >= 0) {
        near.vertices.push_back(samples_.vertices[i]);
      }
    }
    return near;
  }

 private:
  const Eigen::Matrix3Xi& triangles_;
  const TargetSamples samples_;
  std::vector<int> nearest_;
};

// The fit of a limb, which may begin with any shape of it.
class LimbFit {
 public:
  LimbFit(const Limb& limb, const Target& target, const TargetSamples& samples,
          const CorrespondenceOptions& options)
      : limb_(limb),
        target_(target),
        samples_(samples),
        tolerance_(options.tolerance),
        fit_(limb.level.connectivity, limb.rest, limb.held, options.bending, options.proportions) {}

  // Each returns the energy after it.
  double Begin(Shape* shape) {
    Rounds(kLooseWeight, kFirstRounds, shape);
    return fit_.Energy(Terms(kTightWeight, *shape), *shape);
  }
  double End(Shape* shape) {
    Rounds(kLooseWeight, kLooseRounds, shape);
    Rounds(kTightWeight, kTightRounds, shape);
    return fit_.Energy(Terms(kTightWeight, *shape), *shape);
  }

 private:
  void Rounds(double weight, int count, Shape* shape) {
    for (int i = 0; i < count; ++i) {
      if (fit_.Step(Terms(weight, *shape), shape) < tolerance_) break;
    }
  }

  // Weighted as in a fit of the whole, divided by the limb's share.
  std::vector<PointToPlaneTerm> Terms(double weight, const Shape& shape) const {
    double distance;
    return FindTerms(limb_.level, shape, limb_.share * fit_.VertexAreas(), target_, samples_,
                     weight, &distance);
  }

  const Limb& limb_;
  const Target& target_;
  const TargetSamples& samples_;
  const double tolerance_;
  ShellFit fit_;
};

// The limb turned by half a turn if its energy is less then.
std::optional<Shape> TurnedIfBetter(const Limb& limb, Shape shape, const Target& target,
                                    const TargetSamples& samples,
                                    const CorrespondenceOptions& options) {
  LimbFit fit(limb, target, samples, options);
  // Either way, which twist the forearm differently.
  std::vector<Shape> turned;
  for (const double angle : {EIGEN_PI, -EIGEN_PI}) turned.push_back(limb.Turned(shape, angle));
  const double hopeless = kHopeless * fit.Begin(&shape);
  std::vector<Shape> hopeful;
  for (Shape& other : turned) {
    if (fit.Begin(&other) > hopeless) continue;
    hopeful.push_back(std::move(other));
  }
  if (hopeful.empty()) return std::nullopt;
  double least = kBetter * fit.End(&shape);
  std::optional<Shape> better;
  for (Shape& other : hopeful) {
    const double energy = fit.End(&other);
    if (energy > least) continue;
    least = energy;
    better = std::move(other);
  }
  return better;
}

}  // namespace

int TurnLimbs(const Level& level, const Shape& rest, const std::vector<int>& held,
              const Target& target, const CorrespondenceOptions& options, Progress* progress,
              Shape* shape) {
  const Eigen::VectorXd areas = VertexAreas(*level.connectivity, rest);
  const NearestTriangles nearest(level, *shape, target);
  std::vector<Limb> limbs;
  for (const LimbEnd& end : FindLimbEnds(*level.connectivity, rest)) {
    Limb limb(level, rest, held, end.distances, areas);
    if (limb.share < kLargest && limb.markers < kEnoughHeld) limbs.push_back(std::move(limb));
  }
  const auto count = static_cast<int>(limbs.size());
  std::vector<std::optional<Shape>> better(count);
  TaskGroup(progress, "turns of limbs", count).RunAll(count, [&](int i, Progress*) {
    better[i] = TurnedIfBetter(limbs[i], (*shape)(Eigen::all, limbs[i].part.vertices), target,
                               nearest.SamplesNear(limbs[i].part.index), options);
  });
  int turned = 0;
  for (int i = 0; i < count; ++i) {
    if (!better[i]) continue;
    for (size_t k = 0; k < limbs[i].part.vertices.size(); ++k) {
      shape->col(limbs[i].part.vertices[k]) = better[i]->col(k);
    }
    ++turned;
  }
  level.connectivity->CopyToTwins(shape);
  return turned;
}

}  // namespace shapespace::internal
