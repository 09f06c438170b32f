#ifndef SHAPESPACE_METRIC_TRIANGLE_STRAIN_H_
#define SHAPESPACE_METRIC_TRIANGLE_STRAIN_H_

#include <array>
#include <cmath>

#include <Eigen/Core>

#include <shapespace/metric/feature.h>

namespace shapespace {

struct MetricBasis;

/// The logarithmic (Hencky) strain of a triangle relative to one at rest. With the first
/// fundamental form g in the basis (q - p, r - p), the edges of the equilateral triangle of side 1
/// as the columns of E, R the map without rotation from the triangle at rest to an equilateral
/// triangle of the same area, in that basis, C = E^-T R^T g R E^-1 and L = (1/2) log C, the values
/// are
///   ( tr L / 2, (L11 - L22) / (2 sqrt 2), L12 / sqrt 2 ),
/// whose sum of squares is the mean of (n^T L n)^2 over all directions n. For small strains of
/// nearly equilateral triangles this agrees with `EdgeLength` and `LogLength`. Any three numbers
/// are the values of some triangle, so that geodesics under this feature can be continued without
/// limit (docs/mathematics.md, section 1).
///
/// The triangle at rest has the mean of the poses' first fundamental forms. Then the strains of two
/// poses have the same principal directions, and their distance is that of the affine-invariant
/// metric of symmetric positive matrices, which no choice of a triangle at rest changes.
struct TriangleStrain : ElementFeature<3, 3, 4> {
  static constexpr bool kHasDerivatives = true;
  static constexpr const char* kName = "triangle strain";
  /// Below this square of the eigenvalues' ratio the logarithm is replaced by its series.
  static constexpr double kSmallRatio = 1e-4;

  /// The square of a length far below those of the mesh, added to both eigenvalues of C to keep the
  /// logarithm of a collapsed triangle finite.
  double epsilon_squared = 0;

  /// Weights are areas, less for triangles that nearly collapse, or the reverse, from one pose to
  /// the next. Numbers are R, which takes the basis (q - p, r - p) to
  ///   ( x[9] (q - p) + x[10] (r - p), x[11] (q - p) + x[12] (r - p) ).
  /// A triangle that has collapsed in all poses has R = I.
  static TriangleStrain Freeze(const MetricBasis& basis);

  /// R = I: strain relative to the equilateral triangle.
  static Eigen::Vector4d UsualNumbers() { return {1, 0, 0, 1}; }

  template <typename Self, typename Visit>
  static void ForConstants(Self* self, const Visit& visit) {
    visit("epsilon_squared", self->epsilon_squared);
  }

  template <typename T>
  void operator()(const T* x, T* value) const {
    using std::log;
    using std::sqrt;
    const T ux = x[3] - x[0], uy = x[4] - x[1], uz = x[5] - x[2];
    const T vx = x[6] - x[0], vy = x[7] - x[1], vz = x[8] - x[2];
    const T ax = x[9] * ux + x[10] * vx, ay = x[9] * uy + x[10] * vy, az = x[9] * uz + x[10] * vz;
    const T bx = x[11] * ux + x[12] * vx, by = x[11] * uy + x[12] * vy,
            bz = x[11] * uz + x[12] * vz;
    const T aa = ax * ax + ay * ay + az * az, ab = ax * bx + ay * by + az * bz,
            bb = bx * bx + by * by + bz * bz;
    const T nx = ay * bz - az * by, ny = az * bx - ax * bz, nz = ax * by - ay * bx;
    // C = mean I + (d, o; o, -d).
    const T mean = (2.0 * (aa + bb - ab)) / 3.0;
    const T d = (aa + 2.0 * (ab - bb)) / 3.0;
    const T o = (2.0 * ab - aa) / std::sqrt(3.0);
    const T m = mean + epsilon_squared;
    const T determinant = (4.0 / 3.0) * (nx * nx + ny * ny + nz * nz) +
                          (2.0 * mean + epsilon_squared) * epsilon_squared;
    const T squared = d * d + o * o;
    const T ratio_squared = squared / (m * m);  // of the eigenvalues; less than 1
    T factor;                                   // atanh(ratio) / ratio
    if (ratio_squared < T(kSmallRatio)) {
      factor =
          1.0 + ratio_squared * (1.0 / 3.0 + ratio_squared * (0.2 + ratio_squared * (1.0 / 7.0)));
    } else {
      const T length = sqrt(squared);
      factor = m / length * log((m + length) / sqrt(determinant));
    }
    const T slope = factor / (2.0 * std::sqrt(2.0) * m);
    value[0] = 0.25 * log(determinant);
    value[1] = slope * d;
    value[2] = slope * o;
  }

  void Derivatives(const double* x, double* value, double* derivative) const {
    using Vector = Eigen::Vector3d;
    (*this)(x, value);
    const Eigen::Map<const Vector> p(x), q(x + 3), r(x + 6);
    const Vector a = x[9] * (q - p) + x[10] * (r - p), b = x[11] * (q - p) + x[12] * (r - p);
    const Vector n = a.cross(b);
    // The quantities of `operator()`, and their gradients in (aa, ab, bb).
    const double aa = a.squaredNorm(), ab = a.dot(b), bb = b.squaredNorm();
    const double mean = 2.0 / 3.0 * (aa + bb - ab), m = mean + epsilon_squared;
    const double d = (aa + 2.0 * (ab - bb)) / 3.0, o = (2.0 * ab - aa) / std::sqrt(3.0);
    const Vector of_m = Vector(2, -2, 2) / 3.0, of_d = Vector(1, 2, -2) / 3.0,
                 of_o = Vector(-1, 2, 0) / std::sqrt(3.0);
    const double determinant =
        4.0 / 3.0 * n.squaredNorm() + (2.0 * mean + epsilon_squared) * epsilon_squared;
    const double squared = d * d + o * o, ratio_squared = squared / (m * m);
    const Vector half_of_squared = d * of_d + o * of_o;
    // `factor`, and its gradient in (aa, ab, bb) and, through the determinant, in nn = |n|^2.
    double factor, factor_by_determinant = 0;
    Vector of_factor;
    if (ratio_squared < kSmallRatio) {
      const double s = ratio_squared;
      factor = 1.0 + s * (1.0 / 3.0 + s * (0.2 + s * (1.0 / 7.0)));
      of_factor = (1.0 / 3.0 + s * (0.4 + s * (3.0 / 7.0))) * 2.0 / (m * m) *
                  (half_of_squared - squared / m * of_m);
    } else {
      const double length = std::sqrt(squared), outer = m / (length * (m + length));
      factor = m / length * std::log((m + length) / std::sqrt(determinant));
      factor_by_determinant = -0.5 * m / (length * determinant);
      of_factor = (factor / m + outer) * of_m +
                  (outer - factor / length) / length * half_of_squared +
                  2.0 * epsilon_squared * factor_by_determinant * of_m;
    }
    const double scale = 1 / (2.0 * std::sqrt(2.0) * m), slope = scale * factor;
    const Vector of_slope = scale * (of_factor - factor / m * of_m);
    const double slope_by_nn = 4.0 / 3.0 * scale * factor_by_determinant;
    const Vector nn_by_a = 2 * b.cross(n), nn_by_b = 2 * n.cross(a);
    const double log_by_determinant = 0.25 / determinant;
    const Vector by_squares[3] = {2.0 * epsilon_squared * log_by_determinant * of_m,
                                  d * of_slope + slope * of_d, o * of_slope + slope * of_o};
    const double by_nn[3] = {4.0 / 3.0 * log_by_determinant, d * slope_by_nn, o * slope_by_nn};
    for (int k = 0; k < 3; ++k) {
      const Vector& g = by_squares[k];
      const Vector by_a = 2 * g(0) * a + g(1) * b + by_nn[k] * nn_by_a;
      const Vector by_b = g(1) * a + 2 * g(2) * b + by_nn[k] * nn_by_b;
      const Vector by_q = x[9] * by_a + x[11] * by_b, by_r = x[10] * by_a + x[12] * by_b;
      Eigen::Map<Vector>(derivative + 3 * k) = -by_q - by_r;
      Eigen::Map<Vector>(derivative + 9 + 3 * k) = by_q;
      Eigen::Map<Vector>(derivative + 18 + 3 * k) = by_r;
    }
  }

  /// The inverse of `operator()` for an element with numbers R: the squares of the sides opposite
  /// to the first, second and third corner of the triangle that has these values.
  std::array<double, 3> SquaredSides(const double* value, const double* R) const {
    const double d = std::sqrt(2.0) * value[1], o = std::sqrt(2.0) * value[2];
    const double r = std::hypot(d, o);
    const double scale = std::exp(2 * value[0]);
    const double mean = scale * std::cosh(2 * r);
    const double slope = r > 0 ? scale * std::sinh(2 * r) / r : 0;
    const double along = mean - epsilon_squared - 0.5 * slope * d;
    const double across = std::sqrt(0.75) * slope * o;
    // Of the triangle with the edges a and b that `operator()` computes, hence of its own.
    const double aa = mean - epsilon_squared + slope * d, bb = along + across;
    const double ab = (aa + bb - (along - across)) / 2;
    const double determinant = R[0] * R[3] - R[1] * R[2];
    const auto squared = [&](double of_a, double of_b) {
      return (of_a * of_a * aa + 2 * of_a * of_b * ab + of_b * of_b * bb) /
             (determinant * determinant);
    };
    return {squared(R[2] + R[3], -R[0] - R[1]), squared(-R[2], R[0]), squared(R[3], -R[1])};
  }
};

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_TRIANGLE_STRAIN_H_
