#ifndef SHAPESPACE_SOLVERS_TRANSPORT_H_
#define SHAPESPACE_SOLVERS_TRANSPORT_H_

#include <string>
#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/path/path.h>

namespace shapespace {

/// What "the same tangent" means at another shape (docs/mathematics.md, section 10).
enum class Connection {
  kLeviCivita,  ///< the metric's own: order 2, never makes a tangent longer, and shorter only in
                ///< the fourth order
  kConstrainedProjection,  ///< the paper's: least Euclidean change that keeps the product with the
                           ///< path's velocity; keeps neither norm nor rotation
};

struct TransportOptions {
  Connection connection = Connection::kLeviCivita;

  /// Before each step of the metric's own scheme, turn the shape onto the next one, and the
  /// tangent with it: what is carried turns with the body, exactly where that moves rigidly.
  /// Without, the bare connection leaves the rigid part of a tangent behind when the body turns.
  bool align = true;

  /// Error of a step's linear systems in the metric, as a share of the tangent's norm.
  double tolerance = 1e-12;

  /// Of the linear solver, a step and tangent. A step that runs out of them is reported.
  int max_iterations = 200;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

struct TransportSummary {
  /// A segment of the path.
  struct Step {
    int krylov_iterations = 0;  ///< most over the tangents
    double residual = 0;        ///< largest over the tangents
    double seconds = 0;
  };

  bool converged = true;  ///< every step reached the tolerance
  std::string metric;
  std::vector<Step> steps;
  /// Norms of every tangent under the metric, before and after. Where the connection is the
  /// metric's own, what the second lacks tells how coarse the path is.
  std::vector<double> first_norm, last_norm;
  double total_seconds = 0;

  std::string BriefReport() const;  ///< one line
};

struct TransportResult {
  std::vector<Tangent> tangents;  ///< as they were given, but at the last shape
  TransportSummary summary;
};

/// Carries `tangents` (3 x m each, at the path's first shape as placed, user's unit) along the path
/// to its last shape, as placed: parallel transport (Kilian et al. 2007, section 5). One
/// factorisation a segment serves all of them. The rigid motion that the path carries turns them
/// with the shapes.
/// \throw InvalidOptions (also if the metric is rigid), MeshError (a tangent of the wrong size or
///        not finite, a path of one shape), SolverError (the metric is not definite; for
///        kConstrainedProjection, the path stands still), Cancelled.
TransportResult Transport(const Path& path, const std::vector<Tangent>& tangents,
                          const TransportOptions& options = {}, Progress* progress = nullptr);

}  // namespace shapespace

#endif  // SHAPESPACE_SOLVERS_TRANSPORT_H_
