#include <shapespace/exponential/detail/shooter.h>

#include <utility>

#include <shapespace/hierarchy/freeze_level.h>

namespace shapespace::internal {

Shooter::Shooter(std::shared_ptr<const Metric> metric, std::vector<Shape> known,
                 const ExponentialOptions& options, std::function<void()> check_cancelled)
    : options_(options), check_cancelled_(std::move(check_cancelled)), known_(std::move(known)) {
  levels_.push_back(std::make_unique<Level>(std::move(metric)));
}

Shape Shooter::Next(const InitialState& initial_state, ExponentialSummary::Step* row) {
  Shape shape = NextOn(static_cast<int>(levels_.size()) - 1, initial_state, row);
  levels_.back()->metric->connectivity->CopyToTwins(&shape);
  return shape;
}

InitialState Shooter::Restart(const Shape& before, const Shape& shape, double speed) {
  Level& finest = *levels_.back();
  Tangent velocity = SegmentVelocity(finest.map, before, shape, 1, &finest.solver);
  const double found = finest.map.Derivative(shape).Times(velocity).norm();
  if (found > 0) velocity *= speed / found;
  return {shape, {}, std::move(velocity), speed};
}

void Shooter::Decimate() {
  const std::shared_ptr<const Metric> finest = levels_.back()->metric;
  hierarchy_.emplace(finest->connectivity, known_);
  for (int level = hierarchy_->NumLevels() - 2; level >= 0; --level) {
    std::vector<Shape> poses;
    for (const Shape& shape : known_) poses.push_back(hierarchy_->Restrict(shape, level));
    levels_.insert(levels_.begin(),
                   std::make_unique<Level>(FreezeLevel(*finest, *hierarchy_, level, poses)));
  }
}

Shape Shooter::NextOn(int level, const InitialState& initial_state, ExponentialSummary::Step* row) {
  Level& own = *levels_[level];
  const Step step(own.map, &own.solver, initial_state, check_cancelled_);
  Shape shape;
  if (step.Solve(options_, row, &shape)) {
    row->vertices = static_cast<int>(shape.cols());
    return shape;
  }
  if (!hierarchy_) {
    Decimate();
    level = static_cast<int>(levels_.size()) - 1;
  }
  if (level == 0) {
    row->vertices = 0;
    shape = step.Nearest(row);
    row->residual = step.Residual(shape);
    return shape;
  }
  InitialState coarse;
  const auto restrict = [&](const Shape& fine) {
    return fine.size() > 0 ? hierarchy_->RestrictOnce(fine, level) : fine;
  };
  coarse.shape = restrict(initial_state.shape);
  coarse.previous = restrict(initial_state.previous);
  coarse.velocity = restrict(initial_state.velocity);
  ExponentialSummary::Step coarse_row;
  const Shape base = NextOn(level - 1, coarse, &coarse_row);
  shape = hierarchy_->Lift(base, level - 1, initial_state.shape, initial_state.shape, 0);
  row->vertices = coarse_row.vertices;
  row->residual = step.Residual(shape);
  return shape;
}

int Shooter::NumFactorisations() const {
  int sum = 0;
  for (const auto& level : levels_) sum += level->solver.NumFactorisations();
  return sum;
}

double Shooter::FactorSeconds() const {
  double sum = 0;
  for (const auto& level : levels_) sum += level->solver.FactorSeconds();
  return sum;
}

}  // namespace shapespace::internal
