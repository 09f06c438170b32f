#ifndef SHAPESPACE_CORRESPONDENCE_INTERNAL_GRADIENT_FIT_H_
#define SHAPESPACE_CORRESPONDENCE_INTERNAL_GRADIENT_FIT_H_

#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// The first phase of the fit of Sumner and Popovic, "Deformation Transfer for Triangle Meshes"
/// (SIGGRAPH 2004), section 5: the shape that minimises
///   sum over neighbouring triangles |T_f - T_g|^2 + identity * sum_f |T_f - I|^2,
/// where T_f is the deformation gradient of triangle f with a fourth vertex along its normal, and
/// vertices `held` have the positions `places` exactly. One linear system for all axes. `ShellFit`
/// replaces their second phase, which uses closest points.
/// \throw SolverError if memory runs out.
Shape FitGradients(const Connectivity& connectivity, const Shape& rest,
                   const std::vector<int>& held, const Shape& places, double identity);

/// The weight used there.
inline constexpr double kIdentity = 1e-3;

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_INTERNAL_GRADIENT_FIT_H_
