#ifndef SHAPESPACE_MINIMISE_INTERNAL_MINIMISE_H_
#define SHAPESPACE_MINIMISE_INTERNAL_MINIMISE_H_

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <shapespace/minimise/internal/preconditioner.h>
#include <shapespace/path/energy.h>
#include <shapespace/summary/termination.h>

namespace shapespace::internal {

/// Rank of the L-BFGS approximation for this number of unknowns: high for small problems, low where
/// the history would dominate memory.
inline int HistoryRank(double unknowns) { return unknowns <= 3e5 ? 20 : 5; }

struct MinimiseOptions {
  /// Stop when an iteration (of MinimiseThreadedLbfgs: two in a row) lowers the energy by less than
  /// this share of it.
  double tolerance = 1e-4;
  /// A solve whose steps have become small has converged only if RemainingDecrease is at most this
  /// multiple of the tolerance. Otherwise it goes on with smaller steps; if none is left, or
  /// `enough` says that it is a start for another one, it has stalled.
  double trusted_remaining = std::numeric_limits<double>::infinity();
  int max_iterations = 500;
  int rank = 20;  ///< of the L-BFGS approximation
  /// Stop as soon as the estimated gain of another step is at most this share of the gain so far; 0
  /// disables this. Ceres' L-BFGS estimates it by the preconditioned gradient, as RemainingDecrease
  /// does. MinimiseThreadedLbfgs uses its approximation of the Hessian, which costs nothing more
  /// and is not inflated by sharp creases. The trust region ignores this option.
  double enough = 0;
  /// Called before the first and after every iteration, with the energy in some unit; false stops
  /// the solve. May be empty.
  std::function<bool(int iteration, double energy)> keep_going;

  /// For MinimiseThreadedLbfgs alone. The longest step along `direction` from `unknowns` that is
  /// allowed, above 0; arrays as the unknowns. If empty, there is no limit.
  std::function<double(const double* unknowns, const float* direction)> longest_step;
  /// For MinimiseThreadedLbfgs alone. Whether the point that a line search has found is allowed. If
  /// not, the objective may have changed: it is evaluated again at the point before, and another
  /// line search follows with half the step at most. May be empty.
  std::function<bool(const double* unknowns)> allows;
};

/// What paths between poses set as MinimiseOptions::trusted_remaining. On healthy meshes their
/// RemainingDecrease is at most once the tolerance; where the preconditioner is bad, as between
/// triangles of which some are far thinner than others, it has been 100 times to 1e10 times that.
inline constexpr double kTrustedRemaining = 10;
/// By this factor the tolerance of decreases is lowered for a solve that must go on.
inline constexpr double kMoreAccurate = 0.1;

struct MinimiseResult {
  Termination termination = Termination::kStalled;
  int iterations = 0, evaluations = 0;
  double initial_energy = 0, energy = 0;
  double remaining = 0;  ///< RemainingDecrease at the end
};

/// The objective: returns its value at `unknowns` and, unless null, fills `gradient`, both in a
/// PathEnergy's layout.
using Objective = std::function<double(const double* unknowns, double* gradient)>;

/// A path energy as objective; it must outlive the result.
inline Objective ObjectiveOf(PathEnergy* energy) {
  return [energy](const double* unknowns, double* gradient) {
    return energy->Evaluate(unknowns, gradient);
  };
}

/// First-order estimate of the gain of another step of the preconditioned method, as a share of the
/// energy: half the squared gradient in the variables in which the Hessian approximates the
/// identity.
double RemainingDecrease(const Objective& energy, ChangeOfVariables* variables,
                         const std::vector<double>& unknowns);

/// The same for a path energy with the other preconditioner.
double RemainingDecrease(PathEnergy* energy, Preconditioner* preconditioner,
                         const std::vector<double>& unknowns);

/// Ceres' L-BFGS in the preconditioned variables. `unknowns` (PathEnergy::Size()) contains the
/// initial guess and receives the result.
/// \throw SolverError if the energy is not finite at the start.
MinimiseResult MinimiseLbfgs(const Objective& energy, ChangeOfVariables* variables,
                             const MinimiseOptions& options, std::vector<double>* unknowns);

/// result = (approximate inverse of the Hessian) gradient, in a PathEnergy's layout; the arrays may
/// be identical. `unit` as in Preconditioner::Apply.
using Precondition = std::function<void(const double* gradient, double unit, double* result)>;

/// A preconditioner as such a function; it must outlive the result.
inline Precondition PreconditionOf(Preconditioner* preconditioner) {
  return [preconditioner](const double* gradient, double unit, double* result) {
    preconditioner->Apply(gradient, unit, result);
  };
}

/// This library's L-BFGS (Nocedal and Wright, Numerical Optimization, algorithm 7.4), for large
/// problems. It stores twice the rank vectors in single precision and six in double; all vector
/// operations use all threads, and the preconditioner is applied once per iteration. The result is
/// bitwise identical for any number of threads. Unknowns whose gradient and preconditioned gradient
/// are always zero stay unchanged.
/// \throw SolverError if the energy is not finite at the start.
MinimiseResult MinimiseThreadedLbfgs(const Objective& energy, const Precondition& precondition,
                                     const MinimiseOptions& options, std::vector<double>* unknowns);
MinimiseResult MinimiseThreadedLbfgs(PathEnergy* energy, Preconditioner* preconditioner,
                                     const MinimiseOptions& options, std::vector<double>* unknowns);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MINIMISE_INTERNAL_MINIMISE_H_
