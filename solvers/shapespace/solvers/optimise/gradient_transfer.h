#ifndef SHAPESPACE_SOLVERS_OPTIMISE_GRADIENT_TRANSFER_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_GRADIENT_TRANSFER_H_

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/solvers/optimise/cholesky.h>

namespace shapespace::internal {

/// Deformation transfer after Sumner and Popovic, "Deformation Transfer for Triangle Meshes"
/// (SIGGRAPH 2004): the shape of the target whose triangles are deformed as the source's, sum_f
/// |F_f - S_f|^2 least, F_f and S_f being the deformation gradients of triangle f on target and
/// source. (Their fourth vertex, along a triangle's normal, is of one triangle only; eliminated, it
/// leaves the gradient within the triangle's plane.) One scalar linear system for all shapes.
///
/// Edges that lead to vertices without triangles, as in graphs, change by the source's vectors.
/// What all that leaves open, as the places of a mesh's components, is taken from the source too.
class GradientTransfer {
 public:
  /// Source and target, 3 x m, stand alike and in one size: what they are deformed from.
  GradientTransfer(std::shared_ptr<const Connectivity> connectivity, const Shape& source,
                   const Shape& target);

  /// What the target becomes as the source becomes `deformed`.
  Shape operator()(const Shape& deformed) const;

 private:
  // An edge of a triangle on the target, that counts for so much.
  struct Side {
    int from, to;
    double weight;
  };

  const std::shared_ptr<const Connectivity> connectivity_;
  const Shape source_, target_;
  std::vector<Side> sides_;                // three a triangle, then the edges without
  std::vector<Eigen::Matrix3d> inverses_;  // of the source's frames, a triangle
  double place_ = 0;                       // weight of a vertex staying where the source says
  std::unique_ptr<Cholesky> factor_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_GRADIENT_TRANSFER_H_
