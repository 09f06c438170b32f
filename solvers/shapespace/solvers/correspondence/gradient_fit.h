#ifndef SHAPESPACE_SOLVERS_CORRESPONDENCE_GRADIENT_FIT_H_
#define SHAPESPACE_SOLVERS_CORRESPONDENCE_GRADIENT_FIT_H_

#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

// Private.

namespace shapespace::internal {

/// The first round of the fitting of Sumner and Popovic, "Deformation Transfer for Triangle Meshes"
/// (SIGGRAPH 2004), section 5: the shape for which
///   sum over neighbouring triangles |T_f - T_g|^2 + identity * sum_f |T_f - I|^2
/// is least, T_f being the deformation gradient of triangle f with a fourth vertex along its
/// normal, while `held` vertices are at the columns of `places`, exactly. One linear system for all
/// axes. Their further rounds, with closest points, are left to `ShellFit`. \throw SolverError if
/// memory runs out.
Shape FitGradients(const Connectivity& connectivity, const Shape& rest,
                   const std::vector<int>& held, const Shape& places, double identity);

/// Their weight.
inline constexpr double kIdentity = 1e-3;

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_CORRESPONDENCE_GRADIENT_FIT_H_
