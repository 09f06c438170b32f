#ifndef SHAPESPACE_TRANSFER_DETAIL_GRADIENT_TRANSFER_H_
#define SHAPESPACE_TRANSFER_DETAIL_GRADIENT_TRANSFER_H_

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/sparse/internal/gradient_integrator.h>

namespace shapespace::internal {

/// Deformation transfer after Sumner and Popovic, "Deformation Transfer for Triangle Meshes"
/// (SIGGRAPH 2004): the shape of the target that minimises sum_f |F_f - S_f|^2, where F_f and S_f
/// are the deformation gradients of triangle f on target and source. (Their fourth vertex, along a
/// triangle's normal, belongs to one triangle only; eliminating it leaves the gradient within the
/// triangle's plane.) One scalar linear system for all shapes.
///
/// Edges to vertices without triangles, as in graphs, change by the same vectors as on the source.
/// Components that are tied to others by stiffeners keep their place relative to these. What is not
/// determined by this, such as the positions of other components, is taken from the source too.
class GradientTransfer {
 public:
  /// Source and target at rest, 3 x m, in the same orientation and size.
  GradientTransfer(std::shared_ptr<const Connectivity> connectivity, const Shape& source,
                   const Shape& target);

  /// The target's shape that corresponds to the source's shape `deformed`.
  Shape operator()(const Shape& deformed) const;

 private:
  const std::shared_ptr<const Connectivity> connectivity_;
  const Shape source_, target_;
  std::vector<Eigen::Matrix3d> inverses_;  // of the source's frames, per triangle
  std::unique_ptr<SurfaceIntegrator> integrator_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_TRANSFER_DETAIL_GRADIENT_TRANSFER_H_
