#include <shapespace/bodies/tube.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include <shapespace/bodies/detail/bend.h>
#include <shapespace/bodies/detail/checks.h>
#include <shapespace/bodies/detail/grid.h>
#include <shapespace/mesh/internal/geometry.h>

namespace shapespace {
namespace {

/// A joint, in units of the tube's length: it bends within `kReach` of its middle, by a share of
/// the total angle.
struct Joint {
  double middle, share;
};
constexpr Joint kJoints[] = {{0.33, 0.55}, {0.7, 0.45}};
constexpr double kReach = 0.175;
constexpr double kKnuckleReach = 0.15;

double Radius(const TubeForm& form, double s) {
  const double x = s / form.length;
  double radius = form.base_radius + (form.tip_radius - form.base_radius) * internal::SmoothStep(x);
  for (const Joint& joint : kJoints) {
    const double off = std::abs(x - joint.middle) / kKnuckleReach;
    radius += form.knuckle * (1 - internal::SmoothStep(off));
  }
  return radius;
}

/// Direction of the centre line at s when the tube is bent by `angle`, both in radians.
double Direction(const TubeForm& form, double angle, double s) {
  double direction = 0;
  for (const Joint& joint : kJoints) {
    const double begin = joint.middle - kReach;
    direction +=
        joint.share * angle * internal::SmoothStep((s / form.length - begin) / (2 * kReach));
  }
  return direction;
}

/// The bend at which every inner side keeps at least a tenth of its length, by upper bounds of the
/// curvature and the radius.
double LargestBend(const TubeForm& form) {
  const double radius = std::max(form.base_radius, form.tip_radius) + form.knuckle;
  double share = 0;
  for (const Joint& joint : kJoints) share = std::max(share, joint.share);
  return 0.9 * 2 * kReach * form.length / (internal::kSteepestStep * share * radius);
}

/// The length of the centre line in units of the local radius, cumulated over equal steps: rings at
/// equal intervals of it have triangles of the same proportions everywhere.
std::vector<double> RelativeLength(const TubeForm& form) {
  constexpr int kSteps = 4096;
  const double step = form.length / kSteps;
  std::vector<double> sum = {0};
  for (int i = 0; i < kSteps; ++i) {
    const double slope = (Radius(form, (i + 1) * step) - Radius(form, i * step)) / step;
    sum.push_back(sum.back() +
                  step * std::sqrt(1 + slope * slope) / Radius(form, (i + 0.5) * step));
  }
  return sum;
}

/// A circle of vertices about the centre line, or a pole.
struct Ring {
  double s;          // along the centre line, extended straight into the caps
  double radius;     // 0 for a pole
  double angle;      // of its first vertex, in radians from the inner side
  int first, count;  // its vertices
};

/// Rings from pole to pole. Those of the tube proper have 5 m vertices, each ring rotated by half a
/// step against the one before; those of the caps have 5, 10, 15, ... from the pole, in five equal
/// sectors.
std::vector<Ring> MakeRings(int triangles, const TubeForm& form) {
  // Equilateral triangles need rings at a distance of sqrt(3) / 2 of an edge, which relates the
  // number of steps along the tube to m; there are 10 m triangles per step and 5 m^2 in a cap.
  const std::vector<double> relative_length = RelativeLength(form);
  const double steps_per_m = relative_length.back() * 5 / (std::sqrt(3.0) * internal::kPi);
  const int m = std::max<int>(1, std::lround(std::sqrt(triangles / (10 * (1 + steps_per_m)))));
  const int steps = std::max<int>(1, std::lround(triangles / (10.0 * m) - m));

  // Latitudes in a cap (from its pole) are the mean of equal steps, which have the most even sizes,
  // and those of a stereographic projection, which have the most even angles.
  const auto latitude = [m](int j) {
    const double x = double(j) / m;
    return x * internal::kPi / 4 + std::atan(x);
  };
  std::vector<Ring> rings;
  int first = 0;
  const auto add = [&](double s, double radius, double angle, int count) {
    rings.push_back({s, radius, angle, first, count});
    first += count;
  };
  add(-form.base_radius, 0, 0, 1);
  for (int j = 1; j < m; ++j) {
    add(-form.base_radius * std::cos(latitude(j)), form.base_radius * std::sin(latitude(j)), 0,
        5 * j);
  }
  const double half_turn = internal::kPi / (5 * m);
  size_t at = 0;
  for (int k = 0; k <= steps; ++k) {
    const double wanted = relative_length.back() * k / steps;
    while (at + 2 < relative_length.size() && relative_length[at + 1] < wanted) ++at;
    const double part =
        (wanted - relative_length[at]) / (relative_length[at + 1] - relative_length[at]);
    const double s = form.length * (at + part) / (relative_length.size() - 1);
    add(s, Radius(form, s), (k % 2) * half_turn, 5 * m);
  }
  const double tip_angle = (steps % 2) * half_turn;
  for (int j = m - 1; j >= 1; --j) {
    add(form.length + form.tip_radius * std::cos(latitude(j)),
        form.tip_radius * std::sin(latitude(j)), tip_angle, 5 * j);
  }
  add(form.length + form.tip_radius, 0, tip_angle, 1);
  return rings;
}

/// The triangles between two rings, by walking around both at once, always with the step that ends
/// first. If both end at the same angle, the ring of fewer vertices goes first, which makes the
/// sectors of a cap symmetric.
void Stitch(const Ring& low, const Ring& high, internal::TriangleList* triangles) {
  const auto vertex = [](const Ring& ring, int i) { return ring.first + i % ring.count; };
  const int low_steps = low.count > 1 ? low.count : 0;
  const int high_steps = high.count > 1 ? high.count : 0;
  const bool turned_ahead = high.angle > low.angle;
  int i = 0, j = 0;
  while (i < low_steps || j < high_steps) {
    // Ends of the steps as fractions of a full turn, over a common denominator.
    const std::int64_t low_end = std::int64_t{i + 1} * high.count;
    const std::int64_t high_end = std::int64_t{j + 1} * low.count;
    const bool low_first =
        low_end == high_end ? low.count < high.count || turned_ahead : low_end < high_end;
    if (j == high_steps || (i < low_steps && low_first)) {
      triangles->emplace_back(vertex(low, i), vertex(high, j), vertex(low, i + 1));
      ++i;
    } else {
      triangles->emplace_back(vertex(low, i), vertex(high, j), vertex(high, j + 1));
      ++j;
    }
  }
}

/// The displacement along the centre line from s = begin to s = end, by Gauss quadrature with three
/// points per step; steps are so short that the error is at rounding.
Eigen::Vector3d Advance(const TubeForm& form, double angle, double begin, double end) {
  constexpr double kStepsPerLength = 500;
  const int steps = static_cast<int>(std::ceil((end - begin) / form.length * kStepsPerLength));
  const double offset = std::sqrt(0.6) / 2;
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (int i = 0; i < steps; ++i) {
    const double step = (end - begin) / steps;
    for (int point = -1; point <= 1; ++point) {
      const double s = begin + (i + 0.5 + point * offset) * step;
      const double direction = Direction(form, angle, s);
      const double weight = (point == 0 ? 8.0 : 5.0) / 18 * step;
      sum += weight * Eigen::Vector3d(std::cos(direction), 0, std::sin(direction));
    }
  }
  return sum;
}

Shape Pose(const TubeForm& form, const std::vector<Ring>& rings, double angle) {
  Shape shape(3, rings.back().first + 1);
  Eigen::Vector3d on_line = Eigen::Vector3d::Zero();
  double s = 0;
  for (const Ring& ring : rings) {
    const double next = std::clamp(ring.s, 0.0, form.length);
    on_line += Advance(form, angle, s, next);
    s = next;
    const double direction = Direction(form, angle, s);
    const Eigen::Vector3d tangent(std::cos(direction), 0, std::sin(direction));
    const Eigen::Vector3d inward(-std::sin(direction), 0, std::cos(direction));
    const Eigen::Vector3d centre = on_line + (ring.s - s) * tangent;
    for (int i = 0; i < ring.count; ++i) {
      const double around = ring.angle + 2 * internal::kPi * i / ring.count;
      shape.col(ring.first + i) =
          centre +
          ring.radius * (std::cos(around) * inward + std::sin(around) * Eigen::Vector3d::UnitY());
    }
  }
  return shape;
}

}  // namespace

void TubeForm::Validate() const {
  internal::CheckLength("length", length);
  internal::CheckLength("base_radius", base_radius);
  internal::CheckLength("tip_radius", tip_radius);
  const auto [least, most] = std::minmax({length, base_radius, tip_radius});
  // Larger ratios are useless and near the limit where cumulated lengths lose small ones.
  if (most > 1e4 * least) {
    throw InvalidOptions("length", "the length and the radii may differ by a factor of 10000");
  }
  if (!(knuckle >= 0 && knuckle <= most)) {
    throw InvalidOptions("knuckle", "must be in [0, the largest of length and radii]");
  }
}

ShapeFamily MakeTube(int triangles, const TubeForm& form) {
  form.Validate();
  internal::CheckTriangles(triangles);
  std::vector<Ring> rings = MakeRings(std::max(50, triangles), form);
  internal::TriangleList list;
  for (size_t k = 0; k + 1 < rings.size(); ++k) Stitch(rings[k], rings[k + 1], &list);

  ShapeFamily body;
  body.name = "tube";
  body.connectivity = internal::ConnectivityOf(rings.back().first + 1, list);
  body.parameter = "bend angle, degrees";
  body.end = std::min(150.0, LargestBend(form) / internal::kRadians);
  body.pose = [form, rings = std::move(rings)](double angle) {
    return Pose(form, rings, angle * internal::kRadians);
  };
  return internal::WithCheckedRange(std::move(body));
}

}  // namespace shapespace
