#ifndef SHAPESPACE_SOLVERS_CORRESPONDENCE_SMOOTH_STRETCH_H_
#define SHAPESPACE_SOLVERS_CORRESPONDENCE_SMOOTH_STRETCH_H_

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/solvers/optimise/cholesky.h>

// Private.

namespace shapespace::internal {

/// By how much a body is stretched on the whole: of every triangle the logarithm of the stretch
/// (the symmetric factor of its deformation gradient), smoothed along the surface. It does not
/// depend on how the body is bent, as stretches turn with nothing.
class SmoothStretch {
 public:
  /// Stretches are measured from `rest`, and smoothed over `length`, a share of the root of its
  /// area: S minimises |S - raw|^2 + length^2 |grad S|^2, by linear elements.
  SmoothStretch(std::shared_ptr<const Connectivity> connectivity, Shape rest, double length);

  /// Of the body as `shape`, the corners of each triangle, 9 x T, as they lie in its plane at rest
  /// but stretched by the smoothed stretch.
  Eigen::Matrix<double, 9, Eigen::Dynamic> StretchedTriangles(const Shape& shape) const;

 private:
  const std::shared_ptr<const Connectivity> connectivity_;
  const Shape rest_;
  std::vector<Eigen::Matrix3d> inverses_;  // of the rest's frames
  Eigen::VectorXd areas_;                  // of triangles, of sum 1
  std::unique_ptr<Cholesky> factor_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_CORRESPONDENCE_SMOOTH_STRETCH_H_
