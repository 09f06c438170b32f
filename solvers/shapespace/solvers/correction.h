#ifndef SHAPESPACE_SOLVERS_CORRECTION_H_
#define SHAPESPACE_SOLVERS_CORRECTION_H_

#include <string>
#include <vector>

#include <shapespace/analysis/quality.h>
#include <shapespace/base/progress.h>
#include <shapespace/path/path.h>

namespace shapespace {

/// What a correction minimises over all shapes of a path but the first.
enum class CorrectionMode {
  kProximal,  ///< the change of edge lengths along the path, and the distance from the given shapes
  kPaper,     ///< the energy (6) alone, lambda 0, as the paper has it. Nothing holds its minimum,
              ///< a translate of the first shape, away from it: for comparison only
};

/// How to correct.
struct CorrectionOptions {
  CorrectionMode mode = CorrectionMode::kProximal;

  /// Weight of the distance from the given shapes, a pure number that means the same for any number
  /// of shapes. Small values keep lengths: errors of length fall in proportion to it once they are
  /// small. Large ones keep the given motion, much of which closed surfaces cannot follow without
  /// stretching. At 0 lengths stay constant at any price. kPaper has no such term and ignores it.
  double mu = 1;

  /// Done when an iteration lowers what is minimised by less than this share of it. On real meshes
  /// 1e-3 leaves errors of length within a quarter of the least; an exact minimum takes hundreds
  /// of iterations, as what costs only distance is soft beside what costs length.
  double tolerance = 1e-3;

  /// Reaching it is reported as not converged.
  int max_iterations = 500;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// What happened, and what the correction cost.
struct CorrectionSummary {
  CorrectionMode mode = CorrectionMode::kProximal;
  double mu = 0;  ///< 0 for kPaper
  int vertices = 0;
  int shapes = 0;  ///< that were free to move: all but the first
  bool converged = false;
  int iterations = 0, evaluations = 0;
  /// Of the edge lengths (kPaper: with the quartic part of (6)), scaled: E n / 2 for n segments.
  double initial_energy = 0, energy = 0;
  /// Errors of length are the figures against the first shape: first_rms, first_p99, first_max.
  PathQuality initial_quality, quality;
  /// Root mean square distance from the given shapes, weighted by area; in the metric's unit, the
  /// root of the body's area.
  double distance = 0;
  /// How far the last shape is from the first modulo rigid motion, as a share of what it was: 0 if
  /// the path has collapsed, 1 if there was no deformation to lose.
  double deformation_left = 1;
  std::vector<std::string> warnings;  ///< what a person should look at
  double total_seconds = 0;

  std::string BriefReport() const;  ///< one line
  std::string ToJson() const;
};

struct CorrectionResult {
  Path path;
  CorrectionSummary summary;
};

/// Brings the edge lengths of an extrapolated path back towards those of its first shape (Kilian et
/// al. 2007, section 4, "error correction"), which stays as it is; all others are free to move, the
/// last too. Minimises, over n segments,
///   2 sum_i sum_e w_e ((|e_{i+1}|^2 - |e_i|^2) / 2)^2
///     + (2 mu / n^2) sum_i sum_p A_p |P_i - P_i^given|^2,
/// times n / 2 the integral of the squared speed in edge lengths and of mu times the squared
/// distance. w_e is frozen on the first shape, A_p are the areas of the path's metric, whose other
/// coefficients do not matter here. The paper's own energy has no second term and collapses
/// (CorrectionMode::kPaper). Metric, motions, parameters and poses of the path are kept.
/// It trades motion for lengths: a path by `Extrapolate` hardly needs it.
/// \throw InvalidOptions, MeshError (fewer than two shapes; see FreezeMetric), SolverError (a shape
///        that is not finite), Cancelled (stopped by `progress` before the first iteration; later
///        the best so far is returned, as not converged, with a warning).
CorrectionResult CorrectPath(const Path& path, const CorrectionOptions& options = {},
                             Progress* progress = nullptr);

}  // namespace shapespace

#endif  // SHAPESPACE_SOLVERS_CORRECTION_H_
