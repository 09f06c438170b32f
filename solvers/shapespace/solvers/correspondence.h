#ifndef SHAPESPACE_SOLVERS_CORRESPONDENCE_H_
#define SHAPESPACE_SOLVERS_CORRESPONDENCE_H_

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/base/progress.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/path/path.h>
#include <shapespace/solvers/surface_map.h>

namespace shapespace {

/// Two vertices that belong together: of the template, and of the target.
struct Marker {
  int template_vertex = -1, target_vertex = -1;
};

/// How a template is fitted onto another body (docs/mathematics.md, section 14).
struct CorrespondenceOptions {
  /// Leave out markers that contradict the others (CorrespondenceSummary::doubtful). Without, all
  /// are met exactly, whatever they do to the fit.
  bool drop_doubtful = true;

  /// Over which length, as a share of the root of the area, the two bodies' proportions may differ
  /// from place to place: longer for bodies that are alike, shorter where a head is larger and arms
  /// are shorter. Insensitive: 0.05 to 0.15 give nearly the same on all pairs measured.
  double proportions = 0.1;

  /// MetricOptions::bending of the fitted template. More keeps it from following detail that the
  /// template does not have; less lets it fold.
  double bending = 3e-5;

  /// The last rounds end when vertices move by less than this, root mean square, as a share of the
  /// root of the area. The figures of docs/measurements.md do not change below 1e-3.
  double tolerance = 1e-3;

  /// Rounds that these last may take. A fit that runs out of them is reported as not converged.
  int max_iterations = 10;

  /// Triangles of the coarsest level of the hierarchy, where the template finds its pose.
  int coarsest = 2000;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

struct CorrespondenceSummary {
  /// Rounds of closest points on one level.
  struct Stage {
    int vertices = 0;
    std::string name;   ///< "gradients" (Sumner and Popovic's), or "shell" (strain and bending)
    double weight = 0;  ///< of closest points
    int rounds = 0;
    /// Of those of its vertices that are near the target from it, before the last, root mean
    /// square.
    double distance = 0;
    /// Of the vertices' way to where the last round would have had them, root mean square, as a
    /// share of the root of the template's area; it may have taken only a part of it.
    double motion = 0;
    double seconds = 0;
  };

  /// A marker that the others do not predict.
  struct Doubt {
    int marker = 0;     ///< from 0
    double off = 0;     ///< of its target vertex from where the others expect it
    int expected = -1;  ///< the target's vertex that they expect
    int swapped = -1;   ///< the marker with which it seems to have changed places; -1: none
  };

  bool converged = false;
  bool cancelled = false;
  int template_vertices = 0, template_triangles = 0, target_vertices = 0, target_triangles = 0;
  int markers = 0;  ///< that were held
  std::vector<Doubt> doubtful;
  double scale = 1;  ///< size of the target, as a multiple of the template's
  std::vector<Stage> stages;
  /// Lengths of this summary are shares of the root of the target's area, if nothing else is said.
  double distance_rms = 0, distance_max = 0;       ///< of the fitted template from the target
  double round_trip_mean = 0, round_trip_p95 = 0;  ///< SurfaceMap::round_trip, of the template's
  double turned = 0;     ///< share of triangles whose normal points against the target's
  double uncovered = 0;  ///< share of the target's area that no part of the template came near
  std::vector<std::string> warnings;
  /// Of the fit a part is unfolding.
  double total_seconds = 0, marker_seconds = 0, hierarchy_seconds = 0, fit_seconds = 0,
         unfold_seconds = 0, map_seconds = 0;

  bool Converged() const { return converged; }
  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< a page
  std::string ToJson() const;
};

struct CorrespondenceResult {
  /// The template's vertices on the target's surface, 3 x m, in the target's place and unit.
  /// Markers that were held are exactly on their vertices.
  Shape fitted;
  SurfaceMap map;
  CorrespondenceSummary summary;
};

/// Fits a template onto another body of any connectivity, guided by a few pairs of vertices, and
/// maps the two surfaces onto each other. The bodies may stand, face and be as large as they like.
/// Poses may differ; markers must tell where the limbs went.
/// After R. Sumner and J. Popovic, "Deformation Transfer for Triangle Meshes" (SIGGRAPH 2004),
/// section 5, for a start; then under strain and bending (docs/mathematics.md, section 14).
/// \throw InvalidOptions; MeshError (a mesh without triangles or extent, a shape that is not finite
///        or has another number of vertices than its connectivity; fewer than three markers,
///        markers on one line, out of range, repeated or on a vertex without triangle; a component
///        of the template without a marker; markers that only fit a mirror image; a body that is
///        inside out), naming the marker, from 1; SolverError; Cancelled (stopped before a fit was
///        found; later what there is is mapped, CorrespondenceSummary::cancelled).
CorrespondenceResult Correspond(const std::shared_ptr<const Connectivity>& template_connectivity,
                                const Shape& template_shape,
                                const std::shared_ptr<const Connectivity>& target_connectivity,
                                const Shape& target_shape, const std::vector<Marker>& markers,
                                const CorrespondenceOptions& options = {},
                                Progress* progress = nullptr);

/// A path of the fitted template, whose first shape is `result.fitted`, as a path of the target's
/// own mesh: its vertices move along with the surface on which they lie (`CarryAlong`).
/// \throw MeshError if the path, the result and the mesh are not of each other.
Path CarryPath(const CorrespondenceResult& result, const Path& path,
               const std::shared_ptr<const Connectivity>& target_connectivity,
               const Shape& target_shape);

}  // namespace shapespace

#endif  // SHAPESPACE_SOLVERS_CORRESPONDENCE_H_
