#ifndef SHAPESPACE_SOLVERS_DEFORMATION_H_
#define SHAPESPACE_SOLVERS_DEFORMATION_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <shapespace/analysis/shape_error.h>
#include <shapespace/base/progress.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/path.h>
#include <shapespace/solvers/geodesic.h>
#include <shapespace/solvers/handle.h>

namespace shapespace {

/// How to deform.
struct DeformationOptions {
  /// What a deformation costs; without, MetricOptions::Deformation of the mesh. Without a cost of
  /// position (lambda 0 in the metric) bodies that handles move rigidly move so, and what no handle
  /// holds stays where it is. All features, but not the rigid part; in midpoint form only.
  std::optional<MetricOptions> metric;

  /// Shapes after the first, the deformed one included; 1 or more. They are frames to show, and
  /// they remember how far a part has turned: a single shape is compared with the first directly,
  /// and may slip out of a full turn.
  int shapes = 5;

  /// Between the metric and soft handles, the lambda of Kilian et al. 2007, section 5; what is
  /// minimised is
  ///   balance * energy + (1 - balance) * mean over soft handles of
  ///                                    weight * mean squared distance of the handle's vertices,
  /// the inner mean weighted by area, lengths in the unit in which the surface has area 1 and the
  /// energy scaled (E n / 2). So it means the same in any unit, at any resolution and for any
  /// number of handles or shapes. In (0, 1]: to 0, handles are met; at 1, nothing moves. Hard
  /// handles do not care.
  double balance = 0.01;

  /// A level is finished when two iterations in a row lower what is minimised by less than this
  /// share of it.
  double tolerance = 1e-4;

  /// Per level. Reaching it is reported as not converged.
  int max_iterations = 500;

  enum class Solver {
    kThreadedLbfgs,  ///< L-BFGS of ours on hand-written kernels
    kTrustRegion,    ///< Ceres' Levenberg-Marquardt on automatically differentiated residual
                     ///< blocks; slow beyond a thousand vertices
  };
  Solver solver = Solver::kThreadedLbfgs;

  /// Triangles of the coarsest level (HierarchyOptions::coarsest).
  int coarsest = 200;

  /// Bytes that a solve may take; an estimate above it is refused before anything is allocated.
  double memory_limit = 8e9;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// What happened, and how good the answer is.
struct DeformationSummary {
  struct HandleResult {
    std::string name;
    int vertices = 0;
    bool hard = true;
    /// Distance of the vertices of the last shape from where the handle wants them: root mean
    /// square, weighted by area, and greatest; in the user's unit.
    double residual_rms = 0, residual_max = 0;
  };
  /// One row of the solve.
  struct Level {
    int vertices = 0, shapes = 0;
    std::string start;  ///< "handles", stepwise; "given"; "lifted"; "warm" from the last solution
    Termination termination = Termination::kConverged;
    int iterations = 0, evaluations = 0;
    double initial_value = 0, value = 0;  ///< of what is minimised, over the balance
    double seconds = 0;
  };

  Termination termination = Termination::kConverged;  ///< of the mesh itself
  int vertices = 0, triangles = 0, shapes = 0;
  std::string metric;
  double unit = 1;     ///< user's length that counts as 1
  double balance = 0;  ///< as given
  double energy = 0;   ///< of the path, scaled: E n / 2; a pure number
  ShapeError error;    ///< of the last shape against the first
  std::vector<HandleResult> handles;
  int free_components = 0;  ///< connected pieces that no handle holds, and that stay where they are
  std::vector<Level> levels;
  std::vector<int> hierarchy;         ///< vertices of its levels, the coarsest first
  bool warm = false;                  ///< went on from the last solution of the same `Deformer`
  std::vector<std::string> warnings;  ///< what a person should look at
  double hierarchy_seconds = 0, factor_seconds = 0, solve_seconds = 0, total_seconds = 0;
  int threads = 1;

  bool Converged() const { return termination == Termination::kConverged; }
  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< a page
  std::string ToJson() const;
};

struct DeformationResult {
  /// From the mesh as it was, its one pose, to the deformed one; its shapes lie at even times.
  Path path;
  DeformationSummary summary;
};

/// Deforms a mesh by handles (Kilian et al. 2007, section 5 and Figure 10): a whole path of shapes,
/// of which the first is the mesh and the last is held by the handles, and which is as short as the
/// metric allows. Coarse to fine: on the coarsest level the handles go their way step by step, so
/// that large turns lead to large turns; then the path is relaxed as a whole, lifted with the
/// mesh's own detail and relaxed again, level by level.
///
/// Handles may ask for what cannot be: vertices in several hard handles go to the mean of their
/// targets, and the summary tells how far each handle is from having what it asks for. Connected
/// pieces without a handle stay where they are, and are told of. `rest` may hold collapsed or
/// repeated triangles.
/// \throw InvalidOptions (options; handles, naming the one), MeshError (see FreezeMetric),
///        SolverError (memory limit), Cancelled (stopped by `progress` before there was a path;
///        later the best so far is returned, as Termination::kCancelled).
DeformationResult Deform(const std::shared_ptr<const Connectivity>& connectivity, const Shape& rest,
                         const std::vector<Handle>& handles, const DeformationOptions& options = {},
                         Progress* progress = nullptr);

/// Deforms one mesh again and again: keeps its hierarchy, factors and the last path. If the next
/// handles hold the same vertices in the same way, and move them by little, the solve goes on from
/// that path on the mesh itself; otherwise it is as `Deform`.
class Deformer {
 public:
  /// \throw as Deform.
  Deformer(const std::shared_ptr<const Connectivity>& connectivity, const Shape& rest,
           const DeformationOptions& options = {});
  ~Deformer();
  Deformer(Deformer&&) noexcept;
  Deformer& operator=(Deformer&&) noexcept;

  DeformationResult Deform(const std::vector<Handle>& handles, Progress* progress = nullptr);
  /// The same from a shape near which the deformed one is looked for, in place of following the
  /// handles there; hard handles need not have their places in it.
  DeformationResult DeformFrom(const Shape& end, const std::vector<Handle>& handles,
                               Progress* progress = nullptr);

 private:
  class Solver;
  std::unique_ptr<Solver> solver_;
};

}  // namespace shapespace

#endif  // SHAPESPACE_SOLVERS_DEFORMATION_H_
