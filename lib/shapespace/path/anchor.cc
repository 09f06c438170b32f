#include <shapespace/path/anchor.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include <Eigen/Geometry>
#include <Eigen/SVD>

#include <shapespace/base/error.h>
#include <shapespace/base/parallel.h>
#include <shapespace/mesh/seams.h>
#include <shapespace/path/internal/velocity.h>

namespace shapespace {
namespace {

// The vertices of a part, which define its position.
struct Part {
  const std::vector<int>& vertices;
  Eigen::VectorXd weights;  // one per vertex
};

// A part in one shape as placed by the path. Stored relative to its centroid, so that accuracy does
// not depend on its distance from the origin.
struct PlacedPart {
  double parameter = 0;
  Shape points;            // in the metric's unit, rotated, relative to their centroid
  Eigen::Vector3d inside;  // the centroid before the shape is placed, in the user's unit
  Eigen::Vector3d centre;  // the centroid in the user's frame
};

PlacedPart PartOf(const Path& path, int i, const Part& part) {
  const Shape points = path.shapes[i](Eigen::all, part.vertices);
  const Eigen::Vector3d centroid = Centroid(points, part.weights);
  const RigidMotion& motion = path.motions[i];
  PlacedPart placed;
  placed.parameter = path.parameters[i];
  placed.points = motion.rotation * (points.colwise() - centroid);
  placed.inside = path.metric->unit * centroid;
  placed.centre = motion.rotation * placed.inside + motion.translation;
  return placed;
}

// The rotation that maps centred points closest to others, accurate to rounding; if it is not
// unique, the smallest one.
Eigen::Matrix3d RotationOnto(const Shape& from, const Shape& to, const Eigen::VectorXd& weights) {
  constexpr double kPoint = 1e-10;  // size, in the metric's unit, of parts treated as points
  constexpr double kLine = 1e-10;   // (width / length)^2 of parts treated as lines
  const Eigen::Matrix3d covariance = from * weights.asDiagonal() * to.transpose();
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(covariance,
                                              Eigen::ComputeFullU | Eigen::ComputeFullV);
  const Eigen::Vector3d& sizes = svd.singularValues();
  if (sizes(0) <= kPoint * kPoint * weights.sum()) return Eigen::Matrix3d::Identity();
  if (sizes(1) <= kLine * sizes(0)) {
    return Eigen::Quaterniond::FromTwoVectors(svd.matrixU().col(0), svd.matrixV().col(0))
        .toRotationMatrix();
  }
  Eigen::Vector3d sign(1, 1, 1);
  if ((svd.matrixV() * svd.matrixU().transpose()).determinant() < 0) sign(2) = -1;
  return svd.matrixV() * sign.asDiagonal() * svd.matrixU().transpose();
}

// A rotation vector: the axis times the angle.
Eigen::Vector3d Log(const Eigen::Matrix3d& rotation) {
  const Eigen::AngleAxisd turn(rotation);
  return turn.angle() * turn.axis();
}

Eigen::Matrix3d Exp(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  if (angle == 0) return Eigen::Matrix3d::Identity();
  return Eigen::AngleAxisd(angle, turn / angle).toRotationMatrix();
}

// How fast a part moves at a pose, per unit of the path's parameter.
struct PartVelocity {
  Eigen::Vector3d centre = Eigen::Vector3d::Zero(), turn = Eigen::Vector3d::Zero();
};

// The motion of a part from one pose to the next: at constant velocity, or on cubics.
class PartMotion {
 public:
  PartMotion(const PlacedPart& first, const PlacedPart& last, const Eigen::VectorXd& weights)
      : first_(first),
        last_(last),
        length_(last.parameter - first.parameter),
        turn_(Log(RotationOnto(first.points, last.points, weights))),
        mean_{(last.centre - first.centre) / length_, turn_ / length_},
        velocities_{mean_, mean_} {}

  const PartVelocity& Mean() const { return mean_; }
  void SetVelocities(const PartVelocity& first, const PartVelocity& last) {
    velocities_ = {first, last};
  }

  // The part at a time, which may lie beyond either pose; it then goes on at constant velocity. Its
  // shape is interpolated between those in the two poses.
  PlacedPart At(double parameter) const {
    const double t = (parameter - first_.parameter) / length_;
    const double share = std::clamp(t, 0.0, 1.0), beyond = (t - share) * length_;
    const auto& [first, last] = velocities_;
    const internal::EndSlopes slopes(share);
    // What the velocities at the ends differ by from the mean velocity, in the part's own frame.
    const Eigen::Vector3d slope = length_ * (slopes.first * (first.turn - mean_.turn) +
                                             slopes.last * (Exp(-turn_) * last.turn - mean_.turn));
    const PartVelocity& end = t > 1 ? last : first;
    const Eigen::Matrix3d turned = Exp(beyond * end.turn) * Exp(share * turn_) * Exp(slope);
    PlacedPart part;
    part.points = turned * ((1 - share) * first_.points + share * (Exp(-turn_) * last_.points));
    part.centre = (1 - share) * first_.centre + share * last_.centre +
                  length_ * (slopes.first * (first.centre - mean_.centre) +
                             slopes.last * (last.centre - mean_.centre)) +
                  beyond * end.centre;
    return part;
  }

 private:
  const PlacedPart &first_, &last_;
  const double length_;
  const Eigen::Vector3d turn_;
  const PartVelocity mean_;
  std::pair<PartVelocity, PartVelocity> velocities_;  // at the two poses
};

// Shortens a velocity at a pose to three times the slower mean velocity beside it.
Eigen::Vector3d Limited(const Eigen::Vector3d& velocity, double before, double after) {
  const double most = 3 * std::min(before, after), speed = velocity.norm();
  return speed > most ? Eigen::Vector3d(most / speed * velocity) : velocity;
}

// The velocity from the part in one shape to that in another, a time `length` later.
PartVelocity Velocity(const PlacedPart& from, const PlacedPart& to, double length,
                      const Eigen::VectorXd& weights) {
  return {(to.centre - from.centre) / length,
          Log(RotationOnto(from.points, to.points, weights)) / length};
}

// The velocities at the poses are those of the path, limited.
void SetVelocities(const Path& whole, const Part& part, std::vector<PartMotion>* motions) {
  const size_t count = motions->size();
  const bool is_cycle = internal::IsCycle(whole);
  const int last_shape = whole.NumShapes() - 1;
  std::vector<PartVelocity> velocities;
  for (size_t i = 0; i <= count; ++i) {
    const int k = whole.poses[i];
    // The shapes beside the pose; in a cycle the last but one is also before the first.
    const bool wraps = is_cycle && (i == 0 || i == count);
    const int from = wraps ? whole.poses[count] - 1 : std::max(0, k - 1);
    const int to = wraps ? whole.poses[0] + 1 : std::min(last_shape, k + 1);
    const double turn_round =
        wraps ? whole.parameters[whole.poses[count]] - whole.parameters[whole.poses[0]] : 0;
    PartVelocity velocity =
        Velocity(PartOf(whole, from, part), PartOf(whole, to, part),
                 whole.parameters[to] - whole.parameters[from] + turn_round, part.weights);
    const PartVelocity& before = (*motions)[i > 0 ? i - 1 : wraps ? count - 1 : 0].Mean();
    const PartVelocity& after = (*motions)[i < count ? i : wraps ? 0 : count - 1].Mean();
    velocity.centre = Limited(velocity.centre, before.centre.norm(), after.centre.norm());
    velocity.turn = Limited(velocity.turn, before.turn.norm(), after.turn.norm());
    velocities.push_back(velocity);
  }
  for (size_t i = 0; i < count; ++i) (*motions)[i].SetVelocities(velocities[i], velocities[i + 1]);
}

// The required position of the part at a time, from its positions in the poses and the motions
// between them.
PlacedPart WantedAt(double parameter, const std::vector<PlacedPart>& poses,
                    const std::vector<PartMotion>& motions) {
  if (motions.empty()) return poses[0];
  size_t piece = 0;
  while (piece + 1 < motions.size() && parameter > poses[piece + 1].parameter) ++piece;
  return motions[piece].At(parameter);
}

void CheckVertices(const std::vector<int>& vertices, int count) {
  if (vertices.empty()) throw InvalidOptions("vertices", "at least one is needed");
  for (const int v : vertices) {
    if (v >= 0 && v < count) continue;
    throw InvalidOptions("vertices",
                         "" + std::to_string(v) + " is not in 0 .. " + std::to_string(count - 1));
  }
}

}  // namespace

void Anchor(Path* path, const std::vector<int>& vertices) { Anchor(*path, vertices, path); }

void Anchor(const Path& whole, const std::vector<int>& vertices, Path* path) {
  CheckVertices(vertices, whole.metric->connectivity->NumVertices());
  const std::vector<int> points = RepresentativesOf(*whole.metric->connectivity, vertices);
  const Part part = {points, whole.metric->vertex_area(points)};
  std::vector<int> indices = whole.poses;
  if (indices.empty()) indices = {0};
  std::vector<PlacedPart> poses;
  for (const int i : indices) poses.push_back(PartOf(whole, i, part));
  std::vector<PartMotion> motions;
  motions.reserve(poses.size());
  for (size_t k = 0; k + 1 < poses.size(); ++k) {
    motions.emplace_back(poses[k], poses[k + 1], part.weights);
  }
  if (whole.smooth && !motions.empty()) SetVelocities(whole, part, &motions);
  ParallelFor(path->NumShapes(), [&](int i) {
    if (std::binary_search(path->poses.begin(), path->poses.end(), i)) return;
    const PlacedPart now = PartOf(*path, i, part);
    const PlacedPart wanted = WantedAt(path->parameters[i], poses, motions);
    RigidMotion& motion = path->motions[i];
    motion.rotation = RotationOnto(now.points, wanted.points, part.weights) * motion.rotation;
    motion.translation = wanted.centre - motion.rotation * now.inside;
  });
}

void Ground(Path* path, int axis, double height) {
  if (axis < 0 || axis > 2) throw InvalidOptions("axis", "must be 0, 1 or 2, for x, y or z");
  if (!(std::abs(height) <= kLargestCoordinate)) {
    throw InvalidOptions("height", "must be a number of magnitude 1e60 at most");
  }
  const Connectivity& connectivity = *path->metric->connectivity;
  std::vector<bool> is_used(connectivity.NumVertices(), false);
  for (const int v : connectivity.Corners()) is_used[v] = true;
  for (const int v : connectivity.Edges().reshaped()) is_used[v] = true;
  if (std::find(is_used.begin(), is_used.end(), true) == is_used.end()) {
    throw MeshError("no vertex belongs to a polygon or an edge, so that none can be the lowest");
  }
  for (int i = 0; i < path->NumShapes(); ++i) {
    const Eigen::RowVectorXd heights = path->Placed(i).row(axis);
    double lowest = std::numeric_limits<double>::infinity();
    for (int v = 0; v < heights.size(); ++v) {
      if (is_used[v]) lowest = std::min(lowest, heights(v));
    }
    path->motions[i].translation(axis) += height - lowest;
  }
}

}  // namespace shapespace
