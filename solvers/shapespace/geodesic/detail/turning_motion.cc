#include <shapespace/geodesic/detail/turning_motion.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/mesh/internal/triangle_deformation.h>
#include <shapespace/metric/dihedral.h>

namespace shapespace::internal {
namespace {

// Angles of poses that are read from files with six decimals are known to about a tenth of this.
constexpr double kEqualWays = 1e-3;

// Axes of parts whose cosine is at least this count as nearly the same.
constexpr double kSameAxis = 0.5;

// Triangles that are thinner than this have no rotation of their own: area over squared side.
constexpr double kFlattened = 1e-6;

// Two neighbouring triangles, with the corners of their hinge.
struct TurningHinge {
  std::array<int, 2> triangles;
  Eigen::Vector4i corners;
};

double HingeAngle(const Eigen::Vector4i& corners, const Shape& shape) {
  double x[12];
  for (int k = 0; k < 4; ++k) Eigen::Map<Eigen::Vector3d>(x + 3 * k) = shape.col(corners(k));
  return Dihedral().Angle(x);
}

bool IsFold(const Eigen::Vector4i& corners, const Shape& first, const Shape& last) {
  const double turn = HingeAngle(corners, last) - HingeAngle(corners, first);
  return std::abs(WrapAngle(turn)) > kPi - kEqualWays;
}

// The triangle that has these corners in its orientation, beginning anywhere. It is looked for at
// the corner with the fewest triangles: others may have thousands.
int FindTriangle(const Connectivity& connectivity, int a, int b, int c) {
  const IndexLists& around = connectivity.TrianglesOfVertices();
  int corner = a;
  for (const int other : {b, c}) {
    if (around[other].size() < around[corner].size()) corner = other;
  }
  for (const int f : around[corner]) {
    const Eigen::Vector3i t = connectivity.Triangles().col(f);
    for (int k = 0; k < 3; ++k) {
      if (t(k) == a && t((k + 1) % 3) == b && t((k + 2) % 3) == c) return f;
    }
  }
  return -1;
}

TriangleFrame FrameOf(const Shape& shape, const Eigen::Vector3i& t) {
  return {shape.col(t(0)), shape.col(t(1)), shape.col(t(2))};
}

bool IsFlattened(const TriangleFrame& frame) {
  const double longest =
      std::max(frame.edges.col(0).squaredNorm(), frame.edges.col(1).squaredNorm());
  return !(frame.edges.determinant() > kFlattened * longest);
}

// The same rotation as `turn`, by a full turn more or less.
Eigen::Vector3d OtherWayRound(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  return angle > 0 ? (1 - 2 * kPi / angle) * turn : turn;
}

Eigen::Vector3d NearestWay(const Eigen::Vector3d& turn, const Eigen::Vector3d& to) {
  const Eigen::Vector3d other = OtherWayRound(turn);
  return (other - to).squaredNorm() < (turn - to).squaredNorm() ? other : turn;
}

// Whether two rotations differ by less than 90 degrees.
bool TurnTogether(const Eigen::Quaterniond& a, const Eigen::Quaterniond& b) {
  return (a.conjugate() * b).vec().squaredNorm() < 0.5;
}

// Finds the turns of all triangles.
class WaysRound {
 public:
  WaysRound(const Connectivity& connectivity, const Shape& first, const Shape& last);

  Turns Decide();

 private:
  // Triangles that turn together, each but the first after the one by which it was found.
  struct Part {
    std::vector<int> triangles, found_by;
    double area = 0;
    bool decided = true;
    Eigen::Vector3d axis = Eigen::Vector3d::Zero();  // once decided, of those that were not
  };

  void FindRotations(const Shape& last);
  void FindNeighbours();
  void FindParts();
  void AddPart(int seed);
  Eigen::Quaterniond MeanRotation(const Part& part) const;
  Eigen::Quaterniond RotationOfMost() const;
  void TakeShorterWay(int part);
  void Decide(const TurningHinge& fold, int side);
  bool GoesOtherWayRound(const TurningHinge& fold, int side) const;
  Eigen::Vector2d HalfAngle(const TurningHinge& fold) const;
  void TurnOtherWayRound(int part);
  int PartOf(const TurningHinge& fold, int side) const { return part_of_[fold.triangles[side]]; }
  double Area(int f) const { return TriangleArea(first_, connectivity_.Triangles().col(f)); }

  const Connectivity& connectivity_;
  const Shape& first_;
  std::vector<TurningHinge> joints_, folds_;  // all hinges, and those that turn by 180 degrees
  std::vector<Eigen::Quaterniond> rotations_;
  std::vector<char> flattened_;
  std::vector<std::vector<int>> neighbours_;  // that turn with a triangle
  std::vector<int> part_of_;                  // of triangles
  std::vector<Part> parts_;
  Turns turns_;
};

WaysRound::WaysRound(const Connectivity& connectivity, const Shape& first, const Shape& last)
    : connectivity_(connectivity), first_(first) {
  for (const auto& corners : connectivity.Hinges().colwise()) {
    const TurningHinge joint = {{FindTriangle(connectivity, corners(0), corners(1), corners(2)),
                                 FindTriangle(connectivity, corners(1), corners(0), corners(3))},
                                corners};
    joints_.push_back(joint);
    if (IsFold(corners, first, last)) folds_.push_back(joint);
  }
  FindRotations(last);
  FindNeighbours();
  FindParts();
}

Turns WaysRound::Decide() {
  turns_.whole = RotationOfMost();
  turns_.of_triangles = Eigen::Matrix3Xd::Zero(3, connectivity_.NumTriangles());
  for (size_t i = 0; i < parts_.size(); ++i) TakeShorterWay(static_cast<int>(i));

  const auto is_decided = [&](const TurningHinge& fold, int side) {
    return parts_[PartOf(fold, side)].decided;
  };
  while (true) {
    const TurningHinge* next = nullptr;
    int side = 0;
    for (const TurningHinge& fold : folds_) {
      const bool of_first = is_decided(fold, 0), of_second = is_decided(fold, 1);
      if (of_first && of_second) continue;
      const bool beside = of_first || of_second;
      if (next == nullptr || beside) {
        next = &fold;
        side = of_first ? 1 : 0;
      }
      if (beside) break;
    }
    if (next == nullptr) return std::move(turns_);
    Decide(*next, side);
  }
}

void WaysRound::FindRotations(const Shape& last) {
  const Eigen::Matrix3Xi& triangles = connectivity_.Triangles();
  const int count = connectivity_.NumTriangles();
  rotations_.assign(count, Eigen::Quaterniond::Identity());
  flattened_.assign(count, 0);
  for (int f = 0; f < count; ++f) {
    const TriangleFrame before = FrameOf(first_, triangles.col(f));
    const TriangleFrame after = FrameOf(last, triangles.col(f));
    flattened_[f] = IsFlattened(before) || IsFlattened(after);
    if (flattened_[f]) continue;
    const TriangleDeformation pose(after, before.edges.inverse());
    rotations_[f] = pose.rotation * Eigen::Quaterniond(before.axes).conjugate();
  }
}

// Triangles without a rotation of their own turn with any.
void WaysRound::FindNeighbours() {
  neighbours_.resize(connectivity_.NumTriangles());
  for (const TurningHinge& joint : joints_) {
    const auto [f, g] = joint.triangles;
    if (!flattened_[f] && !flattened_[g] && !TurnTogether(rotations_[f], rotations_[g])) continue;
    neighbours_[f].push_back(g);
    neighbours_[g].push_back(f);
  }
}

void WaysRound::FindParts() {
  part_of_.assign(connectivity_.NumTriangles(), -1);
  for (const bool flattened : {false, true}) {
    for (int f = 0; f < connectivity_.NumTriangles(); ++f) {
      if (part_of_[f] < 0 && (flattened_[f] != 0) == flattened) AddPart(f);
    }
  }
}

void WaysRound::AddPart(int seed) {
  const int index = static_cast<int>(parts_.size());
  Part part;
  part.triangles = part.found_by = {seed};
  part_of_[seed] = index;
  for (size_t i = 0; i < part.triangles.size(); ++i) {
    const int f = part.triangles[i];
    part.area += Area(f);
    for (const int g : neighbours_[f]) {
      if (part_of_[g] >= 0) continue;
      part_of_[g] = index;
      part.triangles.push_back(g);
      part.found_by.push_back(f);
      if (flattened_[g]) rotations_[g] = rotations_[f];
    }
  }
  parts_.push_back(std::move(part));
}

Eigen::Quaterniond WaysRound::MeanRotation(const Part& part) const {
  Eigen::Vector4d sum = Eigen::Vector4d::Zero();
  for (const int f : part.triangles) {
    const Eigen::Vector4d& q = rotations_[f].coeffs();
    sum += (q.dot(rotations_[part.triangles[0]].coeffs()) < 0 ? -Area(f) : Area(f)) * q;
  }
  return sum.norm() > 0 ? Eigen::Quaterniond(sum.normalized()) : Eigen::Quaterniond::Identity();
}

// The rotation of a part with which most of the surface turns, to less than 90 degrees; of equal
// ones the first. Parts of less than a hundredth of the surface do not count.
Eigen::Quaterniond WaysRound::RotationOfMost() const {
  constexpr double kLeastShare = 0.01;
  std::vector<Eigen::Quaterniond> rotations;
  double whole = 0;
  for (const Part& part : parts_) {
    rotations.push_back(MeanRotation(part));
    whole += part.area;
  }
  Eigen::Quaterniond result = Eigen::Quaterniond::Identity();
  double most = 0;
  for (size_t k = 0; k < parts_.size(); ++k) {
    if (parts_[k].area < kLeastShare * whole) continue;
    double area = 0;
    for (size_t i = 0; i < parts_.size(); ++i) {
      if (TurnTogether(rotations[k], rotations[i])) area += parts_[i].area;
    }
    if (area > (1 + kEqualWays) * most) {
      most = area;
      result = rotations[k];
    }
  }
  return result;
}

// Finds the turns of a part's triangles, each by the way round that is nearest to its neighbour's,
// all together by the shorter way.
void WaysRound::TakeShorterWay(int index) {
  Part& part = parts_[index];
  double way = 0, other_way = 0;
  for (size_t i = 0; i < part.triangles.size(); ++i) {
    const int f = part.triangles[i];
    const Eigen::Vector3d turn = Log(turns_.whole.conjugate() * rotations_[f]);
    turns_.of_triangles.col(f) =
        i == 0 ? turn : NearestWay(turn, turns_.of_triangles.col(part.found_by[i]));
    const double angle = turns_.of_triangles.col(f).norm();
    way += Area(f) * angle * angle;
    other_way += Area(f) * std::pow(2 * kPi - angle, 2);
  }
  part.decided = std::abs(way - other_way) > kEqualWays * way;
  if (other_way < way) TurnOtherWayRound(index);
}

// Decides the part at `side` of a fold.
void WaysRound::Decide(const TurningHinge& fold, int side) {
  const int index = PartOf(fold, side);
  Part& part = parts_[index];
  for (const int f : part.triangles) part.axis += Area(f) * turns_.of_triangles.col(f);
  part.axis.normalize();
  if (GoesOtherWayRound(fold, side)) TurnOtherWayRound(index);
  part.decided = true;
}

bool WaysRound::GoesOtherWayRound(const TurningHinge& fold, int side) const {
  const bool beside = parts_[PartOf(fold, 1 - side)].decided;
  const Eigen::Vector2d half = beside ? HalfAngle(fold) : Eigen::Vector2d::Zero();
  if (std::abs(half(0)) > kEqualWays) return half(0) < 0;
  const Part& part = parts_[PartOf(fold, side)];
  double cosine = 0;
  for (const Part& other : parts_) {
    if (!other.decided) continue;
    const double to_other = part.axis.dot(other.axis);
    if (std::abs(to_other) > std::abs(cosine) + kEqualWays) cosine = to_other;
  }
  if (std::abs(cosine) > kSameAxis) return cosine < 0;
  if (std::abs(half(1)) > kEqualWays) return half(1) > 0;
  // A part that turns in its plane, or the first of a body of which all parts turn by 180 degrees.
  const int f = fold.triangles[side];
  const Eigen::Vector3d turn = turns_.of_triangles.col(f);
  const Eigen::Vector3d normal = UnitNormal(first_, connectivity_.Triangles().col(f));
  const Eigen::Vector3d along =
      (first_.col(fold.corners(1)) - first_.col(fold.corners(0))).normalized();
  for (const Eigen::Vector3d& direction : {normal, along}) {
    const double component = turn.dot(direction);
    if (std::abs(component) > kEqualWays) return component < 0;
  }
  return turn.dot(normal.cross(along)) < 0;
}

// The cosine and the sine of the hinge's angle when both triangles have made half of their turns.
Eigen::Vector2d WaysRound::HalfAngle(const TurningHinge& fold) const {
  Eigen::Vector3d normals[2], edge = Eigen::Vector3d::Zero();
  for (int k = 0; k < 2; ++k) {
    const int f = fold.triangles[k];
    const Eigen::Quaterniond half = Exp(Eigen::Vector3d(0.5 * turns_.of_triangles.col(f)));
    normals[k] = half * UnitNormal(first_, connectivity_.Triangles().col(f));
    edge += half * (first_.col(fold.corners(1)) - first_.col(fold.corners(0)));
  }
  return {normals[0].dot(normals[1]), normals[0].cross(normals[1]).dot(edge.stableNormalized())};
}

void WaysRound::TurnOtherWayRound(int part) {
  for (const int f : parts_[part].triangles) {
    turns_.of_triangles.col(f) = OtherWayRound(turns_.of_triangles.col(f));
  }
  parts_[part].axis = -parts_[part].axis;
}

}  // namespace

bool HasFolds(const Connectivity& connectivity, const Shape& first, const Shape& last) {
  for (const auto& corners : connectivity.Hinges().colwise()) {
    if (IsFold(corners, first, last)) return true;
  }
  return false;
}

Turns FindTurns(const Connectivity& connectivity, const Shape& first, const Shape& last) {
  return WaysRound(connectivity, first, last).Decide();
}

TurningMotion::TurningMotion(const Connectivity& connectivity, const Shape& first,
                             const Shape& last)
    : connectivity_(connectivity),
      turns_(FindTurns(connectivity, first, last)),
      first_(first),
      last_(turns_.whole.conjugate().toRotationMatrix() * last),
      integrator_(connectivity, Eigen::Matrix3Xd::Ones(3, connectivity.NumTriangles())) {}

Shape TurningMotion::At(double t) const {
  const auto turn = [&](int f, double share) {
    return Exp(Eigen::Vector3d(share * turns_.of_triangles.col(f)));
  };
  // Between the sides of both poses as they would be in the first pose's orientation, turned.
  const auto sides = [&](int f) -> Eigen::Matrix3d {
    const Eigen::Vector3i corners = connectivity_.Triangles().col(f);
    const Eigen::Matrix3d before = TriangleSides(first_, corners);
    Eigen::Matrix3d sides = TriangleSides(last_, corners);
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d after = turn(f, -1) * sides.col(k);
      sides.col(k) = turn(f, t) * ((1 - t) * before.col(k) + t * after);
    }
    return sides;
  };
  const Shape shape = integrator_.Integrate(first_, (1 - t) * first_ + t * last_, sides,
                                            [&](int f) { return turn(f, t).toRotationMatrix(); });
  return Exp(Eigen::Vector3d(t * Log(turns_.whole))).toRotationMatrix() * shape;
}

}  // namespace shapespace::internal
