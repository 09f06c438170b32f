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
  /// Stop when an iteration (of MinimiseThreadedLbfgs: two in a row) lowers the energy by less than
  /// this share of it.
  double tolerance = 1e-4;
  int max_iterations = 500;
  int rank = 20;  ///< of the L-BFGS approximation
  /// Stop as soon as the estimate of what a further step gains is at most this share of what the
  /// solve has gained; 0 never does. Ceres' L-BFGS estimates by the preconditioned gradient, as
  /// RemainingDecrease does, and MinimiseThreadedLbfgs by its approximation of the Hessian, which
  /// is at hand and stays moderate where sharp creases make the former enormous. The trust region
  /// ignores it.
  double enough = 0;
  /// Asked after every iteration and before the first, with the energy in some unit; false stops
  /// the solve there. May be empty.
  std::function<bool(int iteration, double energy)> keep_going;
};

enum class Stop { kConverged, kMaxIterations, kStalled, kCancelled };

struct MinimiseResult {
  Stop stop = Stop::kStalled;
  int iterations = 0, evaluations = 0;
  double initial_energy = 0, energy = 0;
  double remaining = 0;  ///< RemainingDecrease at the end
};

/// What is minimised: returns its value at `unknowns` and, unless null, fills `gradient`, both on
/// a PathEnergy's arrays.
using Objective = std::function<double(const double* unknowns, double* gradient)>;

/// The path energy itself, which must outlive the result.
inline Objective ObjectiveOf(PathEnergy* energy) {
  return [energy](const double* unknowns, double* gradient) {
    return energy->Evaluate(unknowns, gradient);
  };
}

/// What one more step of the preconditioned method would gain at first order, as a share of the
/// energy: half the squared gradient in the variables in which the Hessian resembles the identity.
double RemainingDecrease(const Objective& energy, ChangeOfVariables* variables,
                         const std::vector<double>& unknowns);

/// The same of a path energy, by the other preconditioner.
double RemainingDecrease(PathEnergy* energy, Preconditioner* preconditioner,
                         const std::vector<double>& unknowns);

/// Ceres' L-BFGS in the preconditioned variables. `unknowns` (PathEnergy::Size()) is where it
/// starts and where the result goes.
/// \throw SolverError if the energy is not finite at the start.
MinimiseResult MinimiseLbfgs(const Objective& energy, ChangeOfVariables* variables,
                             const MinimiseOptions& options, std::vector<double>* unknowns);

/// result = (about the inverse of the Hessian) gradient, on a PathEnergy's arrays, which may be the
/// same; `unit` as in Preconditioner::Apply.
using Precondition = std::function<void(const double* gradient, double unit, double* result)>;

/// L-BFGS of ours (Nocedal and Wright, Numerical Optimization, algorithm 7.4), for large problems:
/// as many vectors as twice the rank in single precision and six in double, every pass over them on
/// all threads, the preconditioner applied once an iteration. Bitwise the same for any number of
/// threads. Unknowns whose gradient and preconditioned gradient are always zero stay as they are.
/// \throw SolverError if the energy is not finite at the start.
MinimiseResult MinimiseThreadedLbfgs(const Objective& energy, const Precondition& precondition,
                                     const MinimiseOptions& options, std::vector<double>* unknowns);
MinimiseResult MinimiseThreadedLbfgs(PathEnergy* energy, Preconditioner* preconditioner,
                                     const MinimiseOptions& options, std::vector<double>* unknowns);

/// Ceres' Levenberg-Marquardt with sparse Cholesky on residual blocks, differentiated
/// automatically: for small problems, and the oracle of the other. `shapes` in the metric's unit,
/// the first and the last stay.
/// \throw InvalidOptions if the metric has a volume feature and more than
///        cost::kMaxDenseVertices vertices: its rows are dense.
MinimiseResult MinimiseTrustRegion(const Metric& metric, double quartic_weight,
                                   const MinimiseOptions& options, std::vector<Shape>* shapes);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_OPTIMISE_MINIMISE_H_
