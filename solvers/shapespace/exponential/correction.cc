#include <shapespace/exponential/correction.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/ranges.h>
#include <shapespace/base/internal/stopwatch.h>
#include <shapespace/exponential/internal/summary_fields.h>
#include <shapespace/geodesic/internal/resolution.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/minimise/internal/minimise.h>
#include <shapespace/minimise/internal/preconditioner.h>
#include <shapespace/path/energy.h>
#include <shapespace/summary/internal/check_options.h>
#include <shapespace/summary/internal/json_of.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace {
namespace {

// A path with less than this share of its deformation left has collapsed. At mu = 1 at least half
// was left of all paths tried; the paper's energy left 0.06 at most at a tolerance of 1e-3.
constexpr double kCollapsed = 1.0 / 3;

// weight * sum_i sum_p A_p |P_i - P_i^given|^2, on the arrays of a path energy.
class Proximity {
 public:
  Proximity(double weight, const Eigen::VectorXd& vertex_area, const PathEnergy& energy,
            std::vector<double> given)
      : stride_(energy.Stride()), row_weights_(vertex_area.size()), given_(std::move(given)) {
    for (int v = 0; v < vertex_area.size(); ++v) {
      row_weights_[energy.Row(v)] = weight * vertex_area(v);
    }
  }

  // Returns the value and, unless null, adds to `gradient`.
  double Add(const double* unknowns, double* gradient) const {
    const int num_rows = static_cast<int>(row_weights_.size());
    std::vector<double> partial(num_rows / internal::kPerTask + 1, 0.0);
    internal::ForRanges(num_rows, [&](int first, int end) {
      for (int row = first; row < end; ++row) {
        const double weight = row_weights_[row];
        const size_t begin = 3 * static_cast<size_t>(row) * stride_;
        for (size_t k = begin; k < begin + 3 * stride_; ++k) {
          const double way = unknowns[k] - given_[k];
          partial[first / internal::kPerTask] += weight * way * way;
          if (gradient != nullptr) gradient[k] += 2 * weight * way;
        }
      }
    });
    return std::accumulate(partial.begin(), partial.end(), 0.0);
  }

 private:
  const size_t stride_;
  std::vector<double> row_weights_, given_;
};

// A metric of edge lengths only, frozen on the path's shapes.
std::shared_ptr<const Metric> FreezeLengths(const Path& path, CorrectionMode mode, double lambda) {
  MetricOptions options = MetricOptions::Isometric();
  options.lambda = lambda;
  options.bending = 0;
  if (mode == CorrectionMode::kPaper) {
    options.weights = Weighting::kUniform;
    options.discretization = Discretization::kTrapezoid;
  }
  return FreezeMetric(options, path.metric->connectivity, {path.shapes.front()}, 1);
}

// The scalar metric. The preconditioner multiplies it by the second difference in time, whose
// smallest eigenvalue is about (pi / n)^2. lambda is chosen such that the product is then the
// weight of the distance from the given shapes.
internal::Cholesky Factor(const Path& path, CorrectionMode mode, double mu) {
  const auto metric = FreezeLengths(path, mode, mu / (internal::kPi * internal::kPi));
  return internal::Cholesky(mode == CorrectionMode::kPaper
                                ? internal::ScalarMetric(*metric,
                                                         {path.shapes.front(), path.shapes.back()},
                                                         path.NumShapes() - 1)
                                : internal::ScalarMetric(*metric, {path.shapes.front()}, 0));
}

double MeanDistance(const Shape& a, const Shape& b, const Eigen::VectorXd& vertex_area) {
  return std::sqrt((a - b).colwise().squaredNorm().dot(vertex_area) / vertex_area.sum());
}

// Distance of the last shape from the first, modulo rigid motion.
double Deformation(const Path& path) {
  const Eigen::VectorXd& area = path.metric->vertex_area;
  const RigidMotion motion = FitRigidMotion(path.shapes.back(), path.shapes.front(), area);
  return MeanDistance(motion(path.shapes.back()), path.shapes.front(), area);
}

void Assess(const Path& given, const Path& path, CorrectionSummary* summary) {
  summary->initial_quality = MeasureQuality(given);
  summary->quality = MeasureQuality(path);
  double squares = 0;
  for (int i = 1; i < path.NumShapes(); ++i) {
    const double distance = MeanDistance(path.shapes[i], given.shapes[i], path.metric->vertex_area);
    squares += distance * distance / summary->shapes;
  }
  summary->distance = std::sqrt(squares);
  const double before = Deformation(given);
  // A path that moves only rigidly has a deformation at the level of rounding.
  constexpr double kNoDeformation = 1e-9;
  summary->deformation_left = before > kNoDeformation ? Deformation(path) / before : 1;
}

void Warn(Termination termination, CorrectionSummary* summary) {
  if (termination == Termination::kMaxIterations) {
    summary->warnings.push_back("out of iterations; raise max_iterations or the tolerance");
  } else if (termination == Termination::kStalled) {
    summary->warnings.push_back("stalled: the line search found no better point");
  } else if (termination == Termination::kCancelled) {
    summary->warnings.push_back("cancelled: the shapes are the best so far");
  }
  if (summary->deformation_left < kCollapsed) {
    const std::string text = internal::Format(
        "the path collapses onto its first shape: %.2g%% of the deformation is left; ",
        100 * summary->deformation_left);
    summary->warnings.push_back(
        text + (summary->mode == CorrectionMode::kPaper ? "use the mode kProximal" : "raise mu"));
  }
}

}  // namespace

void CorrectionOptions::Validate() const {
  if (!(mu >= 0) || !std::isfinite(mu)) throw InvalidOptions("mu", "must be 0 or more, and finite");
  internal::CheckTolerance(tolerance);
  internal::CheckMaxIterations(max_iterations);
}

std::string CorrectionSummary::BriefReport() const {
  return internal::Format(
      "%s (%s): %d vertices, %d shapes corrected; lengths off by %.3g%% rms, before %.3g%%; %.3g%% "
      "of the deformation left; %d iterations, %.2f s",
      converged ? "converged" : "NOT CONVERGED", internal::WordOf(mode), vertices, shapes,
      100 * quality.first_rms, 100 * initial_quality.first_rms, 100 * deformation_left, iterations,
      total_seconds);
}

std::string CorrectionSummary::ToJson() const { return internal::TextOf(internal::JsonOf(*this)); }

CorrectionResult CorrectPath(const Path& path, const CorrectionOptions& options,
                             Progress* progress) {
  options.Validate();
  if (path.NumShapes() < 2) throw MeshError("a path needs at least two shapes to be corrected");
  const internal::Stopwatch total;
  CorrectionResult result;
  CorrectionSummary& summary = result.summary;
  summary.mode = options.mode;
  summary.mu = options.mode == CorrectionMode::kPaper ? 0 : options.mu;
  summary.vertices = path.metric->connectivity->NumVertices();
  summary.shapes = path.NumShapes() - 1;

  ReportProgress(progress, "correcting", 0, 0);
  const int segments = path.NumShapes() - 1;
  const auto lengths = FreezeLengths(path, options.mode, 0);
  PathEnergy energy(lengths, segments, PathEnergy::End::kFree);
  std::vector<double> unknowns(energy.Size());
  energy.Load(path.shapes, unknowns.data());
  const Proximity proximity(2 * summary.mu / (static_cast<double>(segments) * segments),
                            path.metric->vertex_area, energy, unknowns);
  const internal::Cholesky factor = Factor(path, options.mode, summary.mu);
  internal::ChangeOfVariables variables(factor, energy);

  internal::MinimiseOptions minimise;
  minimise.tolerance = options.tolerance;
  // Relative decrease never ends the solve if the minimum is zero, so it also ends at a share of
  // the decrease since the start. Energies are of second order in errors of length, but near a
  // translate the paper's energy is of fourth order in deformations and its predicted decrease of
  // sixth. With these powers errors and deformations are correct to the tolerance's square root.
  minimise.enough = std::pow(options.tolerance, options.mode == CorrectionMode::kPaper ? 3 : 2);
  minimise.max_iterations = options.max_iterations;
  minimise.rank = internal::HistoryRank(static_cast<double>(variables.Size()));
  minimise.keep_going = [&](int iteration, double) {
    return progress == nullptr || progress->Report("correcting", iteration, 0);
  };
  const internal::MinimiseResult minimised = internal::MinimiseLbfgs(
      [&](const double* x, double* gradient) {
        const double value = energy.Evaluate(x, gradient);
        return value + proximity.Add(x, gradient);
      },
      &variables, minimise, &unknowns);

  result.path = path;
  energy.Store(unknowns.data(), &result.path.shapes);
  result.path.provenance += "; corrected";
  summary.termination = minimised.termination;
  summary.converged = summary.termination == Termination::kConverged;
  result.path.converged = path.converged && summary.converged;
  summary.iterations = minimised.iterations;
  summary.evaluations = minimised.evaluations;
  summary.initial_energy = ScaledEnergy(minimised.initial_energy, segments);
  summary.energy = ScaledEnergy(energy.Evaluate(unknowns.data(), nullptr), segments);
  Assess(path, result.path, &summary);
  Warn(minimised.termination, &summary);
  summary.total_seconds = total.Seconds();
  return result;
}

}  // namespace shapespace
