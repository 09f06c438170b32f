#include <shapespace/deformation/detail/constrained_path.h>

#include <algorithm>
#include <cmath>

#include <shapespace/geodesic/internal/residual_blocks.h>
#include <shapespace/geodesic/internal/resolution.h>

namespace shapespace::internal {
PathEnergy& ConstrainedPath::EnergyOf(int segments) {
  if (!energy_ || energy_->Inner() != segments) {
    energy_.emplace(metric_, segments, PathEnergy::End::kFree);
  }
  return *energy_;
}

double ConstrainedPath::Energy(const std::vector<Shape>& shapes) {
  PathEnergy& energy = EnergyOf(static_cast<int>(shapes.size()) - 1);
  std::vector<double> unknowns(energy.Size());
  energy.Load(shapes, unknowns.data());
  return energy.Evaluate(unknowns.data(), nullptr);
}

MinimiseResult ConstrainedPath::Relax(const Shape& target, const MinimiseOptions& options,
                                      std::vector<Shape>* shapes, const Contact* contact) {
  const int n = static_cast<int>(shapes->size()) - 1;
  PathEnergy& energy = EnergyOf(n);
  std::vector<double> unknowns(energy.Size());
  energy.Load(*shapes, unknowns.data());
  const size_t stride = energy.Stride();
  const PositionConstraints& constraints = factors_.Constraints();
  const auto last = [&](int v, int axis) {
    return (3 * static_cast<size_t>(energy.Row(v)) + axis) * stride + n - 1;
  };
  std::optional<PathContact> potential;
  if (contact != nullptr) {
    potential.emplace(contact->model, energy, *shapes, contact->motions, contact->times);
  }
  const Objective objective = [&](const double* x, double* gradient) {
    double value = energy.Evaluate(x, gradient);
    if (potential) value += potential->Evaluate(x, contact->weight, gradient);
    for (int v = 0; v < constraints.penalty.size(); ++v) {
      if (constraints.penalty(v) == 0) continue;
      for (int axis = 0; axis < 3; ++axis) {
        const double way = x[last(v, axis)] - target(axis, v);
        value += constraints.penalty(v) / n * way * way;
        if (gradient != nullptr) gradient[last(v, axis)] += 2 * constraints.penalty(v) / n * way;
      }
    }
    if (gradient != nullptr) {
      for (int v : constraints.prescribed)
        std::fill_n(gradient + last(v, 0) - (n - 1), 3 * stride, 0.0);
      for (int v : constraints.prescribed_last) {
        for (int axis = 0; axis < 3; ++axis) gradient[last(v, axis)] = 0;
      }
    }
    return value;
  };
  FreeEndPreconditioner preconditioner(factors_, energy);
  MinimiseOptions own = options;
  own.rank = HistoryRank(static_cast<double>(unknowns.size()));
  if (potential) potential->Limit(&own);
  const MinimiseResult result = MinimiseThreadedLbfgs(
      objective,
      [&](const double* gradient, double unit, double* step) {
        preconditioner.Apply(gradient, unit, step);
      },
      own, &unknowns);
  energy.Store(unknowns.data(), shapes);
  return result;
}

MinimiseResult ConstrainedPath::RelaxByTrustRegion(const Shape& target,
                                                   const MinimiseOptions& options,
                                                   std::vector<Shape>* shapes) const {
  const PositionConstraints& constraints = factors_.Constraints();
  const int n = static_cast<int>(shapes->size()) - 1;
  ResidualBlocks blocks;
  blocks.AddPathEnergy(*metric_, 1, shapes);
  for (int v = 0; v < constraints.penalty.size(); ++v) {
    if (constraints.penalty(v) > 0) {
      blocks.AddPenalty(constraints.penalty(v) / n, target.col(v), shapes->back().col(v).data());
    }
  }
  blocks.Fix(&shapes->front());
  for (size_t t = 1; t < shapes->size(); ++t) {
    for (int v : constraints.prescribed) blocks.Fix((*shapes)[t].col(v).data());
  }
  for (int v : constraints.prescribed_last) blocks.Fix(shapes->back().col(v).data());
  const MinimiseResult result = blocks.Minimise(options);
  for (Shape& shape : *shapes) metric_->connectivity->CopyToTwins(&shape);
  return result;
}

}  // namespace shapespace::internal
