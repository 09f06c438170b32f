#ifndef SHAPESPACE_EXPONENTIAL_CORRECTION_H_
#define SHAPESPACE_EXPONENTIAL_CORRECTION_H_

#include <string>
#include <vector>

#include <shapespace/analysis/quality.h>
#include <shapespace/base/not_computed.h>
#include <shapespace/base/progress.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/path/path.h>

namespace shapespace {

/// What a correction minimises over all shapes of a path but the first.
enum class CorrectionMode {
  kProximal,  ///< the change of edge lengths along the path, and the distance from the given shapes
  kPaper,     ///< the energy (6) alone with lambda 0, as in the paper. Its minimum is a translate
              ///< of the first shape, so the deformation is lost: for comparison only
};

/// How to correct.
struct CorrectionOptions {
  CorrectionMode mode = CorrectionMode::kProximal;

  /// Weight of the distance from the given shapes, a pure number with the same meaning for any
  /// number of shapes. Small values preserve lengths: once the errors of length are small, they are
  /// proportional to mu. Large values preserve the given motion, much of which closed surfaces
  /// cannot follow without stretching. At 0 lengths stay constant at any cost in distance. kPaper
  /// has no such term and ignores it.
  double mu = 1;

  /// Converged when an iteration lowers the objective by less than this share of it. On real meshes
  /// 1e-3 leaves errors of length within a quarter of the least. An exact minimum takes hundreds of
  /// iterations, because the problem is ill-conditioned: distance costs far less than length.
  double tolerance = 1e-3;

  /// Reaching it is reported as not converged.
  int max_iterations = 500;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// What happened, and what the correction cost.
struct CorrectionSummary {
  CorrectionMode mode = CorrectionMode::kProximal;
  double mu = kNotComputed;  ///< 0 for kPaper
  int vertices = 0;
  int shapes = 0;  ///< free to move: all but the first
  Termination termination = Termination::kCancelled;
  bool converged = false;  ///< the same as kConverged
  int iterations = 0, evaluations = 0;
  /// Energy of the edge lengths (kPaper: with the quartic part of (6)), scaled: E n / 2 for n
  /// segments.
  double initial_energy = kNotComputed, energy = kNotComputed;
  /// first_rms, first_p99 and first_max are the errors of length relative to the first shape.
  PathQuality initial_quality, quality;
  /// Area-weighted root mean square distance from the given shapes, in the metric's unit (the
  /// square root of the surface area).
  double distance = kNotComputed;
  /// Distance of the last shape from the first modulo rigid motion, as a share of the same distance
  /// on the given path: 0 if the path has collapsed, 1 if the given path had no deformation.
  double deformation_left = kNotComputed;
  std::vector<std::string> warnings;  ///< to be checked by the user
  double total_seconds = 0;

  std::string BriefReport() const;  ///< one line
  std::string ToJson() const;
};

struct CorrectionResult {
  Path path;
  CorrectionSummary summary;
};

/// Brings the edge lengths of an extrapolated path back towards those of its first shape (Kilian et
/// al. 2007, section 4, "error correction"). The first shape stays as it is; all others are free to
/// move, including the last. Minimises, over n segments,
///   2 sum_i sum_e w_e ((|e_{i+1}|^2 - |e_i|^2) / 2)^2
///     + (2 mu / n^2) sum_i sum_p A_p |P_i - P_i^given|^2.
/// n / 2 times this is the integral of the squared speed of the edge lengths plus mu times the
/// squared distance. The weights w_e are frozen on the first shape and A_p are the areas of the
/// path's metric; its other coefficients are not used. The paper's own energy has no second term
/// and collapses (CorrectionMode::kPaper). Metric, motions, parameters and poses of the path are
/// kept. The correction trades motion for lengths; paths made by `Extrapolate` hardly need it.
/// \throw InvalidOptions, MeshError (fewer than two shapes; see FreezeMetric), SolverError (a shape
///        that is not finite), Cancelled (stopped by `progress` before the first iteration; if
///        stopped later, the best path so far is returned as not converged, with a warning).
CorrectionResult CorrectPath(const Path& path, const CorrectionOptions& options = {},
                             Progress* progress = nullptr);

}  // namespace shapespace

#endif  // SHAPESPACE_EXPONENTIAL_CORRECTION_H_
