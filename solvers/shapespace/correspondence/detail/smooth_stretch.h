#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_SMOOTH_STRETCH_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_SMOOTH_STRETCH_H_

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/sparse/internal/cholesky.h>

namespace shapespace::internal {

/// The smoothed stretch of a body: the logarithm of each triangle's stretch (the symmetric factor
/// of its deformation gradient), smoothed along the surface. It does not depend on bending, because
/// stretches are expressed in the triangles at rest.
class SmoothStretch {
 public:
  /// Stretches are measured relative to `rest` and smoothed over `length`, a share of the square
  /// root of its area: S minimises |S - raw|^2 + length^2 |grad S|^2, with linear finite elements.
  SmoothStretch(std::shared_ptr<const Connectivity> connectivity, Shape rest, double length);

  /// Per triangle of `shape`, the corners of the triangle at rest after the smoothed stretch, in
  /// its plane at rest: 9 x T.
  Eigen::Matrix<double, 9, Eigen::Dynamic> StretchedTriangles(const Shape& shape) const;

  /// How much `shape` is deformed: the mean over the surface of |log S| of its stretches S, at most
  /// 1 each, and of the squared distance of log S from the smoothed one. A fit that folds, or
  /// misses a limb, has stretches that vary, though their mean may be less than that of the right
  /// one.
  double Cost(const Shape& shape) const;

 private:
  using Logarithms = Eigen::Matrix<double, 6, Eigen::Dynamic>;  // of stretches, in six entries

  // Of each triangle's stretch.
  Logarithms Raw(const Shape& shape) const;
  // Smoothed, at the vertices: m x 6.
  Eigen::MatrixXd Smoothed(const Logarithms& raw) const;

  const std::shared_ptr<const Connectivity> connectivity_;
  const Shape rest_;
  std::vector<Eigen::Matrix3d> inverses_;  // of the rest's frames
  Eigen::VectorXd areas_;                  // of triangles, with sum 1
  std::unique_ptr<Cholesky> factor_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_SMOOTH_STRETCH_H_
