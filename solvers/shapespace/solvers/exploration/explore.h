#ifndef SHAPESPACE_SOLVERS_EXPLORATION_EXPLORE_H_
#define SHAPESPACE_SOLVERS_EXPLORATION_EXPLORE_H_

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/base/progress.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/solvers/exploration/crew.h>
#include <shapespace/solvers/exploration/embedding.h>
#include <shapespace/solvers/exploration/space.h>
#include <shapespace/solvers/geodesic.h>

namespace shapespace {

/// How to make a space of poses.
struct ExploreOptions {
  /// Of every geodesic. `shapes` must be odd, since shapes half way are wanted; `assess` is not
  /// read. The rigid metric, which has no length, is refused.
  GeodesicOptions geodesic = Defaults();

  /// Triangles, at most, of the level of the hierarchy on which the distances between poses are
  /// measured; the coarsest level has as many as it has. 0: the mesh itself. With many poses of
  /// fine meshes, 5000 saves most of the time. Between armadillos of 29 K triangles it changes
  /// distances by up to 12 %, but all by nearly one factor, within 4 %.
  int resolution = 0;

  /// A straight line between two nodes that is longer than the geodesic by more than this share is
  /// replaced by two, over the shape half way on the geodesic.
  double threshold = 0.05;

  /// How often a triangle may be split, at most.
  int depth = 2;

  EmbeddingOptions embedding;

  /// A folder in which finished geodesics are kept, and nothing else should be: if a run is ended,
  /// the next one with the same inputs and options goes on from there. The caller removes it
  /// (RemoveRecords). Processes of a crew must all see the same disk. Empty: nothing is kept.
  std::string records;

  static GeodesicOptions Defaults();

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// What happened, and how good the answer is.
struct ExploreSummary {
  /// A round: all new edges are measured, and some are split.
  struct Level {
    int cells = 0;   ///< triangles or segments before
    int edges = 0;   ///< that were new
    int marked = 0;  ///< of these: longer than their geodesics by more than the threshold
    double greatest_excess = 0;  ///< the most that one was longer by, as a share
    int new_nodes = 0;
    double seconds = 0;
  };
  int vertices = 0, triangles = 0;
  int distance_vertices = 0;            ///< of the level on which distances were measured
  int poses = 0, nodes = 0, cells = 0;  ///< cells: triangles or segments of the plane
  std::string metric;
  double unit = 1;  ///< the user's length that counts as 1
  double threshold = 0;
  int solved = 0;         ///< geodesics that were solved now
  int found = 0;          ///< that an earlier run had left
  int damaged = 0;        ///< that it had left, but not whole: solved again
  int not_converged = 0;  ///< of all
  double stress = 0;      ///< Embedding::stress
  int stress_iterations = 0;
  bool embedded = true;  ///< whether the embedding converged
  std::vector<Level> levels;
  /// Edges of the last triangulation that nobody has looked at, since the depth was reached; 0: no
  /// edge is longer than the threshold allows. MeasureBlends tells how good the space is.
  int edges_not_measured = 0;
  std::vector<std::string> warnings;  ///< what a person should look at
  double distance_seconds = 0, embedding_seconds = 0, refinement_seconds = 0, total_seconds = 0;
  int threads = 1, processes = 1;

  bool Converged() const { return not_converged == 0 && embedded; }
  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< a page
  std::string ToJson() const;
};

struct ExploreResult {
  Space space;
  ExploreSummary summary;
};

/// Lengths of the geodesics between every two poses, as pure numbers: symmetric, zero on the
/// diagonal and between rigid copies. One metric, frozen on all poses, and one hierarchy serve all.
/// \throw InvalidOptions, MeshError (fewer than two poses; see FreezeMetric), SolverError,
/// Cancelled,
///        FileError (records).
Eigen::MatrixXd DistanceMatrix(const std::shared_ptr<const Connectivity>& connectivity,
                               const std::vector<Shape>& poses, const ExploreOptions& options = {},
                               Progress* progress = nullptr, Crew* crew = nullptr);

/// The space of some poses (Kilian et al. 2007, section 5): their distances, their places on the
/// plane (`Embed`), what lies between these (`Triangulate`), and shapes half way on geodesics
/// wherever straight lines between shapes are too long: all edges of a triangle that has such a
/// side are halved, a neighbour's likewise where two of its sides are, and a neighbour with one
/// halved side is cut in two, so that no node lies inside a side. `names` are the poses'; there may
/// be none.
///
/// `crew`, if not null, shares the geodesics out among processes; all get the same result, which
/// does not depend on their number.
/// \throw as DistanceMatrix; SolverError too if all poses are rigid copies of one.
ExploreResult Explore(const std::shared_ptr<const Connectivity>& connectivity,
                      const std::vector<Shape>& poses, std::vector<std::string> names = {},
                      const ExploreOptions& options = {}, Progress* progress = nullptr,
                      Crew* crew = nullptr);

/// Removes the geodesics that a run kept in `folder`, and the folder if nothing else is in it.
void RemoveRecords(const std::string& folder);

/// How far linear blends are from true ones.
struct BlendErrors {
  int samples = 0;
  int vertices = 0;          ///< of the level of the hierarchy on which this was measured
  double mean = 0, max = 0;  ///< length of the geodesic from one to the other, as a share of the
                             ///< greatest distance between two poses
  double within = 0;         ///< share of the samples that are off by no more than the threshold
};

/// Compares Space::At with true blends at so many points, evenly spread over the plane at random
/// (the same ones every time). The true blend of three nodes goes along the geodesic between the
/// two of most weight, and from there along the one to the third. Reads `geodesic`, `resolution`,
/// `threshold` and `records` of the options. \throw as DistanceMatrix.
BlendErrors MeasureBlends(const Space& space, int samples, const ExploreOptions& options = {},
                          Progress* progress = nullptr, Crew* crew = nullptr);

}  // namespace shapespace

#endif  // SHAPESPACE_SOLVERS_EXPLORATION_EXPLORE_H_
