#include <shapespace/geodesic/internal/resolution.h>

#include <cmath>
#include <string>
#include <utility>

#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/geodesic/detail/tied_energy.h>
#include <shapespace/geodesic/internal/residual_blocks.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/minimise/internal/preconditioner.h>

namespace shapespace::internal {
namespace {

// From this number of unknowns on, this library's L-BFGS is at least 1.5 times faster than Ceres',
// whose vector operations are serial.
constexpr double kThreadedUnknowns = 2e4;

// Weight of the trapezoid's quartic part, which is inversely proportional to the square of the
// number of segments. With weight 1 a coarse level in time would be a biased start for a finer one.
double QuarticWeight(int inner, const GeodesicOptions& options) {
  return std::pow((inner + 1.0) / (options.shapes + 1.0), 2);
}

}  // namespace

SharedLevel::SharedLevel(std::shared_ptr<const Metric> level_metric, std::vector<Shape> poses)
    : metric(std::move(level_metric)),
      thin_vertices(std::make_shared<const ThinVertices>(*metric->connectivity, poses)) {
  factors = std::make_shared<LazyFactors>(
      [metric = metric, poses = std::move(poses)] { return ScalarMetric(*metric, poses, 0); });
}

Resolution::Resolution(SharedLevel level)
    : metric_(std::move(level.metric)),
      factors_(std::move(level.factors)),
      thin_vertices_(std::move(level.thin_vertices)) {}

void Resolution::SetPoses(std::vector<Shape> poses) {
  poses_ = std::move(poses);
  factors_key_ = {-1, -1};
}

GeodesicSummary::Level Resolution::Relax(int piece, double enough, const GeodesicOptions& options,
                                         Workload* workload, std::vector<Shape>* shapes) {
  const Stopwatch stopwatch;
  const int inner = static_cast<int>(shapes->size()) - 2;
  GeodesicSummary::Level row;
  row.piece = piece;
  row.vertices = metric_->connectivity->NumVertices();
  row.shapes = inner;
  if (metric_->RigidInvariantButForPosition()) RemoveRigidDrift(shapes, metric_->vertex_area);

  workload->Begin(std::to_string(row.vertices) + " vertices, " + std::to_string(inner) +
                      (inner == 1 ? " inner shape" : " inner shapes"),
                  row.vertices, inner, enough == 0);
  MinimiseOptions minimise;
  minimise.tolerance = options.tolerance;
  minimise.enough = enough;
  minimise.trusted_remaining = kTrustedRemaining;
  minimise.max_iterations = options.max_iterations;
  minimise.keep_going = [&](int iteration, double energy) {
    return workload->GoOn(iteration, energy);
  };
  PathEnergy& energy = EnergyOf(inner, options);
  std::vector<double> unknowns(energy.Size());
  energy.Load(*shapes, unknowns.data());
  Objective objective = ObjectiveOf(&energy);
  std::optional<TiedEnergy> tied;
  if (thin_vertices_->AnyTied()) {
    std::vector<std::vector<ThinVertices::Tied>> ties;
    for (int i = 1; i <= inner; ++i) {
      ties.push_back(thin_vertices_->TiedAt(poses_[piece], poses_[piece + 1], i / (inner + 1.0)));
    }
    tied.emplace(&energy, ties, unknowns);
    objective = [&](const double* x, double* gradient) { return (*tied)(x, gradient); };
  }
  const double count = 3.0 * row.vertices * inner;
  minimise.rank = HistoryRank(count);
  GeodesicSolver solver = options.solver;
  if (solver == GeodesicSolver::kAutomatic) {
    solver = count < kThreadedUnknowns ? GeodesicSolver::kLbfgs : GeodesicSolver::kThreadedLbfgs;
  }
  MinimiseResult result;
  if (solver == GeodesicSolver::kLbfgs) {
    row.solver = "L-BFGS";
    ChangeOfVariables variables(Factor<double>(piece, inner), energy);
    result = MinimiseLbfgs(objective, &variables, minimise, &unknowns);
  } else {
    Preconditioner preconditioner(Factor<float>(piece, inner), energy);
    if (solver == GeodesicSolver::kThreadedLbfgs) {
      row.solver = "own L-BFGS";
      result =
          MinimiseThreadedLbfgs(objective, PreconditionOf(&preconditioner), minimise, &unknowns);
    } else {
      row.solver = "trust region";
      result = MinimiseTrustRegion(*metric_, QuarticWeight(inner, options), minimise, shapes);
      energy.Load(*shapes, unknowns.data());
      result.remaining = RemainingDecrease(&energy, &preconditioner, unknowns);
    }
  }
  if (tied && solver != GeodesicSolver::kTrustRegion) tied->Follow(unknowns.data());
  energy.Store(unknowns.data(), shapes);
  if (metric_->RigidInvariantButForPosition()) {
    RemoveRigidDrift(shapes, metric_->vertex_area);
    energy.Load(*shapes, unknowns.data());
    result.energy = energy.Evaluate(unknowns.data(), nullptr);
  }
  row.termination = result.termination;
  row.iterations = result.iterations;
  row.evaluations = result.evaluations;
  row.initial_energy = ScaledEnergy(result.initial_energy, inner + 1);
  row.energy = ScaledEnergy(result.energy, inner + 1);
  row.remaining = result.remaining;
  row.seconds = stopwatch.Seconds();
  workload->End();
  return row;
}

void Resolution::PlaceThinVertices(int piece, const GeodesicOptions& options,
                                   std::vector<Shape>* shapes) {
  if (thin_vertices_->Empty()) return;
  std::vector<Shape> placed = *shapes;
  const int last = static_cast<int>(placed.size()) - 1;
  for (int i = 1; i < last; ++i) {
    thin_vertices_->Place(poses_[piece], poses_[piece + 1], static_cast<double>(i) / last,
                          &placed[i]);
  }
  if (Energy(placed, options) < Energy(*shapes, options)) *shapes = std::move(placed);
}

double Resolution::Energy(const std::vector<Shape>& shapes, const GeodesicOptions& options) {
  PathEnergy& energy = EnergyOf(static_cast<int>(shapes.size()) - 2, options);
  std::vector<double> unknowns(energy.Size());
  energy.Load(shapes, unknowns.data());
  return energy.Evaluate(unknowns.data(), nullptr);
}

std::vector<double> Resolution::EnergyParts(const std::vector<Shape>& shapes,
                                            const GeodesicOptions& options) {
  PathEnergy& energy = EnergyOf(static_cast<int>(shapes.size()) - 2, options);
  std::vector<double> unknowns(energy.Size());
  energy.Load(shapes, unknowns.data());
  return energy.Parts(unknowns.data());
}

PathEnergy& Resolution::EnergyOf(int inner, const GeodesicOptions& options) {
  if (!energy_) energy_.emplace(metric_, inner);
  energy_->SetInner(inner);
  energy_->SetQuarticWeight(QuarticWeight(inner, options));
  return *energy_;
}

template <typename Scalar>
const CholeskyFactor<Scalar>& Resolution::Factor(int piece, int inner) {
  // Except for the trapezoid's quartic part, one factor is valid for all numbers of shapes and all
  // pieces; rounded to single precision it is equally good as a preconditioner.
  const std::pair<int, int> key = {piece, inner};
  if (metric_->options.discretization == Discretization::kTrapezoid && factors_key_ != key) {
    factors_key_ = key;
    const std::vector<Shape> ends = {poses_[piece], poses_[piece + 1]};
    factors_ = std::make_shared<LazyFactors>(
        [metric = metric_, ends, inner] { return ScalarMetric(*metric, ends, inner + 1); });
  }
  const Stopwatch stopwatch;
  const CholeskyFactor<Scalar>& factor = factors_->Get<Scalar>();
  factor_seconds_ += stopwatch.Seconds();
  return factor;
}

}  // namespace shapespace::internal
