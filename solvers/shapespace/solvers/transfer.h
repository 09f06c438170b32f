#ifndef SHAPESPACE_SOLVERS_TRANSFER_H_
#define SHAPESPACE_SOLVERS_TRANSFER_H_

#include <string>
#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/path.h>
#include <shapespace/solvers/exponential.h>
#include <shapespace/solvers/geodesic.h>
#include <shapespace/solvers/transport.h>

namespace shapespace {

/// How a motion is carried over to another body.
struct TransferOptions {
  /// Strains and dihedral angles, with strong bending: what the target takes over is how many per
  /// cent an edge stretches and by how many degrees a hinge folds, whatever the two bodies' sizes.
  /// (Under the default metric of geodesics absolute lengths count, and a thinner target bends too
  /// far.)
  MetricOptions metric = Strains();
  static MetricOptions Strains();

  /// Shapes between a shape of the source and the target's that belongs to it: the rungs of the
  /// ladder. The middle one is the hybrid, so their number must be odd.
  int rung_shapes = 3;

  /// Scale each shape of the source to the target's size (root mean square radius) before it is
  /// compared, and turn it onto the target.
  bool scale = true, align = true;

  /// Of the transport along the rungs; `align` within them follows the one above.
  Connection connection = Connection::kLeviCivita;

  /// Of the geodesics that are the rungs (GeodesicOptions::tolerance).
  double tolerance = 1e-5;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

struct TransferSummary {
  /// One rung: from shape i of the source to the target's shape i, and on to the next.
  struct Rung {
    bool converged = true;   ///< geodesic, transport and step
    bool on_mesh = true;     ///< the step was made on the mesh itself (ExponentialSummary)
    double ratio = 1;        ///< energy of the rung's geodesic over its lower bound
    double norm_change = 0;  ///< |Y| / |X| - 1 of the transported tangent
    double seconds = 0;
  };

  int vertices = 0;
  std::string metric;
  double scale = 1;  ///< size of the target, as a multiple of the source's
  std::vector<Rung> rungs;
  /// At the last shape: how far log |e| / |e_first| of the target is from the source's; root mean
  /// square weighted by A_e, and largest.
  double strain_rms = 0, strain_max = 0;
  std::vector<std::string> warnings;
  double total_seconds = 0;

  bool Converged() const;
  std::string BriefReport() const;  ///< one line
  std::string ToJson() const;
};

struct TransferResult {
  Path path;     ///< the target's shapes, at the source's parameters; the first is the target
  Path hybrids;  ///< half way between source and target, in the target's size, at the same times
  TransferSummary summary;
};

/// Deformation transfer (Kilian et al. 2007, section 5, Figure 11): moves `target` (3 x m, user's
/// unit; the same connectivity as the source's) as the path `source` moves. A ladder: the geodesic
/// from a shape of the source to the target's corresponding shape carries the source's velocity
/// over by parallel transport, and the exponential map makes the target's next shape of it. The
/// target turns and travels as the source does, in its own frame and size: a copy of the source
/// that was moved, turned and scaled makes the moved, turned and scaled motion.
/// \throw InvalidOptions, MeshError (the target has another number of vertices, or no extent),
///        SolverError (a rung's shape degenerates), Cancelled.
TransferResult Transfer(const Path& source, const Shape& target,
                        const TransferOptions& options = {}, Progress* progress = nullptr);

}  // namespace shapespace

#endif  // SHAPESPACE_SOLVERS_TRANSFER_H_
