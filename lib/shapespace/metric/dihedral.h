#ifndef SHAPESPACE_METRIC_DIHEDRAL_H_
#define SHAPESPACE_METRIC_DIHEDRAL_H_

#include <algorithm>
#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <shapespace/metric/feature.h>

namespace shapespace {

struct MetricBasis;

/// The angle difference b - a as a number in [-pi, pi].
inline double WrapAngle(double angle) {
  return std::abs(angle) <= M_PI ? angle : std::remainder(angle, 2 * M_PI);
}

/// (cos theta, sin theta) of a hinge (Connectivity::Hinges): the bending of a thin shell. theta is
/// the angle between the two normals, 0 if flat, positive if convex. The chord between two such
/// points needs no wrapping, is bounded, and gives the same Riemannian metric as theta itself.
struct Dihedral : ElementFeature<4, 2> {
  static constexpr bool kHasDerivatives = true;
  static constexpr int kScalarRows = 1;
  static constexpr const char* kName = "dihedral";

  /// Squares of lengths far below those of the mesh, which keep the normal of a collapsed triangle
  /// and the direction of a collapsed edge finite.
  double normal_epsilon_squared = 0, edge_epsilon_squared = 0;

  static Dihedral Freeze(const MetricBasis& basis);

  template <typename Self, typename Visit>
  static void ForConstants(Self* self, const Visit& visit) {
    visit("normal_epsilon_squared", self->normal_epsilon_squared);
    visit("edge_epsilon_squared", self->edge_epsilon_squared);
  }

  template <typename T>
  void operator()(const T* x, T* value) const {
    using std::sqrt;
    using Vector = Eigen::Matrix<T, 3, 1>;
    const Eigen::Map<const Vector> a(x), b(x + 3), c(x + 6), d(x + 9);
    const Vector e = b - a;
    const Vector n1 = e.cross(c - a);
    const Vector n2 = (d - a).cross(e);
    const Vector m1 = n1 / sqrt(n1.squaredNorm() + normal_epsilon_squared);
    const Vector m2 = n2 / sqrt(n2.squaredNorm() + normal_epsilon_squared);
    value[0] = m1.dot(m2);
    value[1] = m1.cross(m2).dot(e) / sqrt(e.squaredNorm() + edge_epsilon_squared);
  }

  void Derivatives(const double* x, double* value, double* derivative) const {
    using Vector = Eigen::Vector3d;
    const Eigen::Map<const Vector> a(x), b(x + 3), c(x + 6), d(x + 9);
    const Vector e = b - a, to_c = c - a, to_d = d - a;
    const Vector n1 = e.cross(to_c), n2 = to_d.cross(e);
    const double inverse1 = 1 / std::sqrt(n1.squaredNorm() + normal_epsilon_squared);
    const double inverse2 = 1 / std::sqrt(n2.squaredNorm() + normal_epsilon_squared);
    const double inverse = 1 / std::sqrt(e.squaredNorm() + edge_epsilon_squared);
    const Vector m1 = inverse1 * n1, m2 = inverse2 * n2, direction = inverse * e;
    const Vector normals = m1.cross(m2);
    value[0] = m1.dot(m2);
    value[1] = normals.dot(direction);
    // The gradients in m1, m2 and the direction, then in n1, n2 and e, then in the vertices.
    const Vector by_m1[2] = {m2, m2.cross(direction)}, by_m2[2] = {m1, direction.cross(m1)};
    for (int k = 0; k < 2; ++k) {
      const Vector by_n1 = inverse1 * (by_m1[k] - by_m1[k].dot(m1) * m1);
      const Vector by_n2 = inverse2 * (by_m2[k] - by_m2[k].dot(m2) * m2);
      Vector by_b = to_c.cross(by_n1) + by_n2.cross(to_d);
      if (k == 1) by_b += inverse * (normals - value[1] * direction);
      const Vector by_c = by_n1.cross(e), by_d = e.cross(by_n2);
      Eigen::Map<Vector>(derivative + 3 * k) = -by_b - by_c - by_d;
      Eigen::Map<Vector>(derivative + 6 + 3 * k) = by_b;
      Eigen::Map<Vector>(derivative + 12 + 3 * k) = by_c;
      Eigen::Map<Vector>(derivative + 18 + 3 * k) = by_d;
    }
  }

  /// theta in (-pi, pi] of a hinge's four vertices.
  double Angle(const double* x) const {
    double value[2];
    (*this)(x, value);
    return std::atan2(value[1], value[0]);
  }

  /// On the unit circle the shortest path of `segments` chords has equal angles. Collapsed
  /// triangles have values inside the circle, for which the shortest path is straight.
  double LeastChange(const double* a, const double* b, int segments) const {
    const auto on_circle = [](const double* z) { return z[0] * z[0] + z[1] * z[1] > 1 - 1e-6; };
    if (segments == 1 || !on_circle(a) || !on_circle(b)) {
      return ((b[0] - a[0]) * (b[0] - a[0]) + (b[1] - a[1]) * (b[1] - a[1])) / segments;
    }
    const double angle = WrapAngle(std::atan2(b[1], b[0]) - std::atan2(a[1], a[0]));
    const double chord = 2 * std::sin(std::abs(angle) / (2 * segments));
    return segments * chord * chord;
  }

  /// The derivative of theta along the normal, by vertex, for a nearly flat hinge: 1 / height for
  /// the two opposite vertices, distributed over the edge's ends with opposite sign.
  void ScalarRows(const Eigen::Vector3d* x, double* k) const {
    const Eigen::Vector3d e = x[1] - x[0];
    const double squared_length = e.squaredNorm() + edge_epsilon_squared;
    k[0] = k[1] = 0;
    for (int tip = 2; tip < 4; ++tip) {
      const Eigen::Vector3d side = x[tip] - x[0];
      const double along = side.dot(e) / squared_length;
      const double height =
          std::sqrt(std::max(e.cross(side).squaredNorm() / squared_length, edge_epsilon_squared));
      k[tip] = 1 / height;
      k[0] -= (1 - along) / height;
      k[1] -= along / height;
    }
  }
};

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_DIHEDRAL_H_
