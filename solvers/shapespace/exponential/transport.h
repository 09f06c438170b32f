#ifndef SHAPESPACE_EXPONENTIAL_TRANSPORT_H_
#define SHAPESPACE_EXPONENTIAL_TRANSPORT_H_

#include <string>
#include <vector>

#include <shapespace/base/not_computed.h>
#include <shapespace/base/progress.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/path/path.h>

namespace shapespace {

/// Definition of transport of a tangent to another shape (docs/mathematics.md, section 10).
enum class TransportConnection {
  kLeviCivita,  ///< the metric's own: order 2; the norm of a tangent never grows, and shrinks only
                ///< to fourth order in the step
  kConstrainedProjection,  ///< the paper's: least Euclidean change that preserves the product with
                           ///< the path's velocity; preserves neither norm nor rotation
};

struct TransportOptions {
  TransportConnection connection = TransportConnection::kLeviCivita;

  /// Before each step of kLeviCivita, align the shape with the next one and rotate the tangent with
  /// it. Tangents then turn with the body, exactly where the body moves rigidly. If false, a
  /// tangent does not turn with the rigid rotation of the body.
  bool align = true;

  /// Tolerance of the linear systems of a step, in the metric, as a share of the tangent's norm.
  double tolerance = 1e-12;

  /// Iterations of the linear solver, per step and tangent. A step that reaches the limit is
  /// reported.
  int max_iterations = 200;

  /// Memory limit in bytes; if the estimate exceeds it, the call is refused before anything is
  /// allocated.
  double memory_limit = 8e9;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

struct TransportSummary {
  /// One segment of the path.
  struct Step {
    int krylov_iterations = 0;       ///< maximum over the tangents
    double residual = kNotComputed;  ///< maximum over the tangents; NaN for kConstrainedProjection
    double seconds = 0;
  };

  bool converged = false;  ///< every step reached the tolerance
  std::string metric;
  std::vector<Step> steps;
  /// Norms of each tangent under the metric, before and after. With kLeviCivita, the loss of norm
  /// shows how coarse the path is.
  std::vector<double> first_norm, last_norm;
  double estimated_bytes = 0;  ///< of memory, before the call
  double total_seconds = 0;

  std::string BriefReport() const;  ///< one line
};

struct TransportResult {
  std::vector<Tangent> tangents;  ///< in the given order, at the last shape
  TransportSummary summary;
};

/// Transports `tangents` (3 x m each, at the path's first shape as placed, user's unit) along the
/// path to its last shape as placed: parallel transport (Kilian et al. 2007, section 5). Each
/// segment is factorised once for all tangents. The path's rigid motion rotates the tangents with
/// the shapes. Under a metric without a cost of position (lambda 0) a lambda of 1e-6 is added,
/// because rigid motions would cost nothing.
/// \throw InvalidOptions (also if the metric is rigid), MeshError (a tangent of the wrong size or
///        not finite, a path of one shape), SolverError (memory limit; the metric is not definite;
///        for kConstrainedProjection, the path stands still), Cancelled.
TransportResult Transport(const Path& path, const std::vector<Tangent>& tangents,
                          const TransportOptions& options = {}, Progress* progress = nullptr);

}  // namespace shapespace

#endif  // SHAPESPACE_EXPONENTIAL_TRANSPORT_H_
