#ifndef SHAPESPACE_GEODESIC_GEODESIC_H_
#define SHAPESPACE_GEODESIC_GEODESIC_H_

#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <shapespace/analysis/quality.h>
#include <shapespace/base/not_computed.h>
#include <shapespace/base/progress.h>
#include <shapespace/contact/obstacle.h>
#include <shapespace/files/read.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/path.h>
#include <shapespace/summary/termination.h>

namespace shapespace {

namespace internal {
class GeodesicLevels;
}

/// The optimiser of each level. Ways round contact (GeodesicOptions::avoid_contact) are relaxed by
/// this library's L-BFGS whichever is chosen, with a warning if another one was asked for, and so
/// are deformations by handles unless DeformationOptions::solver says otherwise:
/// docs/architecture.md has all of them in one table.
enum class GeodesicSolver {
  kAutomatic,      ///< kLbfgs below 20,000 unknowns (three for each vertex of each inner shape),
                   ///< kThreadedLbfgs from there on
  kLbfgs,          ///< Ceres' L-BFGS, preconditioned, on hand-written kernels
  kThreadedLbfgs,  ///< this library's L-BFGS on the same kernels, on all threads
  kTrustRegion,    ///< Ceres' Levenberg-Marquardt on residual blocks, each of which is the functor
                   ///< of a feature, automatically differentiated (cost/path_energy.h)
};

/// The order in which resolutions in space (levels of a `Hierarchy`, coarsest c to finest f) and in
/// time (1, 3, 7, ... n inner shapes) are solved. Each solve starts from the result of earlier
/// ones.
enum class GeodesicSchedule {
  kAutomatic,  ///< all levels in turn for one, three and seven inner shapes, then the finest only:
               ///< (c,1) ... (f,1), (c,3) ... (f,3), (c,7) ... (f,7), (f,15) ... (f,n). Without a
               ///< cost of bending kFlat: coarse surfaces would crumple, and finer levels would
               ///< keep the folds
  /// Time and space in turn (Kilian et al. 2007, Figure 3): (c,1), (c,3), (c+1,3), ... Taken from
  /// the paper: this order, the simultaneous decimation of all poses, and that each level starts
  /// from the one before. Different from the paper, as in all schedules: which vertices are removed
  /// first, and how many per level (Hierarchy); detail turns with the neighbourhoods of vertices
  /// (paper: local coordinates in the frames of faces); new shapes lie on cubics in time (paper:
  /// straight lines); poses are aligned rigidly first, and rigid drift of inner shapes is removed
  /// (but not under Discretization::kTrapezoid); each level has a metric of its own, frozen on the
  /// decimated poses. The paper's starts are GeodesicStart::kBlend and kRigid, its metric is
  /// MetricOptions::Paper().
  kPaper,
  kFlat,  ///< the finest level only: (f,1), (f,3), (f,7) ...
};

/// The initial guess for the one inner shape of the first solve.
enum class GeodesicStart {
  kBest,   ///< kBlend, kFirst and kLast on few vertices; the one that ends with the least energy is
           ///< used. Where hinges turn by 180 degrees, first a shape in which every triangle has
           ///< made half of its turn ("turn" in Level::start)
  kBlend,  ///< the mean of the two poses
  kFirst,  ///< the first pose
  kLast,   ///< the last pose
  kRigid,  ///< the solution under the rigid metric (3): the paper's advice if the blend degenerates
};

/// Options of the geodesic through given poses.
struct GeodesicOptions {
  MetricOptions metric;

  /// Shapes inserted between neighbouring poses, at least 1.
  int shapes = 15;

  /// A level has converged when an iteration lowers the energy by less than this share of it.
  /// Between real poses 1e-4 leaves the energy within .7 % of the value at 1e-7 (1.6 % for cats,
  /// whose poses contain folds), with shapes that look the same; an accurate exponential map needs
  /// 1e-10.
  double tolerance = 1e-4;

  /// Per level. Reaching it is reported as not converged.
  int max_iterations = 500;

  GeodesicSolver solver = GeodesicSolver::kAutomatic;
  GeodesicSchedule schedule = GeodesicSchedule::kAutomatic;
  GeodesicStart start = GeodesicStart::kBest;

  /// Triangles of the coarsest level (HierarchyOptions::coarsest).
  int coarsest = 200;

  /// Memory limit in bytes; if the estimate exceeds it, the solve is refused before anything is
  /// allocated.
  double memory_limit = 8e9;

  /// Whether to compute `GeodesicSummary::quality` and `intersections` of the finished path, which
  /// takes up to a fifth of the time; if false, they are NaN.
  bool assess = true;

  /// Whether the path must not pass through itself, the limitation that the paper names. If parts
  /// of the body would, the least way round is sought on which they do not (docs/mathematics.md,
  /// section 18), which costs more energy and takes several times as long; otherwise the path is
  /// the same as without. Needs triangles; segments (lines of OBJ files) do not pass through these
  /// either. Not prevented are contacts of parts that are nearer to each other on the surface than
  /// two edges, and of those that intersect in a pose.
  bool avoid_contact = false;

  /// With `avoid_contact`, between two poses: shapes near which the way round leads, in this order,
  /// for bodies that do not find it, such as one whose crossed legs are to be crossed the other way
  /// round. The path does not contain them. In the user's unit and any position.
  std::vector<Shape> via;

  /// With `avoid_contact`: a surface that the body must not touch either. The poses then are where
  /// they are to be, and the body moves from one to the next past the obstacle.
  std::optional<Obstacle> obstacle;

  /// Called with the whole path as it is so far, when coarse solves of a piece are done and when
  /// solves of the mesh itself are, before the next begins: for programs that show it meanwhile.
  /// Finer shapes are lifted and refined, later pieces are straight-line blends. Without it nothing
  /// is made to be shown.
  std::function<void(const Path& so_far)> preview;

  /// \throw InvalidOptions naming the field; MeshError if the obstacle is not valid.
  void Validate() const;
};

/// Outcome and quality of a geodesic.
struct GeodesicSummary {
  /// One solve: one level and one number of inner shapes between one pair of poses.
  struct Level {
    int piece = 0;       ///< between pose `piece` and the next
    int vertices = 0;    ///< of the level of the hierarchy
    int shapes = 0;      ///< inner shapes
    std::string start;   ///< initial guess: "blend", "first", "last", "rigid", "turn"; from earlier
                         ///< rows, "refined" in time or "lifted" in space
    std::string solver;  ///< "L-BFGS", "own L-BFGS" or "trust region"
    Termination termination = Termination::kCancelled;
    int iterations = 0, evaluations = 0;
    double initial_energy = kNotComputed,
           energy = kNotComputed;     ///< scaled: E n / 2 for n segments
    double remaining = kNotComputed;  ///< first-order estimate of the energy that another step
                                      ///< would gain, as a share of the energy
    bool kept = true;  ///< false for a start that ended with more energy than another
    double seconds = 0;
  };

  Termination termination = Termination::kCancelled;
  int vertices = 0, triangles = 0, edges = 0, hinges = 0, poses = 0, shapes = 0;
  std::string metric;
  double unit = kNotComputed;         ///< length in the user's unit that has length 1 in the metric
  double energy = kNotComputed;       ///< scaled and summed over the pieces; a pure number
  double lower_bound = kNotComputed;  ///< of the energy; NaN if none is known (rigid metric)
  std::vector<std::pair<std::string, double>> parts;  ///< the energy by feature
  PathQuality quality;
  /// Pairs of intersecting triangles (PathIntersections::beyond_poses): the mean over three shapes
  /// between neighbouring poses.
  double intersections = kNotComputed;
  /// With GeodesicOptions::avoid_contact: the same in the middle between every two neighbouring
  /// shapes, the greatest number; NaN without.
  double crossings_between = kNotComputed;
  /// With GeodesicOptions::avoid_contact: segments whose straight motion has not been shown to be
  /// free of contact at all times; without, -1.
  int uncertified_segments = -1;
  /// With GeodesicOptions::avoid_contact: the least distance of two parts during the path, in the
  /// user's unit; NaN if no way round anything was necessary, or without that option.
  double contact_distance = kNotComputed;
  std::vector<int> hierarchy;            ///< vertices of its levels, the coarsest first
  bool hierarchy_stopped_early = false;  ///< because no further edge could be collapsed
  std::vector<Level> levels;
  std::vector<std::string> warnings;  ///< to be checked by the user
  double estimated_bytes = 0;         ///< of memory, before the solve
  double freeze_seconds = 0, hierarchy_seconds = 0, factor_seconds = 0, solve_seconds = 0,
         contact_seconds = 0, total_seconds = 0;
  size_t factor_nonzeros = 0;
  int threads = 1;

  /// energy / lower_bound: 1 is optimal; 1.03 to 1.15 if poses contain folded hinges. For poses
  /// that are rigid copies both are zero up to rounding, and the ratio is defined as 1; it is
  /// infinite if the way from one to the other leads past an obstacle that deforms the body.
  double Ratio() const {
    if (energy < kZeroEnergy) return 1;
    if (lower_bound < kZeroEnergy) return std::numeric_limits<double>::infinity();
    return energy / lower_bound;
  }
  static constexpr double kZeroEnergy = 1e-18;
  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< a page
  std::string ToJson() const;
};

struct GeodesicResult {
  Path path;
  GeodesicSummary summary;
};

/// The geodesic through given poses (boundary value problem; Kilian et al. 2007, section 3),
/// computed piece by piece between neighbouring poses; pose i is at t = i / (poses - 1). Poses are
/// aligned rigidly first, because the metric measures deformation; the path stores the rigid motion
/// separately. Once the first solve has begun there is a path: if `progress` asks to stop after
/// that, the best path so far is returned (Termination::kCancelled), with as many shapes as were
/// asked for. In the piece that was being solved they come from the resolutions that were finished,
/// lifted and refined; later pieces are straight-line blends.
/// \throw InvalidOptions, MeshError (fewer than two poses; see FreezeMetric), SolverError (memory
///        limit, two neighbours with too large a rotation for the rigid metric), Cancelled (stopped
///        before the first solve).
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

/// Computes geodesics between many pairs of shapes of one mesh, all under one metric: keeps the
/// hierarchy, the metrics of its levels and their factors. The result for a pair does not depend on
/// the pairs before it or beside it, bit by bit.
///
/// Several threads may call one object at a time. Many pairs are solved fastest side by side, each
/// on one thread:
///
///   ParallelTasks(count, interpolator.MostAtOnce(), [&](int i) {
///     results[i] = interpolator.Between(*from[i], *to[i]);
///   });
class Interpolator {
 public:
  /// Freezes options.metric on all `poses` (user's unit), taking all pairs of them into account,
  /// and decimates them simultaneously.
  /// \throw as Interpolate; one pose is enough.
  Interpolator(const std::shared_ptr<const Connectivity>& connectivity,
               const std::vector<Shape>& poses, const GeodesicOptions& options = {});
  ~Interpolator();
  Interpolator(Interpolator&&) noexcept;
  Interpolator& operator=(Interpolator&&) noexcept;

  const std::shared_ptr<const Metric>& GetMetric() const;

  /// How many geodesics can be solved at the same time within `GeodesicOptions::memory_limit`, at
  /// least 1. The memory that solves work on is kept for later ones.
  int MostAtOnce() const;

  /// The geodesic from one shape to another (user's unit); both are poses or lie between poses.
  /// \throw as Interpolate.
  GeodesicResult Between(const Shape& from, const Shape& to, Progress* progress = nullptr) const;

 private:
  std::unique_ptr<const internal::GeodesicLevels> levels_;
  double estimated_bytes_ = 0;  // of a path, and of all poses on all levels
  int most_at_once_ = 1;
};

}  // namespace shapespace

#endif  // SHAPESPACE_GEODESIC_GEODESIC_H_
