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

/// What it means that another body makes the same motion (docs/mathematics.md, section 11).
enum class TransferMethod {
  /// The shape whose features are nearest to the target's own plus what the source has changed of
  /// its. Every shape is found on its own.
  kFeatures,
  /// The paper's: geodesics between the two bodies carry the source's velocity over by parallel
  /// transport, and the exponential map makes the target's next shape of it.
  kLadder,
};

/// The paper's ladder, and the hybrids on its rungs.
struct LadderOptions {
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

/// How a motion is carried over to another body.
struct TransferOptions {
  TransferMethod method = TransferMethod::kFeatures;

  /// Of `kFeatures`: strains of triangles, dihedral angles, and `lambda`, which here says how
  /// firmly positions are held where Sumner and Popovic's transfer has them: limbs end where it
  /// puts them, strains and angles are nearer to the source's.
  MetricOptions metric = Features();
  static MetricOptions Features();

  /// Of `kFeatures`: a shape is found when an iteration lowers the squared distance by less than
  /// this share of the squared change of strains and angles that is carried over.
  double tolerance = 3e-3;

  /// Of `kFeatures`, a shape. One that runs out of them is reported.
  int max_iterations = 50;

  /// Make the bodies half way between source and target too, by the ladder's rungs.
  bool hybrids = false;

  LadderOptions ladder;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

struct TransferSummary {
  /// To one more shape of the target.
  struct Step {
    bool converged = true;  ///< the shape; of the ladder geodesic, transport and step
    int iterations = 0;
    bool on_mesh = true;     ///< of the ladder: on the mesh itself (ExponentialSummary)
    double ratio = 1;        ///< of the ladder: energy of the rung's geodesic over its lower bound
    double norm_change = 0;  ///< of the ladder: |Y| / |X| - 1 of the transported tangent
    std::vector<std::string> warnings;  ///< of the rung's geodesic
    double seconds = 0;
  };

  TransferMethod method = TransferMethod::kFeatures;
  int vertices = 0;
  std::string metric;
  double scale = 1;  ///< size of the target, as a multiple of the source's
  std::vector<Step> steps;
  /// What the target's last shape did not take over from the source's, both against their first:
  /// log |e| of an edge, weighted by A_e, and a hinge's dihedral angle in degrees, weighted by A_f.
  double strain_rms = 0, strain_max = 0, angle_rms = 0;
  bool cancelled = false;  ///< `progress` asked to stop: there are the shapes made before
  std::vector<std::string> warnings;
  double total_seconds = 0;

  /// All shapes were made and converged, on the mesh itself.
  bool Converged() const;
  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< a page
  std::string ToJson() const;
};

struct TransferResult {
  /// The target's shapes, at the source's parameters. The first is the target, and the only pose;
  /// all others count as extrapolated. Its metric is one that it can be continued under: strains
  /// (`MetricOptions::Strain`), or the ladder's.
  Path path;
  /// Half way between source and target, at the same times; in the target's size if ladder.scale.
  /// No shapes unless options.hybrids.
  Path hybrids;
  TransferSummary summary;
};

/// Deformation transfer: moves `target` (3 x m, user's unit; the same connectivity as the source's)
/// as the path `source` moves. The target turns and travels as the source does, in its own frame
/// and size: a copy of the source that was moved, turned and scaled makes the moved, turned and
/// scaled motion. After Sumner and Popovic (SIGGRAPH 2004) in feature space, or Kilian et al. 2007,
/// section 5, Figure 11.
/// \throw InvalidOptions, MeshError (the source has one shape only; the target has another number
///        of vertices, is not finite, or has no extent), SolverError (a shape degenerates),
///        Cancelled (stopped before the target's second shape was made; later the path so far is
///        returned, TransferSummary::cancelled).
TransferResult Transfer(const Path& source, const Shape& target,
                        const TransferOptions& options = {}, Progress* progress = nullptr);

/// Of poses that were transferred.
struct PoseTransferSummary {
  /// Of the ladder: from the reference to each of the other poses.
  std::vector<GeodesicSummary> geodesics;
  /// Of those geodesics; else one, with a step for each pose but the reference.
  std::vector<TransferSummary> transfers;
  bool cancelled = false;  ///< `progress` asked to stop: poses before are there

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
  Path hybrids;  ///< half way between the poses and these, if options.hybrids
  PoseTransferSummary summary;
};

/// The target in each of `poses` (3 x m, user's unit) but the first, which is the pose that the
/// target is in itself. By the ladder the geodesic from the first to another, under `geodesic`, is
/// transferred, of which geodesic.shapes + 1 rungs are climbed, and its end kept.
/// \throw as Interpolate and Transfer; messages of SolverError name the pose, counted from 1.
///        Cancelled, if stopped before the first pose was made.
PoseTransferResult TransferPoses(const std::shared_ptr<const Connectivity>& connectivity,
                                 const std::vector<Shape>& poses, const Shape& target,
                                 const GeodesicOptions& geodesic = {},
                                 const TransferOptions& options = {}, Progress* progress = nullptr);

}  // namespace shapespace

#endif  // SHAPESPACE_SOLVERS_TRANSFER_H_
