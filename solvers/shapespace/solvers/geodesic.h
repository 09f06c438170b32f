#ifndef SHAPESPACE_SOLVERS_GEODESIC_H_
#define SHAPESPACE_SOLVERS_GEODESIC_H_

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <shapespace/analysis/quality.h>
#include <shapespace/base/progress.h>
#include <shapespace/mesh/read.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/path.h>

namespace shapespace {

namespace internal {
class GeodesicLevels;
}

/// The optimiser of each level.
enum class Solver {
  kAutomatic,      ///< sparse trust region for the smallest problems, L-BFGS otherwise
  kLbfgs,          ///< Ceres' L-BFGS, preconditioned, on hand-written kernels
  kThreadedLbfgs,  ///< L-BFGS of ours on the same kernels, on all threads
  kTrustRegion,    ///< Ceres' Levenberg-Marquardt on automatically differentiated residual blocks
};

/// In which order resolutions in space (levels of a `Hierarchy`, coarse c to fine f) and time
/// (numbers of inner shapes 1, 3, 7, ... n) are solved, each from the ones before.
enum class Schedule {
  kAutomatic,  ///< all levels in turn for one, three and seven inner shapes, then the finest only:
               ///< (c,1) ... (f,1), (c,3) ... (f,3), (c,7) ... (f,7), (f,15) ... (f,n). Without a
               ///< cost of bending kFlat: coarse surfaces would crumple, and fine ones keep the
               ///< folds
  /// Time and space in turn (Kilian et al. 2007, Figure 3): (c,1), (c,3), (c+1,3), ... The paper's
  /// are this order, that all poses are decimated in step, and that each level starts from the one
  /// before. The rest is ours, as in all schedules: which vertices go first, and how many per level
  /// (Hierarchy); that detail turns with the neighbourhoods of vertices, where the paper keeps
  /// local coordinates in the frames of faces; new shapes on cubics in time, where the paper has
  /// straight lines; poses aligned rigidly first, and rigid drift of inner shapes taken out (but
  /// not under Discretization::kTrapezoid); and a metric for each level, frozen on the decimated
  /// poses. The paper's starts are Start::kBlend and kRigid, its metric is MetricOptions::Paper().
  kPaper,
  kFlat,  ///< the finest level only: (f,1), (f,3), (f,7) ...
};

/// Where the one inner shape of the first solve starts.
enum class Start {
  kBest,   ///< from the blend and from both poses; the one that ends lowest, on few vertices, goes
           ///< on
  kBlend,  ///< half way on straight lines
  kFirst,  ///< at the first pose
  kLast,   ///< at the last pose
  kRigid,  ///< at the solution of the rigid metric (3): the paper's advice where blends degenerate
};

/// How to find a geodesic between given poses.
struct GeodesicOptions {
  MetricOptions metric;

  /// Shapes inserted between neighbouring poses, at least 1.
  int shapes = 15;

  /// A level is finished when an iteration lowers the energy by less than this share of it. Between
  /// real poses 1e-4 leaves the energy within .7 % of what 1e-7 reaches (on cats, whose poses hold
  /// folds, 1.6 %), and shapes that look the same; an accurate exponential map needs 1e-10.
  double tolerance = 1e-4;

  /// Per level. Reaching it is reported as not converged.
  int max_iterations = 500;

  Solver solver = Solver::kAutomatic;
  Schedule schedule = Schedule::kAutomatic;
  Start start = Start::kBest;

  /// Triangles of the coarsest level (HierarchyOptions::coarsest).
  int coarsest = 200;

  /// Bytes that the solve may take; an estimate above it is refused before anything is allocated.
  double memory_limit = 8e9;

  /// Whether the finished path is measured for `GeodesicSummary::quality` and `intersections`,
  /// which takes up to a fifth of the time; without, these are not numbers.
  bool assess = true;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

enum class Termination {
  kConverged,      ///< every level reached the tolerance
  kMaxIterations,  ///< some level ran out of iterations; the path is the best so far
  kStalled,        ///< some line search found no better point; the path is the best so far
  kCancelled,      ///< `progress` asked to stop; the path is the best so far
};

/// What happened, and how good the answer is.
struct GeodesicSummary {
  /// One row of the solve: one level and one number of inner shapes between one pair of poses.
  struct Level {
    int piece = 0;       ///< between pose `piece` and the next
    int vertices = 0;    ///< of the level of the hierarchy
    int shapes = 0;      ///< inner shapes
    std::string start;   ///< where it started: "blend", "first", "last", "rigid"; or from earlier
                         ///< rows: "refined" in time, "lifted" in space
    std::string solver;  ///< "L-BFGS", "own L-BFGS" or "trust region"
    Termination termination = Termination::kConverged;
    int iterations = 0, evaluations = 0;
    double initial_energy = 0, energy = 0;  ///< scaled: E n / 2 for n segments
    double remaining = 0;  ///< first-order estimate of what a further step gains, share of energy
    bool kept = true;      ///< false for a start that lost against another
    double seconds = 0;
  };

  Termination termination = Termination::kConverged;
  int vertices = 0, triangles = 0, edges = 0, hinges = 0, poses = 0, shapes = 0;
  std::string metric;
  double unit = 1;         ///< user's length that counts as 1
  double energy = 0;       ///< scaled and summed over the pieces; a pure number
  double lower_bound = 0;  ///< of the same; not a number if none is known (rigid metric)
  std::vector<std::pair<std::string, double>> parts;  ///< the energy by feature
  PathQuality quality;
  /// Pairs of triangles that pass through each other (PathIntersections::beyond_poses), as a mean
  /// over three shapes between neighbouring poses.
  double intersections = 0;
  std::vector<int> hierarchy;            ///< vertices of its levels, the coarsest first
  bool hierarchy_stopped_early = false;  ///< no legal collapse led further down
  std::vector<Level> levels;
  std::vector<std::string> warnings;  ///< what a person should look at
  double estimated_bytes = 0;
  double freeze_seconds = 0, hierarchy_seconds = 0, factor_seconds = 0, solve_seconds = 0,
         total_seconds = 0;
  size_t factor_nonzeros = 0;
  int threads = 1;

  /// energy / lower_bound: 1 is as good as can be (and said of poses that are rigid copies, where
  /// both are zero but for rounding); 1.03 to 1.15 where poses hold folded hinges.
  double Ratio() const { return energy < kZeroEnergy ? 1 : energy / lower_bound; }
  static constexpr double kZeroEnergy = 1e-18;
  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< a page
  std::string ToJson() const;
};

struct GeodesicResult {
  Path path;
  GeodesicSummary summary;
};

/// The geodesic through given poses (boundary value problem; Kilian et al. 2007, section 3): piece
/// after piece between neighbours, at t = i / (poses - 1). Poses are aligned rigidly first, since
/// rigid motion is not what a metric of shapes is about; the path carries it separately.
/// Once the first solve has begun there is a path: if `progress` asks to stop then, the best so far
/// is returned (Termination::kCancelled), with as many shapes as were asked for. Those of the piece
/// that was being solved come from the resolutions that were, lifted and refined; pieces behind it
/// are straight-line blends.
/// \throw InvalidOptions, MeshError (fewer than two poses; see FreezeMetric), SolverError (memory
///        limit, two neighbours that turn too far for the rigid metric), Cancelled (stopped before
///        the first solve).
GeodesicResult Interpolate(const std::shared_ptr<const Connectivity>& connectivity,
                           const std::vector<Shape>& poses, const GeodesicOptions& options = {},
                           Progress* progress = nullptr);
GeodesicResult Interpolate(const Poses& poses, const GeodesicOptions& options = {},
                           Progress* progress = nullptr);

/// The same under a metric that is frozen already, so that several paths are comparable;
/// options.metric is not read.
GeodesicResult Interpolate(const std::shared_ptr<const Metric>& metric,
                           const std::vector<Shape>& poses, const GeodesicOptions& options = {},
                           Progress* progress = nullptr);

/// Geodesics between many pairs of shapes of one mesh, all under one metric: keeps the hierarchy,
/// the metrics of its levels and their factors. What is found between two shapes does not depend on
/// the pairs before, to the last bit.
class Interpolator {
 public:
  /// Freezes options.metric on all `poses` (user's unit), between every two of them, and decimates
  /// them in step.
  /// \throw as Interpolate; one pose is enough.
  Interpolator(const std::shared_ptr<const Connectivity>& connectivity,
               const std::vector<Shape>& poses, const GeodesicOptions& options = {});
  ~Interpolator();
  Interpolator(Interpolator&&) noexcept;
  Interpolator& operator=(Interpolator&&) noexcept;

  const std::shared_ptr<const Metric>& GetMetric() const;

  /// The geodesic from one shape to another (user's unit), which are poses or lie between them.
  /// \throw as Interpolate.
  GeodesicResult Between(const Shape& from, const Shape& to, Progress* progress = nullptr);

 private:
  std::unique_ptr<internal::GeodesicLevels> levels_;
};

}  // namespace shapespace

#endif  // SHAPESPACE_SOLVERS_GEODESIC_H_
