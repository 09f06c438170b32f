#ifndef SHAPESPACE_DEFORMATION_DEFORMATION_H_
#define SHAPESPACE_DEFORMATION_DEFORMATION_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <shapespace/analysis/shape_error.h>
#include <shapespace/base/not_computed.h>
#include <shapespace/base/progress.h>
#include <shapespace/contact/obstacle.h>
#include <shapespace/deformation/handle.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/path.h>

namespace shapespace {

/// How to deform.
struct DeformationOptions {
  /// The metric; by default MetricOptions::Deformation of the mesh. If it has no cost of position
  /// (lambda 0), bodies whose handles move rigidly move rigidly too, and components without a
  /// handle stay where they are. All features are allowed, but not the rigid form; midpoint form
  /// only.
  std::optional<MetricOptions> metric;

  /// Shapes after the first, including the deformed one; 1 or more. They are the frames to show,
  /// and they resolve large rotations: with a single shape the deformed mesh is compared with the
  /// first directly, so turns by a full revolution may be lost.
  int shapes = 5;

  /// Weight of the metric relative to soft handles, the lambda of Kilian et al. 2007, section 5.
  /// The objective is
  ///   balance * energy + (1 - balance) * mean over soft handles of
  ///                                    weight * mean squared distance of the handle's vertices,
  /// where the inner mean is weighted by area, lengths are in the unit in which the surface has
  /// area 1 and the energy is scaled (E n / 2). The value therefore has the same meaning in any
  /// unit, at any resolution and for any number of handles or shapes. In (0, 1]: towards 0 soft
  /// handles are met exactly; at 1 they have no effect. Hard handles do not depend on it.
  double balance = 0.01;

  /// A level has converged when two consecutive iterations lower the objective by less than this
  /// share of it.
  double tolerance = 1e-4;

  /// Per level. Reaching it is reported as not converged.
  int max_iterations = 500;

  enum class Solver {
    kThreadedLbfgs,  ///< this library's L-BFGS on hand-written kernels
    kTrustRegion,    ///< Ceres' Levenberg-Marquardt on automatically differentiated residual
                     ///< blocks; slow beyond a thousand vertices
  };
  Solver solver = Solver::kThreadedLbfgs;

  /// Triangles of the coarsest level (HierarchyOptions::coarsest).
  int coarsest = 200;

  /// Whether the body must not pass through itself. If the deformation without this option touches
  /// itself, the handles are followed again in small steps in which parts give way to each other,
  /// and the path is relaxed such that they do not touch. Otherwise it is the same as without.
  /// Needs triangles. Not prevented are contacts of parts that are nearer to each other on the
  /// surface than two edges.
  bool avoid_contact = false;

  /// With `avoid_contact`: a surface that does not move, which the body is not to touch either. It
  /// is in the frame and the unit of the mesh.
  std::optional<Obstacle> obstacle;

  /// Memory limit of a solve in bytes; if the estimate exceeds it, the solve is refused before
  /// anything is allocated.
  double memory_limit = 8e9;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// Outcome and quality of a deformation.
struct DeformationSummary {
  struct HandleResult {
    std::string name;
    int vertices = 0;
    bool hard = true;
    /// Distance of the last shape's vertices from the handle's targets: area-weighted root mean
    /// square, and maximum; in the user's unit.
    double residual_rms = kNotComputed, residual_max = kNotComputed;
  };
  /// One solve.
  struct Level {
    int vertices = 0, shapes = 0;
    std::string start;  ///< "handles": by following the handles step by step; "given"; "lifted";
                        ///< "warm": from the last solution; "contact": the path whose shapes do
                        ///< not touch themselves
    Termination termination = Termination::kCancelled;
    int iterations = 0, evaluations = 0;
    double initial_value = kNotComputed,
           value = kNotComputed;  ///< of the objective divided by the balance
    double seconds = 0;
  };

  Termination termination = Termination::kCancelled;  ///< of the finest level
  int vertices = 0, triangles = 0, shapes = 0;
  std::string metric;
  double unit = kNotComputed;     ///< length in the user's unit that has length 1 in the metric
  double balance = kNotComputed;  ///< as given
  double energy = kNotComputed;   ///< of the path, scaled: E n / 2; a pure number
  ShapeError error;               ///< of the last shape relative to the first
  std::vector<HandleResult> handles;
  int free_components = -1;  ///< connected components without a handle; they stay where they are
  std::vector<Level> levels;
  std::vector<int> hierarchy;  ///< vertices of its levels, the coarsest first
  /// With DeformationOptions::avoid_contact, as in GeodesicSummary: segments whose straight motion
  /// has not been shown to be free of contact, and the least distance of two parts.
  int uncertified_segments = -1;
  double contact_distance = kNotComputed;
  /// Pairs of intersecting triangles, in the shape that has most of them, in excess of those of the
  /// mesh. NaN, which was not counted, of a `Deformer` and of deformations that were cancelled.
  double intersections = kNotComputed;
  bool warm = false;                  ///< started from the last solution of the same `Deformer`
  std::vector<std::string> warnings;  ///< to be checked by the user
  double estimated_bytes = 0;         ///< of memory, before the solve
  double hierarchy_seconds = 0, factor_seconds = 0, solve_seconds = 0, contact_seconds = 0,
         total_seconds = 0;
  int threads = 1;

  bool Converged() const { return termination == Termination::kConverged; }
  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< a page
  std::string ToJson() const;
};

struct DeformationResult {
  /// From the given mesh, its only pose, to the deformed one, at evenly spaced parameters.
  Path path;
  DeformationSummary summary;
};

/// Deforms a mesh by handles (Kilian et al. 2007, section 5 and Figure 10): finds the path of least
/// energy whose first shape is the mesh and whose last shape satisfies the handles. Works from
/// coarse to fine: on the coarsest level the handles move to their targets in small steps
/// (numerical continuation), so that large turns of handles produce large turns of the body. Then
/// the whole path is relaxed, lifted with the mesh's own detail and relaxed again, level by level.
///
/// The result is examined: the summary counts where it passes through itself, and warns of that and
/// of edges that have become much longer or shorter.
///
/// Handles may contradict each other: vertices in several hard handles go to the mean of their
/// targets, and the summary reports the distance of each handle from its target. Connected
/// components without a handle stay where they are and are reported. `rest` may contain collapsed
/// or repeated triangles.
/// \throw InvalidOptions (options; handles, naming the handle), MeshError (see FreezeMetric),
///        SolverError (memory limit), Cancelled (stopped by `progress` before there was a path; if
///        stopped later, the best path so far is returned with Termination::kCancelled).
DeformationResult Deform(const std::shared_ptr<const Connectivity>& connectivity, const Shape& rest,
                         const std::vector<DeformationHandle>& handles,
                         const DeformationOptions& options = {}, Progress* progress = nullptr);

/// Deforms one mesh repeatedly: keeps its hierarchy, factors and the last path. If the next handles
/// constrain the same vertices in the same way and move them only a little, the solve starts from
/// that path on the finest level; otherwise it is the same as `Deform`. A path that was cancelled
/// is no such start: then it is the last one before that was not. Intersections are not counted,
/// which would take longer than a small move of a handle.
class Deformer {
 public:
  /// \throw as Deform.
  Deformer(const std::shared_ptr<const Connectivity>& connectivity, const Shape& rest,
           const DeformationOptions& options = {});
  ~Deformer();
  Deformer(Deformer&&) noexcept;
  Deformer& operator=(Deformer&&) noexcept;

  DeformationResult Deform(const std::vector<DeformationHandle>& handles,
                           Progress* progress = nullptr);
  /// The same, but starts from a given last shape instead of following the handles from the mesh.
  /// `end`, 3 x m in the user's unit, need not satisfy the hard handles.
  /// \throw MeshError too, if `end` is not finite or has another number of vertices.
  DeformationResult DeformFrom(const Shape& end, const std::vector<DeformationHandle>& handles,
                               Progress* progress = nullptr);

 private:
  class Solver;
  std::unique_ptr<Solver> solver_;
};

}  // namespace shapespace

#endif  // SHAPESPACE_DEFORMATION_DEFORMATION_H_
