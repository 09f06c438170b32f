#ifndef SHAPESPACE_MINIMISE_INTERNAL_PRECONDITIONED_ENERGY_H_
#define SHAPESPACE_MINIMISE_INTERNAL_PRECONDITIONED_ENERGY_H_

#include <cmath>
#include <vector>

#include <ceres/first_order_function.h>

#include <shapespace/minimise/internal/minimise.h>
#include <shapespace/minimise/internal/preconditioner.h>

namespace shapespace::internal {

/// The energy as a function of y, in units of its value at the start; y is scaled so that the
/// Hessian still approximates the identity. Ceres' absolute tolerances then have the same meaning
/// for any input.
class PreconditionedEnergy final : public ceres::FirstOrderFunction {
 public:
  /// The energy is `unit` at `origin`, which belongs to y = 0. All arguments but `unit` are kept by
  /// reference.
  PreconditionedEnergy(const Objective& energy, ChangeOfVariables* variables,
                       const std::vector<double>& origin, double unit, int* evaluations)
      : energy_(energy),
        variables_(*variables),
        origin_(origin),
        unit_(unit),
        evaluations_(*evaluations),
        unknowns_(origin.size()),
        gradient_(origin.size()) {}

  bool Evaluate(const double* y, double* cost, double* gradient) const override {
    ++evaluations_;
    variables_.Apply(y, origin_.data(), std::sqrt(unit_), unknowns_.data());
    *cost = energy_(unknowns_.data(), gradient_.data()) / unit_;
    if (gradient != nullptr) {
      variables_.ApplyTranspose(gradient_.data(), 1 / std::sqrt(unit_), gradient);
    }
    return std::isfinite(*cost);
  }
  int NumParameters() const override { return variables_.Size(); }

  /// The unknowns that belong to y, in the energy's layout.
  std::vector<double> Unknowns(const double* y) const {
    std::vector<double> unknowns(origin_.size());
    variables_.Apply(y, origin_.data(), std::sqrt(unit_), unknowns.data());
    return unknowns;
  }

 private:
  const Objective& energy_;
  ChangeOfVariables& variables_;
  const std::vector<double>& origin_;
  const double unit_;
  int& evaluations_;
  mutable std::vector<double> unknowns_, gradient_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MINIMISE_INTERNAL_PRECONDITIONED_ENERGY_H_
