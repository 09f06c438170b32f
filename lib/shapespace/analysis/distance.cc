#include <shapespace/analysis/distance.h>

#include <algorithm>
#include <utility>

#include <Eigen/Geometry>

#include <shapespace/mesh/internal/nearest_on_triangle.h>

namespace shapespace {
namespace {

using Eigen::Vector3d;
using internal::NearestOnSegment;
using internal::NearestOnTriangle;

// C. Ericson, Real-Time Collision Detection (2005), section 5.1.9: the parts of the ways along two segments at which they are nearest.
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
