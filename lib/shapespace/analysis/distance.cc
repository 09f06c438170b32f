#include <shapespace/analysis/distance.h>

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

namespace shapespace {
namespace {

using Eigen::Vector3d;

// The part of the way from a to b at which their segment is nearest to the origin.
double NearestOnSegment(const Vector3d& a, const Vector3d& b) {
  const Vector3d side = b - a;
  const double squared = side.squaredNorm();
  return squared > 0 ? std::clamp(-a.dot(side) / squared, 0.0, 1.0) : 0;
}

// C. Ericson, Real-Time Collision Detection (2005), section 5.1.5: the point of the triangle that
// is nearest to the origin, by its barycentric coordinates.
Vector3d NearestOnTriangle(const Vector3d& a, const Vector3d& b, const Vector3d& c) {
  const Vector3d ab = b - a, ac = c - a;
  const double d1 = -ab.dot(a), d2 = -ac.dot(a);
  const double d3 = -ab.dot(b), d4 = -ac.dot(b);
  const double d5 = -ab.dot(c), d6 = -ac.dot(c);
  const double va = d3 * d6 - d5 * d4, vb = d5 * d2 - d1 * d6, vc = d1 * d4 - d3 * d2;
  if (va > 0 && vb > 0 && vc > 0) return Vector3d(va, vb, vc) / (va + vb + vc);
  // The nearest point is on a side.
  const double on_ab = NearestOnSegment(a, b), on_bc = NearestOnSegment(b, c),
               on_ca = NearestOnSegment(c, a);
  const double from_ab = (a + on_ab * ab).squaredNorm(),
               from_bc = (b + on_bc * (c - b)).squaredNorm(),
               from_ca = (c - on_ca * ac).squaredNorm();
  if (from_ab <= from_bc && from_ab <= from_ca) return {1 - on_ab, on_ab, 0};
  if (from_bc <= from_ca) return {0, 1 - on_bc, on_bc};
  return {on_ca, 0, 1 - on_ca};
}

// Ericson, section 5.1.9: the parts of the ways along two segments at which they are nearest.
std::pair<double, double> NearestOnSegments(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                                            const Vector3d& d) {
  const Vector3d u = b - a, v = d - c, r = a - c;
  const double uu = u.squaredNorm(), vv = v.squaredNorm(), uv = u.dot(v), ur = u.dot(r),
               vr = v.dot(r);
  if (!(uu > 0)) return {0, NearestOnSegment(c - a, d - a)};
  if (!(vv > 0)) return {NearestOnSegment(a - c, b - c), 0};
  const double determinant = uu * vv - uv * uv;
  double s = determinant > 0 ? std::clamp((uv * vr - ur * vv) / determinant, 0.0, 1.0) : 0;
  double t = (uv * s + vr) / vv;
  if (t < 0) {
    t = 0;
    s = std::clamp(-ur / uu, 0.0, 1.0);
  } else if (t > 1) {
    t = 1;
    s = std::clamp((uv - ur) / uu, 0.0, 1.0);
  }
  return {s, t};
}

}  // namespace

Separation NearestPoints(PairKind kind, const FourPoints& points) {
  Separation result;
  if (kind == PairKind::kVertexTriangle) {
    const Vector3d vertex = points.col(0);
    const Vector3d weights =
        NearestOnTriangle(points.col(1) - vertex, points.col(2) - vertex, points.col(3) - vertex);
    result.coefficients << 1, -weights;
  } else {
    const auto [s, t] =
        NearestOnSegments(points.col(0), points.col(1), points.col(2), points.col(3));
    result.coefficients << 1 - s, s, t - 1, -t;
  }
  result.difference = points * result.coefficients;
  return result;
}

double RelativeSpeed(PairKind kind, FourPoints velocities) {
  // A common velocity does not change distances.
  const Vector3d mean = velocities.rowwise().mean();
  velocities.colwise() -= mean;
  const Eigen::Vector4d speeds = velocities.colwise().norm().transpose();
  const int first = FirstElementSize(kind);
  return speeds.head(first).maxCoeff() + speeds.tail(4 - first).maxCoeff();
}

double SafeStep(PairKind kind, const FourPoints& points, const FourPoints& velocities, double kept,
                double enough) {
  const double speed = RelativeSpeed(kind, velocities);
  if (!(speed > 0)) return 1;
  double distance = NearestPoints(kind, points).Distance();
  const double least = std::min(kept * distance, enough);
  // Near enough to the least distance to stop, as a share of it.
  constexpr double kNear = 0.1;
  // Elements that slide along each other at a distance that is small beside their way, or that is
  // rounding, do so in steps that are as small.
  constexpr int kMostSteps = 1000;
  double time = 0;
  for (int i = 0; i < kMostSteps; ++i) {
    time += (distance - least) / speed;
    if (time >= 1) return 1;
    distance = NearestPoints(kind, points + time * velocities).Distance();
    if (distance - least <= kNear * least) break;
  }
  return time;
}

}  // namespace shapespace
