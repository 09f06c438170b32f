#ifndef SHAPESPACE_STATISTICS_DETAIL_TRIANGLE_PREVIEW_H_
#define SHAPESPACE_STATISTICS_DETAIL_TRIANGLE_PREVIEW_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/internal/triangle_deformation.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/sparse/internal/gradient_integrator.h>
#include <shapespace/statistics/shape_model.h>

namespace shapespace::internal {

/// `ShapeModel::Preview`. Relative to the mean, a triangle of a pose is turned by exp(w) and then
/// stretched by exp(S) in its plane; a mode has the sums of w and S over the poses with the mode's
/// coefficients.
class TrianglePreview {
 public:
  explicit TrianglePreview(const PoseModes& modes);

  /// Centred, in the metric's unit, rotated onto the mean moved along the modes.
  Shape At(const Eigen::VectorXd& coordinates) const;

 private:
  const PoseModes& modes_;
  const Eigen::Matrix3Xi triangles_;
  std::vector<Eigen::Quaterniond> rotations_;  // of the planes of the mean's triangles
  // Of every mode: six numbers, w and S, for each triangle.
  std::vector<Eigen::Matrix<double, 6, Eigen::Dynamic>> changes_;
  const SurfaceIntegrator integrator_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_STATISTICS_DETAIL_TRIANGLE_PREVIEW_H_
