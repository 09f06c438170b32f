#ifndef SHAPESPACE_MESH_INTERNAL_TRIANGLE_DEFORMATION_H_
#define SHAPESPACE_MESH_INTERNAL_TRIANGLE_DEFORMATION_H_

#include <cmath>

#include <Eigen/Geometry>

namespace shapespace::internal {

/// A symmetric 2 x 2 matrix S = [xx xy; xy yy].
struct SymmetricMatrix2 {
  double xx = 0, xy = 0, yy = 0;

  Eigen::Matrix2d Matrix() const { return (Eigen::Matrix2d() << xx, xy, xy, yy).finished(); }
  /// With the norm of the matrix.
  Eigen::Vector3d Vector() const { return {xx, M_SQRT2 * xy, yy}; }
  static SymmetricMatrix2 FromVector(const Eigen::Vector3d& v) {
    return {v(0), M_SQRT1_2 * v(1), v(2)};
  }
};

/// The logarithm of a positive definite matrix.
inline SymmetricMatrix2 Log(const SymmetricMatrix2& s) {
  const double mean = (s.xx + s.yy) / 2, d = (s.xx - s.yy) / 2, r = std::hypot(d, s.xy);
  const double l = 0.5 * std::log(mean * mean - r * r);
  const double factor = r > 0 ? std::atanh(r / mean) / r : 1 / mean;
  return {l + factor * d, factor * s.xy, l - factor * d};
}

inline SymmetricMatrix2 Exp(const SymmetricMatrix2& s) {
  const double mean = (s.xx + s.yy) / 2, d = (s.xx - s.yy) / 2, r = std::hypot(d, s.xy);
  const double e = std::exp(mean), c = e * std::cosh(r);
  const double factor = r > 0 ? e * std::sinh(r) / r : e;
  return {c + factor * d, factor * s.xy, c - factor * d};
}

/// A triangle's corners in a frame of its own: the first at the origin, the second on the x axis.
struct TriangleFrame {
  Eigen::Matrix3d axes;   ///< the second edge's direction, across it, the normal
  Eigen::Matrix2d edges;  ///< to the second and third corner, upper triangular

  /// Triangles without area have edges without an inverse.
  TriangleFrame(const Eigen::Vector3d& p, const Eigen::Vector3d& q, const Eigen::Vector3d& r) {
    const Eigen::Vector3d a = q - p, b = r - p;
    axes.col(0) = a.normalized();
    axes.col(2) = a.cross(b).normalized();
    axes.col(1) = axes.col(2).cross(axes.col(0));
    edges << a.norm(), b.dot(axes.col(0)), 0, b.dot(axes.col(1));
  }
};

/// How a triangle lies and is stretched relative to its reference: its gradient is R S.
struct TriangleDeformation {
  Eigen::Quaterniond rotation;  ///< from the frame of the reference
  SymmetricMatrix2 stretch;     ///< in it

  /// `inverse` is that of the reference's edges.
  TriangleDeformation(const TriangleFrame& frame, const Eigen::Matrix2d& inverse) {
    const Eigen::Matrix2d gradient = frame.edges * inverse;
    const double angle =
        std::atan2(gradient(1, 0) - gradient(0, 1), gradient(0, 0) + gradient(1, 1));
    const Eigen::Rotation2Dd turn(angle);
    const Eigen::Matrix2d s = turn.toRotationMatrix().transpose() * gradient;
    stretch = {s(0, 0), (s(0, 1) + s(1, 0)) / 2, s(1, 1)};
    rotation = Eigen::Quaterniond(frame.axes) *
               Eigen::Quaterniond(Eigen::AngleAxisd(angle, Eigen::Vector3d::UnitZ()));
  }
};

/// The rotation vector of a rotation by less than a turn: its angle times its axis, the shorter
/// way.
inline Eigen::Vector3d Log(const Eigen::Quaterniond& q) {
  const double sine = q.vec().norm();
  if (sine == 0) return Eigen::Vector3d::Zero();
  const double sign = q.w() < 0 ? -1 : 1;
  return sign * 2 * std::atan2(sine, std::abs(q.w())) / sine * q.vec();
}

inline Eigen::Quaterniond Exp(const Eigen::Vector3d& turn) {
  const double angle = turn.norm();
  if (angle == 0) return Eigen::Quaterniond::Identity();
  return Eigen::Quaterniond(Eigen::AngleAxisd(angle, turn / angle));
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MESH_INTERNAL_TRIANGLE_DEFORMATION_H_
