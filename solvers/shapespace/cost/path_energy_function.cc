#include <shapespace/cost/path_energy_function.h>

#include <cmath>

#include <shapespace/base/error.h>
#include <shapespace/minimise/internal/minimise.h>
#include <shapespace/minimise/internal/preconditioned_energy.h>
#include <shapespace/minimise/internal/preconditioner.h>
#include <shapespace/path/energy.h>

namespace shapespace::cost {
namespace {

int NumInner(const std::vector<Shape>& shapes) {
  if (shapes.size() < 3) {
    throw MeshError("the energy of a path with unknown shapes needs three shapes or more");
  }
  return static_cast<int>(shapes.size()) - 2;
}

std::vector<double> Load(const std::vector<Shape>& shapes, PathEnergy* energy) {
  std::vector<double> unknowns(energy->Size());
  energy->Load(shapes, unknowns.data());
  return unknowns;
}

double CheckedValue(PathEnergy* energy, const std::vector<double>& unknowns) {
  const double value = energy->Evaluate(unknowns.data(), nullptr);
  if (!(value > 0) || !std::isfinite(value)) {
    throw SolverError("the energy of the given path is zero or not finite");
  }
  return value;
}

}  // namespace

struct PathEnergyFunction::Parts {
  Parts(const std::shared_ptr<const Metric>& metric, const std::vector<Shape>& shapes)
      : path(shapes),
        energy(metric, NumInner(shapes)),
        origin(Load(shapes, &energy)),
        unit(CheckedValue(&energy, origin)),
        factor(internal::ScalarMetric(
            *metric, {shapes.front(), shapes.back()},
            metric->options.discretization == Discretization::kTrapezoid ? energy.Inner() + 1 : 0)),
        variables(factor, energy),
        objective(internal::ObjectiveOf(&energy)),
        preconditioned(objective, &variables, origin, unit, &evaluations) {}

  const std::vector<Shape> path;
  PathEnergy energy;
  const std::vector<double> origin;
  const double unit;
  const internal::Cholesky factor;
  internal::ChangeOfVariables variables;
  const internal::Objective objective;
  int evaluations = 0;
  internal::PreconditionedEnergy preconditioned;
};

PathEnergyFunction::PathEnergyFunction(const std::shared_ptr<const Metric>& metric,
                                       const std::vector<Shape>& shapes)
    : parts_(std::make_unique<Parts>(metric, shapes)) {}

PathEnergyFunction::~PathEnergyFunction() = default;

bool PathEnergyFunction::Evaluate(const double* y, double* cost, double* gradient) const {
  return parts_->preconditioned.Evaluate(y, cost, gradient);
}

int PathEnergyFunction::NumParameters() const { return parts_->preconditioned.NumParameters(); }

double PathEnergyFunction::InitialEnergy() const {
  return ScaledEnergy(parts_->unit, parts_->energy.Inner() + 1);
}

std::vector<Shape> PathEnergyFunction::PathAt(const double* y) const {
  std::vector<Shape> shapes = parts_->path;
  parts_->energy.Store(parts_->preconditioned.Unknowns(y).data(), &shapes);
  return shapes;
}

}  // namespace shapespace::cost
