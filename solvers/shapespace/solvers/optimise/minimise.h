#ifndef SHAPESPACE_SOLVERS_OPTIMISE_MINIMISE_H_
#define SHAPESPACE_SOLVERS_OPTIMISE_MINIMISE_H_

#include <functional>
#include <string>
#include <vector>

#include <shapespace/metric/metric.h>
#include <shapespace/path/energy.h>
#include <shapespace/solvers/optimise/preconditioner.h>

namespace shapespace::internal {

struct MinimiseOptions {
  double tolerance = 1e-4;  ///< stop when an iteration lowers the energy by less than this share
  int max_iterations = 500;
  int rank = 20;                                  ///< of the L-BFGS approximation
  std::function<bool(int iteration)> keep_going;  ///< false cancels; may be empty
};

enum class Stop { kConverged, kMaxIterations, kStalled };

struct MinimiseResult {
  Stop stop = Stop::kStalled;
  int iterations = 0, evaluations = 0;
  double initial_energy = 0, energy = 0;
  double remaining = 0;  ///< RemainingDecrease at the end
};

/// What one more step of the preconditioned method would gain at first order, as a share of the
/// energy: half the squared gradient in the variables in which the Hessian resembles the identity.
double RemainingDecrease(PathEnergy* energy, ChangeOfVariables* variables,
                         const std::vector<double>& unknowns);

/// Ceres' L-BFGS in the preconditioned variables. `unknowns` (PathEnergy::Size()) is where it
/// starts and where the result goes.
/// \throw Cancelled, SolverError if the energy is not finite at the start.
MinimiseResult MinimiseLbfgs(PathEnergy* energy, ChangeOfVariables* variables,
                             const MinimiseOptions& options, std::vector<double>* unknowns);

/// Ceres' Levenberg-Marquardt with sparse Cholesky on residual blocks, differentiated
/// automatically: for small problems, and the oracle of the other. `shapes` in the metric's unit,
/// the first and the last stay.
/// \throw Cancelled, InvalidOptions if the metric has a volume feature and more than
///        kMaxDenseVertices vertices: its rows are dense.
MinimiseResult MinimiseTrustRegion(const Metric& metric, double quartic_weight,
                                   const MinimiseOptions& options, std::vector<Shape>* shapes);
inline constexpr int kMaxDenseVertices = 2000;

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_MINIMISE_H_
