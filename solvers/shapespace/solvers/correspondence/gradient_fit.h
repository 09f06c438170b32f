#ifndef SHAPESPACE_SOLVERS_CORRESPONDENCE_GRADIENT_FIT_H_
#define SHAPESPACE_SOLVERS_CORRESPONDENCE_GRADIENT_FIT_H_

#include <memory>
#include <vector>

#include <Eigen/Core>
#include <Eigen/SparseCore>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/solvers/optimise/cholesky.h>

// Private.

namespace shapespace::internal {

/// The fitting of Sumner and Popovic, "Deformation Transfer for Triangle Meshes" (SIGGRAPH 2004),
/// section 5: the shape for which
///   sum over neighbouring triangles |T_f - T_g|^2 + 0.001 sum_f |T_f - I|^2 + sum_v w_v |x_v -
///   c_v|^2
/// is least, T_f being the deformation gradient of triangle f with a fourth vertex along its
/// normal. Held vertices are where they are asked to be, exactly. A linear system for each axis, of
/// one pattern for all weights: analysed once, factored in every round.
class GradientFit {
 public:
  /// `rest` is what gradients are measured from; `held` are vertices, each with its place in the
  /// column of `places`.
  GradientFit(const std::shared_ptr<const Connectivity>& connectivity, const Shape& rest,
              const std::vector<int>& held, const Shape& places);

  /// `weights` (not negative) and `targets` of all vertices; a weight counts as a share of the
  /// inverse mean square edge. \throw SolverError if memory runs out.
  Shape operator()(const Eigen::VectorXd& weights, const Shape& targets);

 private:
  int num_vertices_;
  Eigen::SparseMatrix<double> constant_, matrix_;  // lower triangles
  Eigen::MatrixX3d right_;                         // of the constant terms
  std::vector<bool> is_held_;                      // of all unknowns
  Shape places_;                                   // of held vertices, else zero
  double per_edge_ = 1;                            // the inverse mean square edge
  std::unique_ptr<Cholesky> factor_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_CORRESPONDENCE_GRADIENT_FIT_H_
