#ifndef SHAPESPACE_EXPONENTIAL_EXPONENTIAL_H_
#define SHAPESPACE_EXPONENTIAL_EXPONENTIAL_H_

#include <memory>
#include <string>
#include <vector>

#include <shapespace/base/not_computed.h>
#include <shapespace/base/progress.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/path.h>

namespace shapespace {

/// How a geodesic is continued (docs/mathematics.md, section 8).
enum class GeodesicIntegrator {
  kVariational,    ///< discrete Euler-Lagrange equation: order 2, momenta conserved up to rounding
  kFirstIntegral,  ///< the paper's (7), which does not converge: for comparison only
};

/// Solver for a step of the variational integrator.
enum class StepSolver {
  kNewtonKrylov,  ///< matrix-free, preconditioned by a sparse factor of the metric
  kCeres,         ///< Ceres' trust region on automatically differentiated residuals, small meshes
                  ///< only
};

/// Solver for the paper's (7), a nonlinear least squares problem in the next velocity. Both are
/// Ceres', on the same automatically differentiated residuals. With neither does the end of the
/// path converge as the step goes to zero: docs/mathematics.md, section 8.
enum class FirstIntegralSolver {
  kLbfgs,               ///< L-BFGS, as in the paper
  kLevenbergMarquardt,  ///< finds a root more often, but its path is no closer to a geodesic
};

/// Options of shooting.
struct ExponentialOptions {
  GeodesicIntegrator integrator = GeodesicIntegrator::kVariational;
  StepSolver solver = StepSolver::kNewtonKrylov;                            ///< kVariational only
  FirstIntegralSolver first_integral_solver = FirstIntegralSolver::kLbfgs;  ///< kFirstIntegral only

  /// A step has converged when its residual is less than this share of the step itself.
  /// kNewtonKrylov measures both in the metric, kCeres in coordinates; kFirstIntegral compares the
  /// residual with the one at velocity zero.
  double tolerance = 1e-9;

  /// Limit on the iterations of Newton's method or Ceres in a step. Most steps of kVariational take
  /// four; steps that need increments (ExponentialSummary::Step::increments) take several per
  /// increment. A step that reaches the limit is taken over from a coarser resolution and reported
  /// as not converged; kFirstIntegral continues with its last iterate.
  int max_iterations = 100;

  /// Whether the path ends before the first step during whose straight motion parts of the body
  /// touch. Not seen are contacts of parts that are nearer to each other on the surface than two
  /// edges, and of parts that intersect where the path begins. Needs triangles.
  bool stop_at_contact = false;

  /// In place of `stop_at_contact`: whether parts slide along each other from there on. Each shape
  /// is the nearest one, in the metric, to that of the geodesic which can be reached from the one
  /// before without contact. The figures of the steps are those of the geodesic.
  bool slide_at_contact = false;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// Outcome of an extrapolation and figures that tell how reliable it is.
struct ExponentialSummary {
  enum class Ending {
    kComplete,    ///< all steps were made
    kDegenerate,  ///< the shape degenerated: the path ends before it (`stopped` says where and why)
    kContact,     ///< as asked for, the path ends before parts of the body touch (`stopped`)
    kCancelled,   ///< `progress` asked to stop: the path ends with the steps made before
  };

  struct Step {
    double t = kNotComputed;  ///< parameter of the shape that the step reached
    bool converged = false;   ///< the step reached the tolerance on the finest level
    /// Vertices of the resolution on which a root was found: the mesh itself, or a coarser
    /// resolution whose step was lifted with all detail. 0 if there was a root on none; then the
    /// step is the shape whose features are nearest to those that the coarsest step required.
    int vertices = 0;
    /// Number of load increments of Newton's method or Ceres on the mesh itself: 1 if the full step
    /// was solved directly, 0 if nothing had to be solved.
    int increments = 0;
    int iterations = 0;  ///< of Newton's method or Ceres, over all increments
    int krylov_iterations = 0;
    double residual = kNotComputed;  ///< at the end, on the mesh itself, as a share of the step
    double energy =
        kNotComputed;  ///< of the segment, scaled to a whole path: constant along a geodesic
    double momentum_drift = kNotComputed;  ///< change of linear and angular momentum since the
                                           ///< first step, as a share
    double edge_rms = kNotComputed,
           edge_max = kNotComputed;  ///< | |e| / |e_first| - 1 |; rms weighted by A_e
    /// Share of the area whose triangles turned over relative to their neighbourhood.
    double inverted = kNotComputed;
    double seconds = 0;
  };

  Ending ending = Ending::kCancelled;
  std::string stopped;  ///< a sentence, if the path ended early
  GeodesicIntegrator integrator = GeodesicIntegrator::kVariational;
  int vertices = 0;
  int requested_steps = 0;
  std::string metric;
  std::vector<Step> steps;  ///< those that were made
  /// With ExponentialOptions::slide_at_contact, as in GeodesicSummary: segments whose straight
  /// motion has not been shown to be free of contact, and the least distance of two parts.
  int uncertified_segments = -1;
  double contact_distance = kNotComputed;
  std::vector<std::string> warnings;
  double total_seconds = 0, factor_seconds = 0;
  int factorisations = 0;

  /// All steps were made, or all before a contact, and all converged on the mesh itself.
  bool Converged() const;
  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< a page
  std::string ToJson() const;
};

struct ExponentialResult {
  Path path;
  ExponentialSummary summary;
};

/// Continues a path (Kilian et al. 2007, section 4) by `steps` shapes along the geodesic through
/// its last two shapes, with their spacing in time. The path's rigid motion continues too: the
/// rotation at its angular velocity, the centroid on its straight line. The metric is the path's
/// own; a path made in trapezoid form is continued in midpoint form, with a warning. Under a metric
/// without a cost of position (lambda 0) rigid motions cost nothing: all functions here then shoot
/// under a lambda of 1e-6, with which linear and angular momentum are conserved.
/// \throw InvalidOptions (also if the metric is rigid, or steps < 1), MeshError (fewer than two
///        shapes), SolverError, Cancelled (stopped before the first step was made; if stopped
///        later, the path so far is returned with Ending::kCancelled).
ExponentialResult Extrapolate(const Path& path, int steps, const ExponentialOptions& options = {},
                              Progress* progress = nullptr);

/// The geodesic from `shape` (3 x m, user's unit) with initial `velocity` (user's unit per unit of
/// time) over unit time in `steps` steps: parameters 0 ... 1.
/// \throw as above; MeshError if shape or velocity has the wrong size or is not finite.
ExponentialResult Extrapolate(const std::shared_ptr<const Metric>& metric, const Shape& shape,
                              const Tangent& velocity, int steps,
                              const ExponentialOptions& options = {}, Progress* progress = nullptr);

/// The exponential map: the end of that geodesic, in the user's unit and frame. Since no summary is
/// returned, it fails unless all steps converged on the mesh itself; use Extrapolate to accept
/// steps that were solved on coarser meshes.
/// \throw as above; SolverError if a step did not converge on the mesh itself, or the shape
///        degenerates before the end; Cancelled, whenever `progress` stops it.
Shape Exponential(const std::shared_ptr<const Metric>& metric, const Shape& shape,
                  const Tangent& velocity, int steps = 16, const ExponentialOptions& options = {},
                  Progress* progress = nullptr);

/// Options of the logarithm: a geodesic solved to much higher accuracy than is needed for viewing.
/// The error of the logarithm is proportional to the square root of the path's tolerance. With
/// these defaults Exponential ends near the other shape: the distance of the two is about a
/// hundred-thousandth of that between the shapes, and less than 1e-4 of it on random bodies. Parts
/// whose motion costs next to nothing, such as a corner of a sheet that does not resist bending,
/// may be farther away, by some thousandths of the diameter.
struct LogarithmOptions : GeodesicOptions {
  LogarithmOptions() {
    tolerance = 1e-12;
    max_iterations = 5000;
  }
};

/// The logarithm: the initial velocity (user's unit) of the geodesic from `from` to `to`, after a
/// rigid motion that aligns `to` with `from`. It is computed from a path of options.shapes inner
/// shapes under `metric` (options.metric is not read), so that Exponential with options.shapes + 1
/// steps ends at `to` to the accuracy of options.tolerance (not for a trapezoid metric, because
/// shooting uses the midpoint form).
/// \throw as Interpolate; InvalidOptions if the metric is rigid; SolverError if the path did not
///        converge.
Tangent Logarithm(const std::shared_ptr<const Metric>& metric, const Shape& from, const Shape& to,
                  const LogarithmOptions& options = {}, Progress* progress = nullptr);

/// The initial velocity of a path, from its first two shapes: in the user's unit and frame, per
/// unit of the path's parameter. It is the sum of the velocity of deformation and that of the
/// path's rigid motion, a rotation at constant speed about the centroid, which moves on a straight
/// line. Extrapolating the first shape with it, by steps as long as the first segment, gives the
/// second shape: exactly if the motion does not rotate, otherwise up to an error of second order in
/// the segment's length in time.
/// \throw InvalidOptions if the metric is rigid; MeshError (fewer than two shapes), SolverError.
Tangent InitialVelocity(const Path& path);

}  // namespace shapespace

#endif  // SHAPESPACE_EXPONENTIAL_EXPONENTIAL_H_
