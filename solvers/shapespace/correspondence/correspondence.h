#ifndef SHAPESPACE_CORRESPONDENCE_CORRESPONDENCE_H_
#define SHAPESPACE_CORRESPONDENCE_CORRESPONDENCE_H_

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/base/not_computed.h>
#include <shapespace/base/progress.h>
#include <shapespace/correspondence/surface_map.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/path/path.h>

namespace shapespace {

/// Two corresponding vertices, one of the template and one of the target (a landmark).
struct CorrespondenceMarker {
  int template_vertex = -1, target_vertex = -1;
  /// Not met exactly, but by a spring that is gone in the last rounds: for landmarks that are some
  /// millimetres off.
  bool soft = false;
};

/// How a template is fitted onto another body (docs/mathematics.md, section 14).
struct CorrespondenceOptions {
  /// Ignore markers that contradict the others (CorrespondenceSummary::doubtful). If false, all
  /// markers are met exactly, even where this distorts the fit.
  bool drop_doubtful = true;

  /// Find markers beside those that are given, which decide between the candidates. With fewer
  /// than three they are found in any case.
  bool find_markers = false;

  /// Length over which the ratio of the two bodies' proportions may change, as a share of the
  /// square root of the area: longer for bodies that are alike, shorter where, say, one has a
  /// larger head and shorter arms. Insensitive: 0.05 to 0.15 give nearly the same result on all
  /// pairs measured.
  double proportions = 0.1;

  /// MetricOptions::bending of the fitted template. Larger values keep it from following detail
  /// that the template does not have; with smaller ones it may fold.
  double bending = 3e-5;

  /// The final rounds end when vertices move by less than this: root mean square, as a share of the
  /// square root of the area. The figures of docs/measurements.md do not change below 1e-3.
  double tolerance = 1e-3;

  /// Greatest number of final rounds. A fit that needs more is reported as not converged.
  int max_iterations = 10;

  /// Triangles of the coarsest level of the hierarchy, on which the template's pose is found.
  int coarsest = 2000;

  /// Memory limit in bytes; if the estimate exceeds it, the call is refused before anything is
  /// allocated.
  double memory_limit = 8e9;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

struct CorrespondenceSummary {
  /// Rounds of closest-point fitting on one level.
  struct Stage {
    int vertices = 0;
    std::string name;  ///< "gradients" (Sumner and Popovic's method), "shell" (strain and bending)
                       ///< or "turns" (of limbs)
    double weight = kNotComputed;  ///< of the closest-point terms
    int rounds = 0;                ///< of "turns": how many limbs were turned
    /// Root mean square distance from the target before the last round, over the vertices that are
    /// near it. NaN for the others than "shell".
    double distance = kNotComputed;
    /// Root mean square distance of the vertices from the solution of the last round, as a share of
    /// the square root of the template's area. The round may have moved them only part of the way.
    double motion = kNotComputed;
    double seconds = 0;
  };

  /// A marker that is inconsistent with the others.
  struct Doubt {
    int marker = -1;  ///< index, from 0
    double off =
        kNotComputed;   ///< distance of its target vertex from the one that the others predict
    int expected = -1;  ///< the target vertex that the others predict
    int swapped = -1;   ///< the marker with which it seems to be exchanged; -1: none
  };

  /// A map that was found without markers, or with fewer than the fit needs.
  struct Candidate {
    double orientation = kNotComputed;  ///< 1 if outsides stay outside, -1 if all is turned over
    int markers = 0;                    ///< for the fit
    /// Of the template by a fit of its coarsest level: the mean of |log S| of its triangles'
    /// stretches S, at most 1 each, and of the square of its part that varies over less than
    /// `proportions`, and the shares that are uncovered or turned over. NaN if the fit failed or a
    /// rough one cost too much, as are the figures that follow.
    double deformation = kNotComputed;
    double isometry = kNotComputed;   ///< mean relative change of distances along the surface
    double curvature = kNotComputed;  ///< mean difference of mean curvatures, at most 1 each
    double heat = kNotComputed;       ///< mean difference of heat kernels: of what is near
    /// The deformation of the target by a fit onto the template with the same markers: of maps that
    /// cost little more than the cheapest; NaN of others.
    double reverse = kNotComputed;
    /// The product of these four, and of `reverse` as a share of that of the map that would be the
    /// cheapest without it; each with a hundredth more, which is as much as two meshes of one body
    /// may differ. The least is chosen.
    double cost = kNotComputed;
    /// The cost of a rough fit, without `reverse`. Candidates of which it is more than twice
    /// that of the cheapest are given up. NaN if the target is a part.
    double rough_cost = kNotComputed;
    bool chosen = false;
  };

  /// A part of the template that a map which costs nearly as little as the one chosen sends
  /// elsewhere.
  struct PartInDoubt {
    double share = kNotComputed;  ///< of the template's area
    double cost = kNotComputed;   ///< of the other map, as a multiple of that of the one chosen
    int vertex = -1;              ///< of the template: the one that both maps send farthest apart
    int target_vertex = -1;       ///< to which the chosen map sends it
    int other_vertex = -1;        ///< to which the other map does
  };

  bool converged = false;
  bool cancelled = false;
  int template_vertices = 0, template_triangles = 0, target_vertices = 0, target_triangles = 0;
  int markers = 0;  ///< that constrain the fit
  std::vector<Doubt> doubtful;
  /// If markers were found: the maps that were fitted, and the ends of limbs and the like that both
  /// bodies have; -1 if they were not.
  std::vector<Candidate> candidates;
  int template_extremities = -1, target_extremities = -1;
  /// Cost of the best map that sends a tenth of the template elsewhere, as a multiple of that of
  /// the one chosen: below 1.25 the choice is in doubt. NaN if there is none that was not given up.
  double certainty = kNotComputed;
  std::vector<PartInDoubt> parts_in_doubt;  ///< largest first
  double scale = kNotComputed;              ///< size of the target, as a multiple of the template's
  std::vector<Stage> stages;
  /// Lengths of this summary are shares of the square root of the target's area unless stated
  /// otherwise.
  double distance_rms = kNotComputed,
         distance_max = kNotComputed;  ///< from the fitted template to the target
  double round_trip_mean = kNotComputed,
         round_trip_p95 = kNotComputed;  ///< of SurfaceMap::round_trip of the template
  double turned = kNotComputed;  ///< share of triangles whose normal is opposite to the target's
  double uncovered =
      kNotComputed;  ///< share of the target's area that no part of the template is near
  std::vector<std::string> warnings;
  double estimated_bytes = 0;  ///< of memory, before the call
  /// fit_seconds includes unfold_seconds; of several fits, those of the one chosen are said.
  double total_seconds = 0, matching_seconds = 0, marker_seconds = 0, hierarchy_seconds = 0,
         fit_seconds = 0, unfold_seconds = 0, map_seconds = 0;

  bool Converged() const { return converged; }
  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< a page
  std::string ToJson() const;
};

struct CorrespondenceResult {
  /// The template's vertices on the target's surface, 3 x m, in the target's frame and unit.
  /// Markers that were neither dropped nor soft coincide with their target vertices exactly.
  Shape fitted;
  SurfaceMap map;
  CorrespondenceSummary summary;
  /// Those that constrained the fit, in ascending order of the template's vertices: given ones,
  /// and of those that were found up to 40, all over the body.
  std::vector<CorrespondenceMarker> markers;
  /// For each vertex of the template the part in doubt to which it belongs, as an index into
  /// CorrespondenceSummary::parts_in_doubt, or -1. Empty if no markers were found.
  std::vector<int> in_doubt;
};

/// Fits a template onto another body of any connectivity and maps the two surfaces onto each
/// other. It is guided by pairs of vertices. With fewer than three, maps are found from the inner
/// geometry of both surfaces, the template is fitted with each of the best, and the one that
/// deforms it least is the answer; a pair or two decide what geometry alone cannot. Components of
/// the template without a marker follow what is nearest to them; markers are found on the largest
/// one. Position, orientation, size and pose of the two bodies are arbitrary. The method of the fit
/// begins with section 5 of R. Sumner and J. Popovic, "Deformation Transfer for Triangle Meshes"
/// (SIGGRAPH 2004) and continues under strain and bending (docs/mathematics.md, section 14).
/// \throw InvalidOptions; MeshError (a mesh without triangles or extent, a shape that is not finite
///        or has another number of vertices than its connectivity; no map that could be found
///        without markers; markers on one line, out of range, repeated or on a vertex without
///        triangle; markers that only fit a mirror image; a body that is inside out; markers that
///        leave the template no area), naming the marker, counted from 1; SolverError (memory
///        limit); Cancelled (stopped before a fit was found; if stopped later, the fit so far is
///        mapped, see CorrespondenceSummary::cancelled).
CorrespondenceResult Correspond(const std::shared_ptr<const Connectivity>& template_connectivity,
                                const Shape& template_shape,
                                const std::shared_ptr<const Connectivity>& target_connectivity,
                                const Shape& target_shape,
                                const std::vector<CorrespondenceMarker>& markers,
                                const CorrespondenceOptions& options = {},
                                Progress* progress = nullptr);

/// Converts a path of the fitted template, whose first shape is `result.fitted`, to a path of the
/// target's own mesh, whose vertices move with the surface on which they lie (`CarryAlong`). The
/// metric has the path's options; the cost of volume is left out if the target encloses none.
/// \throw MeshError if the path, the result and the mesh do not belong together.
Path CarryPath(const CorrespondenceResult& result, const Path& path,
               const std::shared_ptr<const Connectivity>& target_connectivity,
               const Shape& target_shape);

}  // namespace shapespace

#endif  // SHAPESPACE_CORRESPONDENCE_CORRESPONDENCE_H_
