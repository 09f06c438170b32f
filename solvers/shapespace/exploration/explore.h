#ifndef SHAPESPACE_EXPLORATION_EXPLORE_H_
#define SHAPESPACE_EXPLORATION_EXPLORE_H_

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/base/not_computed.h>
#include <shapespace/base/progress.h>
#include <shapespace/exploration/embedding.h>
#include <shapespace/exploration/process_pool.h>
#include <shapespace/exploration/space.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// Options for a space of poses.
struct ExploreOptions {
  /// Options of every geodesic. `shapes` must be odd, so that there is a shape half way; `assess`
  /// is not read. The rigid metric is refused because it has no length.
  GeodesicOptions geodesic = Defaults();

  /// Maximum number of triangles of the hierarchy's level on which distances between poses are
  /// measured (if the coarsest level has more, the coarsest). 0: the mesh itself. With many poses
  /// of fine meshes, 5000 saves most of the time. For armadillos of 29 K triangles it changes
  /// distances by up to 12 %, but all by nearly the same factor, within 4 %.
  int resolution = 0;

  /// If the straight line between two nodes is longer than the geodesic by more than this share, it
  /// is replaced by two lines via the geodesic's midpoint.
  double threshold = 0.05;

  /// Maximum number of times a triangle is split.
  int depth = 2;

  EmbeddingOptions embedding;

  /// A folder for finished geodesics, which should contain nothing else: after an interruption, the
  /// next run with the same inputs and options continues from them. The caller removes it
  /// (RemoveRecords). All processes of a crew must see the same folder. Empty: nothing is stored.
  std::string records;

  static GeodesicOptions Defaults();

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// Outcome and quality of a space.
struct ExploreSummary {
  /// One round: all new edges are measured, and some are split.
  struct Level {
    int cells = 0;   ///< triangles or segments before the round
    int edges = 0;   ///< new in this round
    int marked = 0;  ///< of these: longer than their geodesics by more than the threshold
    double greatest_excess = kNotComputed;  ///< of an edge over its geodesic, as a share
    int new_nodes = 0;
    double seconds = 0;
  };
  int vertices = 0, triangles = 0;
  int distance_vertices = 0;            ///< of the level on which distances were measured
  int poses = 0, nodes = 0, cells = 0;  ///< cells: triangles or segments of the plane
  std::string metric;
  double unit = kNotComputed;  ///< the length in the user's unit that has length 1 in the metric
  double threshold = kNotComputed;
  int solved = 0;                ///< geodesics solved in this run
  int found = 0;                 ///< read from the records of an earlier run
  int damaged = 0;               ///< in damaged records; solved again
  int not_converged = 0;         ///< of all
  double stress = kNotComputed;  ///< Embedding::stress
  int stress_iterations = 0;
  bool embedded = false;  ///< whether the embedding converged
  std::vector<Level> levels;
  /// Edges of the last triangulation that were not measured because the depth was reached; 0: no
  /// edge exceeds the threshold. MeasureBlends measures the quality of the space.
  int edges_not_measured = -1;
  std::vector<std::string> warnings;  ///< to be checked by the user
  double distance_seconds = 0, embedding_seconds = 0, refinement_seconds = 0, total_seconds = 0;
  int threads = 1, processes = 1;

  bool Converged() const { return not_converged == 0 && embedded; }
  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< a page
  std::string ToJson() const;
};

struct ExploreResult {
  PoseSpace space;
  ExploreSummary summary;
};

/// Lengths of the geodesics between all pairs of poses, as pure numbers: symmetric, zero on the
/// diagonal and between rigid copies. All use one metric, frozen on all poses, and one hierarchy.
/// \throw InvalidOptions, MeshError (fewer than two poses; see FreezeMetric), SolverError,
///        Cancelled, FileError (records).
Eigen::MatrixXd DistanceMatrix(const std::shared_ptr<const Connectivity>& connectivity,
                               const std::vector<Shape>& poses, const ExploreOptions& options = {},
                               Progress* progress = nullptr, ProcessPool* crew = nullptr);

/// The space of some poses (Kilian et al. 2007, section 5): their distances, their positions on the
/// plane (`Embed`), a triangulation of these (`DelaunayTriangulation`), and midpoints of geodesics
/// as additional nodes where the straight line between two nodes is too long. If a triangle has
/// such a side, all its sides are halved; so are those of a neighbour with two halved sides, and a
/// neighbour with one halved side is cut in two, so that no node lies inside a side. `names` are
/// those of the poses and may be empty.
///
/// `crew`, if not null, shares the geodesics out among processes. All processes get the same
/// result, which does not depend on their number.
/// \throw as DistanceMatrix; SolverError also if all poses are rigid copies of one.
ExploreResult Explore(const std::shared_ptr<const Connectivity>& connectivity,
                      const std::vector<Shape>& poses, std::vector<std::string> names = {},
                      const ExploreOptions& options = {}, Progress* progress = nullptr,
                      ProcessPool* crew = nullptr);

/// Removes the geodesics that a run stored in `folder`, and the folder if it is then empty.
void RemoveRecords(const std::string& folder);

/// Deviation of linear blends from blends along geodesics.
struct BlendErrors {
  int samples = 0;
  int vertices = 0;  ///< of the hierarchy's level on which this was measured
  double mean = kNotComputed,
         max = kNotComputed;  ///< length of the geodesic between the two blends, as a share of the
                              ///< greatest distance between two poses
  double within = kNotComputed;  ///< share of the samples whose deviation is within the threshold
};

/// Compares Space::At with blends along geodesics at `samples` points, uniformly distributed over
/// the plane (pseudo-random with a fixed seed). A blend of three nodes along geodesics is found in
/// two steps: the shape on the geodesic between the two nodes of greatest weight, then the shape on
/// the geodesic from there to the third node. Everything is measured in the metric of the space.
/// Uses `geodesic` except for its metric, `resolution`, `threshold` and `records` of the options.
/// \throw as DistanceMatrix.
BlendErrors MeasureBlends(const PoseSpace& space, int samples, const ExploreOptions& options = {},
                          Progress* progress = nullptr, ProcessPool* crew = nullptr);

}  // namespace shapespace

#endif  // SHAPESPACE_EXPLORATION_EXPLORE_H_
