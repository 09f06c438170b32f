#ifndef SHAPESPACE_SOLVERS_EXPONENTIAL_H_
#define SHAPESPACE_SOLVERS_EXPONENTIAL_H_

#include <memory>
#include <string>
#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/path.h>
#include <shapespace/solvers/geodesic.h>

namespace shapespace {

/// How a geodesic is continued (docs/mathematics.md, section 8).
enum class Integrator {
  kVariational,    ///< discrete Euler-Lagrange equation: order 2, momenta kept to rounding
  kRungeKutta4,    ///< of the geodesic equation: order 4, no safeguard against large steps
  kFirstIntegral,  ///< the paper's (7), which does not converge: for comparison only
};

/// What solves a step of the variational integrator.
enum class StepSolver {
  kNewtonKrylov,  ///< matrix-free, preconditioned by a sparse factor of the metric
  kCeres,         ///< Ceres' trust region on automatically differentiated rows, small meshes only
};

/// What solves the paper's (7) for the next velocity, as a nonlinear least squares problem: both
/// are Ceres', on the same automatically differentiated rows. With neither does the end of the path
/// converge with the step: docs/mathematics.md, section 8.
enum class FirstIntegralSolver {
  kLbfgs,               ///< L-BFGS, as in the paper
  kLevenbergMarquardt,  ///< finds a root more often, which brings the path no nearer to a geodesic
};

/// How to shoot.
struct ExponentialOptions {
  Integrator integrator = Integrator::kVariational;
  StepSolver solver = StepSolver::kNewtonKrylov;                            ///< kVariational only
  FirstIntegralSolver first_integral_solver = FirstIntegralSolver::kLbfgs;  ///< kFirstIntegral only

  /// A step is solved when its residual, measured in the metric (kCeres and kFirstIntegral: by its
  /// coordinates), is this share of the step itself (kFirstIntegral: of what it is at rest).
  double tolerance = 1e-9;

  /// Of Newton's method in a step, or of Ceres. Most steps of kVariational take four; those that
  /// must be approached in increments (ExponentialSummary::Step::increments) several for each. A
  /// step that runs out of them is taken over from a coarser resolution, and says so.
  /// kFirstIntegral goes on with what it has.
  int max_iterations = 100;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// What happened on the way, and how far it can be trusted.
struct ExponentialSummary {
  enum class Ending {
    kComplete,    ///< all steps were made
    kDegenerate,  ///< the shape degenerated: the path ends before (`stopped` says where and why)
    kCancelled,   ///< `progress` asked to stop: the path ends with the steps made before
  };

  struct Step {
    double t = 0;            ///< parameter of the shape that the step reached
    bool converged = false;  ///< reached the tolerance on the mesh itself
    /// Of the resolution on which a root was found: the mesh's own, or a coarser one's, whose step
    /// was taken over with all detail; 0 if on none, and the nearest shape in feature space to what
    /// the coarsest step asked for was taken.
    int vertices = 0;
    /// In which Newton's method, or Ceres, approached the root on the mesh itself: 1 where it was
    /// reached at once, 0 where nothing had to be solved.
    int increments = 0;
    int iterations = 0;  ///< of Newton's method, or of Ceres, in all of them
    int krylov_iterations = 0;
    double residual = 0;  ///< at the end, on the mesh itself, share of the step
    double energy = 0;    ///< of the segment, scaled as a whole path's: constant on a geodesic
    double momentum_drift = 0;  ///< change of linear and angular momentum since the start, share
    double edge_rms = 0, edge_max = 0;  ///< | |e| / |e_first| - 1 |, weighted by A_e and not
    double inverted =
        0;  ///< share of the area whose triangles turned over against their surroundings
    double seconds = 0;
  };

  Ending ending = Ending::kComplete;
  std::string stopped;  ///< a sentence, if it ended early
  Integrator integrator = Integrator::kVariational;
  int vertices = 0;
  int requested_steps = 0;
  std::string metric;
  std::vector<Step> steps;  ///< those that were made
  std::vector<std::string> warnings;
  double total_seconds = 0, factor_seconds = 0;
  int factorisations = 0;

  /// All steps were made, and all converged on the mesh itself.
  bool Converged() const;
  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< a page
  std::string ToJson() const;
};

struct ExponentialResult {
  Path path;
  ExponentialSummary summary;
};

/// Continues a path (Kilian et al. 2007, section 4) by `steps` shapes: the geodesic through its
/// last two shapes, at their distance in time. What the path carries as rigid motion goes on: the
/// rotation at its speed, the centroid along its line. The path's own metric decides; one made in
/// trapezoid form is continued by the midpoint's, and a warning says so. \throw InvalidOptions
/// (also if the metric is rigid, or steps < 1), MeshError (fewer than two
///        shapes), SolverError, Cancelled (stopped before the first step was made; later the path
///        so far is returned, Ending::kCancelled).
ExponentialResult Extrapolate(const Path& path, int steps, const ExponentialOptions& options = {},
                              Progress* progress = nullptr);

/// The geodesic from `shape` (3 x m, user's unit) with initial `velocity` (user's unit per unit of
/// time) over unit time in `steps` steps: parameters 0 ... 1.
/// \throw as above; MeshError if shape or velocity has the wrong size or is not finite.
ExponentialResult Extrapolate(const std::shared_ptr<const Metric>& metric, const Shape& shape,
                              const Tangent& velocity, int steps,
                              const ExponentialOptions& options = {}, Progress* progress = nullptr);

/// exp: the end of that geodesic, user's unit and place. There is no summary that could say how far
/// to trust it, so it is refused unless all steps converged on the mesh itself; what goes on
/// coarser meshes is had from Extrapolate. \throw as above; SolverError if a step did not converge
/// on the mesh itself, or the shape degenerates before the end.
Shape Exponential(const std::shared_ptr<const Metric>& metric, const Shape& shape,
                  const Tangent& velocity, int steps = 16, const ExponentialOptions& options = {});

/// How to find a logarithm: a geodesic as shooting needs it, solved far beyond what the eye sees.
/// The error of the logarithm goes with the root of the path's tolerance. With these defaults
/// Exponential leads back to within 1e-5 of the diameter.
struct LogarithmOptions : GeodesicOptions {
  LogarithmOptions() {
    tolerance = 1e-12;
    max_iterations = 5000;
  }
};

/// log: the initial velocity of the geodesic from `from` to `to` (user's unit), which is first
/// moved rigidly onto it. Computed from a path of options.shapes inner shapes under `metric`
/// (options.metric is not read), so that Exponential with options.shapes + 1 steps leads to `to`,
/// as closely as options.tolerance lets it (not for a trapezoid metric: shooting is in midpoint
/// form). \throw as Interpolate; InvalidOptions if the metric is rigid; SolverError if the path did
/// not converge.
Tangent Logarithm(const std::shared_ptr<const Metric>& metric, const Shape& from, const Shape& to,
                  const LogarithmOptions& options = {}, Progress* progress = nullptr);

/// The velocity with which a path sets out, from its first two shapes: user's unit and place, per
/// unit of its parameter. It has two parts: how the shape deforms, and how the path's rigid motion
/// carries it, rotating at constant speed about its centroid, which moves on a straight line.
/// Extrapolate from the first shape with it, in steps as long as the first segment, gives the
/// second: exactly where the motion does not turn, and else but for an error of second order in the
/// segment's length in time. \throw InvalidOptions if the metric is rigid; MeshError (fewer
/// than two shapes), SolverError.
Tangent InitialVelocity(const Path& path);

}  // namespace shapespace

#endif  // SHAPESPACE_SOLVERS_EXPONENTIAL_H_
