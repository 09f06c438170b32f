#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_GRADIENT_FIT_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_GRADIENT_FIT_H_

#include <optional>
#include <vector>

#include <Eigen/SparseCore>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/sparse/internal/cholesky.h>

namespace shapespace::internal {

/// The first phase of the fit of Sumner and Popovic, "Deformation Transfer for Triangle Meshes"
/// (SIGGRAPH 2004), section 5: the shape that minimises
///   sum over neighbouring triangles |T_f - T_g|^2 + identity * sum_f |T_f - I|^2,
/// where T_f is the deformation gradient of triangle f with a fourth vertex along its normal, and
/// vertices `held` have given places exactly. One linear system for all axes, factored once for all
/// places. `ShellFit` replaces their second phase, which uses closest points.
class GradientFit {
 public:
  /// \throw SolverError if memory runs out.
  GradientFit(const Connectivity& connectivity, const Shape& rest, std::vector<int> held,
              double identity);

  /// The shape whose held vertices have the positions `places`, in their order.
  Shape operator()(const Shape& places) const;

 private:
  const int num_vertices_;
  const std::vector<int> held_;
  Eigen::MatrixX3d right_;                 // the right-hand side but for what is held
  Eigen::SparseMatrix<double> couplings_;  // of all unknowns (rows) with those held (columns)
  std::optional<Cholesky> factor_;
};

/// The weight used there.
inline constexpr double kIdentity = 1e-3;

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_GRADIENT_FIT_H_
