#ifndef SHAPESPACE_TRANSFER_TRANSFER_H_
#define SHAPESPACE_TRANSFER_TRANSFER_H_

#include <memory>
#include <string>
#include <vector>

#include <shapespace/base/not_computed.h>
#include <shapespace/base/progress.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/exponential/transport.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/path.h>

namespace shapespace {

/// Definition of "the same motion" of another body (docs/mathematics.md, section 11).
enum class TransferMethod {
  /// Each shape is the one whose features are nearest to the target's own features plus the change
  /// of the source's. Shapes are found independently of each other.
  kFeatures,
  /// The paper's method: parallel transport along geodesics between the two bodies transports the
  /// source's velocity to the target, and the exponential map computes the target's next shape from
  /// it.
  kLadder,
};

/// The paper's ladder; its rungs are the geodesics between source and target, with hybrids as
/// midpoints.
struct LadderOptions {
  /// Strains and dihedral angles, with strong bending: the target takes over relative edge lengths
  /// and angles of hinges, independently of the two bodies' sizes. (Under the default metric of
  /// geodesics absolute lengths count, and a thinner target bends too far.) With a bending of 0.02
  /// a thinner bar bends by 63 degrees if a thicker one bends by 60; with 0.005 by 70 degrees, but
  /// bodies with joints stretch less.
  MetricOptions metric = Strains();
  static MetricOptions Strains();

  /// Inner shapes of a rung, the geodesic from a shape of the source to the target's corresponding
  /// one. The middle one is the hybrid, so the number must be odd.
  int rung_shapes = 3;

  /// Scale each shape of the source to the target's size (root mean square radius) before it is
  /// compared.
  bool scale = true;

  /// Rotate each shape of the source onto the target's, so that rungs contain no rigid rotation. If
  /// false, rungs rotate along the way, as in the paper.
  bool align = true;

  /// The connection by which the source's velocity is transported along a rung.
  TransportConnection connection = TransportConnection::kLeviCivita;

  /// Tolerance of the geodesics that are the rungs (GeodesicOptions::tolerance).
  double tolerance = 1e-5;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// Options of a transfer.
struct TransferOptions {
  TransferMethod method = TransferMethod::kFeatures;

  /// For `kFeatures`: strains of triangles, dihedral angles, and `lambda`, which here is the weight
  /// of the distance from the result of Sumner and Popovic's transfer. With it limbs end at the
  /// positions of that result, while strains and angles are nearer to the source's.
  MetricOptions metric = Features();
  static MetricOptions Features();

  /// For `kFeatures`: a shape has converged when an iteration lowers the squared distance by less
  /// than this share of the squared change of strains and angles of the source.
  double tolerance = 3e-3;

  /// For `kFeatures`, per shape. A shape that reaches the limit is reported.
  int max_iterations = 50;

  /// Also compute the hybrids, half way between source and target, by the ladder's rungs.
  bool hybrids = false;

  LadderOptions ladder;

  /// Whether the target must not pass through itself, such as a stout body to which the motion of a
  /// slim one is transferred. If it would, each shape is the nearest one, in the metric of the
  /// result, that can be reached from the one before without contact. Otherwise the result is the
  /// same as without. Needs triangles; hybrids may have contact.
  bool avoid_contact = false;

  /// Memory limit in bytes; if the estimate exceeds it, the transfer is refused before it begins.
  double memory_limit = 8e9;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

struct TransferSummary {
  /// The computation of one more shape of the target.
  struct Step {
    bool converged = false;  ///< of the shape; for the ladder: of geodesic, transport and step
    int iterations = 0;
    bool on_mesh = false;  ///< for the ladder: the step was solved on the mesh itself
                           ///< (ExponentialSummary)
    double ratio =
        kNotComputed;  ///< for the ladder: energy of the rung's geodesic over its lower bound
    double norm_change =
        kNotComputed;  ///< for the ladder: |Y| / |X| - 1 of the transported tangent
    std::vector<std::string> warnings;  ///< of the rung's geodesic
    double seconds = 0;
  };

  TransferMethod method = TransferMethod::kFeatures;
  int vertices = 0;
  std::string metric;
  double scale = kNotComputed;  ///< size of the target, as a multiple of the source's
  std::vector<Step> steps;
  /// Difference between the changes of target and source, from their first to their last shapes:
  /// log |e| of edges, weighted by A_e, and dihedral angles of hinges in degrees, weighted by A_f.
  double strain_rms = kNotComputed, strain_max = kNotComputed, angle_rms = kNotComputed;
  /// With TransferOptions::avoid_contact, as in GeodesicSummary: segments whose straight motion has
  /// not been shown to be free of contact, and the least distance of two parts.
  int uncertified_segments = -1;
  double contact_distance = kNotComputed;
  bool cancelled = false;  ///< `progress` asked to stop: the path has the shapes made before
  std::vector<std::string> warnings;
  double estimated_bytes = 0;  ///< of memory, before the transfer
  double total_seconds = 0;

  /// All shapes were made, and converged on the mesh itself.
  bool Converged() const;
  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< a page
  std::string ToJson() const;
};

struct TransferResult {
  /// The target's shapes, at the source's parameters. The first is the target, the only pose; all
  /// others count as extrapolated. Its metric is one under which it can be continued: strains
  /// (`MetricOptions::Strain`), or the ladder's.
  Path path;
  /// Shapes half way between source and target, at the same parameters; in the target's size if
  /// ladder.scale. Empty unless options.hybrids.
  Path hybrids;
  TransferSummary summary;
};

/// Deformation transfer: `target` (3 x m, user's unit; the same connectivity as the source's) makes
/// the motion of the path `source`. The target's rigid motion follows the source's, in its own
/// frame and size: a copy of the source that was translated, rotated and scaled makes the
/// translated, rotated and scaled motion. After Sumner and Popovic (SIGGRAPH 2004) in feature
/// space, or Kilian et al. 2007, section 5, Figure 11.
/// \throw InvalidOptions, MeshError (the source has one shape only; the target has another number
///        of vertices, is not finite, or has no extent), SolverError (memory limit; a shape
///        degenerates), Cancelled (stopped before the target's second shape was made; if stopped
///        later, the path so far is returned, see TransferSummary::cancelled). A target that is a
///        mirror image of the source (`IsMirrored`) is warned of.
TransferResult Transfer(const Path& source, const Shape& target,
                        const TransferOptions& options = {}, Progress* progress = nullptr);

/// Outcome of a transfer of poses.
struct PoseTransferSummary {
  /// For the ladder: the geodesics from the reference to each of the other poses.
  std::vector<GeodesicSummary> geodesics;
  /// One for each of those geodesics; without the ladder only one, with a step for each pose but
  /// the reference.
  std::vector<TransferSummary> transfers;
  bool cancelled = false;  ///< `progress` asked to stop: the poses made before are there

  bool Converged() const;
  std::vector<std::string> Warnings() const;  ///< of all, naming the pose
  std::string BriefReport() const;            ///< one line
  std::string FullReport() const;             ///< pages
  std::string ToJson() const;
};

struct PoseTransferResult {
  /// The target in each of the poses, evenly spaced in time; the path contains no motion between
  /// them.
  Path path;
  Path hybrids;  ///< half way between the poses and these, if options.hybrids
  PoseTransferSummary summary;
};

/// The target in each of `poses` (3 x m, user's unit) but the first, which is the pose of the
/// target itself. With the ladder, the geodesic from the first pose to each other one, under
/// `geodesic`, is transferred along its geodesic.shapes + 1 segments, and the last shape is used.
/// \throw as Interpolate and Transfer; messages of SolverError name the pose, counted from 1.
///        Cancelled, if stopped before the first pose was made.
PoseTransferResult TransferPoses(const std::shared_ptr<const Connectivity>& connectivity,
                                 const std::vector<Shape>& poses, const Shape& target,
                                 const GeodesicOptions& geodesic = {},
                                 const TransferOptions& options = {}, Progress* progress = nullptr);

}  // namespace shapespace

#endif  // SHAPESPACE_TRANSFER_TRANSFER_H_
