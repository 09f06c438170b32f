#ifndef SHAPESPACE_COST_PATH_ENERGY_FUNCTION_H_
#define SHAPESPACE_COST_PATH_ENERGY_FUNCTION_H_

#include <memory>
#include <vector>

#include <ceres/first_order_function.h>

#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>

namespace shapespace::cost {

/// The energy of a path as a function of one array y, for Ceres' gradient solvers
/// (`ceres::GradientProblem`, with L-BFGS). y is zero at the path that is given, and its
/// coordinates are preconditioned: the Hessian approximates the identity (docs/mathematics.md,
/// section 6), so that some dozens of iterations suffice for a mesh of any size. Energy and
/// gradient come from `PathEnergy`, on all threads; an object is used by one solve at a time.
class PathEnergyFunction final : public ceres::FirstOrderFunction {
 public:
  /// `shapes` (3 x m each, aligned, in the metric's unit; copied) are the path from which a solve
  /// starts. The first and the last stay as they are, the others are the unknowns.
  /// \throw MeshError if there are fewer than three, or one has another number of vertices than
  ///        the metric; SolverError if their energy is zero or not finite, or the preconditioner's
  ///        matrix is not definite.
  PathEnergyFunction(const std::shared_ptr<const Metric>& metric, const std::vector<Shape>& shapes);
  ~PathEnergyFunction() override;

  /// The cost is the energy as a share of that of the given path, so that Ceres' tolerances mean
  /// the same for any input.
  bool Evaluate(const double* y, double* cost, double* gradient) const override;
  /// 3 m for each inner shape.
  int NumParameters() const override;

  /// The scaled energy (E n / 2 for n segments) of the given path.
  double InitialEnergy() const;
  /// The path that belongs to y.
  std::vector<Shape> PathAt(const double* y) const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace shapespace::cost

#endif  // SHAPESPACE_COST_PATH_ENERGY_FUNCTION_H_
