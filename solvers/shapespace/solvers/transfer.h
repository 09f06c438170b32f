#ifndef SHAPESPACE_SOLVERS_TRANSFER_H_
#define SHAPESPACE_SOLVERS_TRANSFER_H_

#include <memory>
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
  /// far.) A bending of 0.02 bends a thinner bar by 63 degrees as a thicker one bends by 60; 0.005
  /// bends it by 70, but stretches bodies with joints less.
  MetricOptions metric = Strains();
  static MetricOptions Strains();

  /// Shapes between a shape of the source and the target's that belongs to it: the rungs of the
  /// ladder. The middle one is the hybrid, so their number must be odd.
  int rung_shapes = 3;

  /// Scale each shape of the source to the target's size (root mean square radius) before it is
  /// compared.
  bool scale = true;

  /// Turn each shape of the source onto the target's, so that tangents are carried between the
  /// shapes alone. Without, rungs turn on their way, as the paper has them.
  bool align = true;

  /// What carries the source's velocity along a rung.
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
  /// What the target's last shape did not take over from the source's, both against their first:
  /// log |e| of an edge, weighted by A_e, and a hinge's dihedral angle in degrees, weighted by A_f.
  double strain_rms = 0, strain_max = 0, angle_rms = 0;
  bool cancelled = false;  ///< `progress` asked to stop: there are the shapes made before
  std::vector<std::string> warnings;
  double total_seconds = 0;

  /// All rungs were climbed and converged, and all steps were made on the mesh itself.
  bool Converged() const;
  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< a page
  std::string ToJson() const;
};

struct TransferResult {
  /// The target's shapes, at the source's parameters. The first is the target, and the only pose;
  /// all others count as extrapolated.
  Path path;
  /// Half way between source and target, at the same times; in the target's size if options.scale.
  Path hybrids;
  TransferSummary summary;
};

/// Deformation transfer (Kilian et al. 2007, section 5, Figure 11): moves `target` (3 x m, user's
/// unit; the same connectivity as the source's) as the path `source` moves. A ladder: the geodesic
/// from a shape of the source to the target's corresponding shape carries the source's velocity
/// over by parallel transport, and the exponential map makes the target's next shape of it. The
/// target turns and travels as the source does, in its own frame and size: a copy of the source
/// that was moved, turned and scaled makes the moved, turned and scaled motion.
/// \throw InvalidOptions, MeshError (the source has one shape only; the target has another number
///        of vertices, is not finite, or has no extent), SolverError (a rung's shape degenerates),
///        Cancelled (stopped before the target's second shape was made; later the path so far is
///        returned, TransferSummary::cancelled).
TransferResult Transfer(const Path& source, const Shape& target,
                        const TransferOptions& options = {}, Progress* progress = nullptr);

/// Of poses that were transferred one by one.
struct PoseTransferSummary {
  std::vector<GeodesicSummary> geodesics;  ///< from the reference to each of the other poses
  std::vector<TransferSummary> transfers;  ///< of those geodesics
  bool cancelled = false;                  ///< `progress` asked to stop: poses before are there

  bool Converged() const;
  std::vector<std::string> Warnings() const;  ///< of all, saying of which pose
  std::string BriefReport() const;            ///< one line
  std::string FullReport() const;             ///< pages
  std::string ToJson() const;
};

struct PoseTransferResult {
  /// The target, and what became of it for each of the other poses, evenly spaced in time: no
  /// motion from one to the next.
  Path path;
  Path hybrids;  ///< half way between the poses and these, in the target's size
  PoseTransferSummary summary;
};

/// The target in each of `poses` (3 x m, user's unit) but the first, which is the pose that the
/// target is in itself: the geodesic from the first to another is transferred, of which
/// options.shapes + 1 rungs are climbed, and its end kept.
/// \throw as Interpolate and Transfer; messages of SolverError name the pose, counted from 1.
///        Cancelled, if stopped before the first pose was made.
PoseTransferResult TransferPoses(const std::shared_ptr<const Connectivity>& connectivity,
                                 const std::vector<Shape>& poses, const Shape& target,
                                 const GeodesicOptions& geodesic = {},
                                 const TransferOptions& options = {}, Progress* progress = nullptr);

}  // namespace shapespace

#endif  // SHAPESPACE_SOLVERS_TRANSFER_H_
