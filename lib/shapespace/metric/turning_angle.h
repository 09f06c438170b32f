#ifndef SHAPESPACE_METRIC_TURNING_ANGLE_H_
#define SHAPESPACE_METRIC_TURNING_ANGLE_H_

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/metric/feature.h>

namespace shapespace {

struct MetricBasis;

/// The angle by which a curve turns at a vertex, in [0, pi]: 0 if it goes straight on. It is the
/// bending of a thin rod. Curves are made of the segments of a mesh or graph. Elements are the
/// vertices at which two segments end, and no triangle; where more of them meet, none goes on as
/// another.
struct TurningAngle : ElementFeature<3, 1> {
  static constexpr int kScalarRows = 1;
  static constexpr const char* kName = "turning angle";

  /// The square of a length far below those of the mesh, which keeps the angle at a collapsed
  /// segment finite.
  double epsilon_squared = 0;

  static TurningAngle Freeze(const MetricBasis& basis);

  template <typename Self, typename Visit>
  static void ForConstants(Self* self, const Visit& visit) {
    visit("epsilon_squared", self->epsilon_squared);
  }

  template <typename T>
  void operator()(const T* x, T* value) const {
    using std::atan2;
    using std::sqrt;
    // A straight curve turns by so much, in radians: the angle itself has no derivative there.
    constexpr double kStraight = 1e-6;
    using Vector = Eigen::Matrix<T, 3, 1>;
    const Eigen::Map<const Vector> a(x), b(x + 3), c(x + 6);
    const Vector to = b - a, on = c - b;
    const T squares = (to.squaredNorm() + epsilon_squared) * (on.squaredNorm() + epsilon_squared);
    value[0] =
        atan2(sqrt(to.cross(on).squaredNorm() + kStraight * kStraight * squares), to.dot(on));
  }

  /// The derivative across a curve that is nearly straight: 1 / length of the two segments for
  /// their far ends, and the opposite for the vertex between them.
  void ScalarRows(const Eigen::Vector3d* x, double* k) const {
    // Collapsed segments would make the matrix numerically indefinite.
    const double least = 1e8 * epsilon_squared;
    k[0] = 1 / std::sqrt(std::max((x[1] - x[0]).squaredNorm(), least));
    k[2] = 1 / std::sqrt(std::max((x[2] - x[1]).squaredNorm(), least));
    k[1] = -k[0] - k[2];
  }
};

/// The vertices at which a curve turns: 3 x k, each between its two neighbours on the curve.
Eigen::Matrix3Xi Turns(const Connectivity& connectivity);

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_TURNING_ANGLE_H_
