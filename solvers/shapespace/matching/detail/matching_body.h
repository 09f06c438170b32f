#ifndef SHAPESPACE_MATCHING_DETAIL_MATCHING_BODY_H_
#define SHAPESPACE_MATCHING_DETAIL_MATCHING_BODY_H_

#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/base/progress.h>
#include <shapespace/matching/detail/border.h>
#include <shapespace/matching/detail/extremities.h>
#include <shapespace/matching/detail/farthest_points.h>
#include <shapespace/matching/detail/laplacian.h>
#include <shapespace/matching/detail/spectrum.h>
#include <shapespace/matching/detail/surface_graph.h>
#include <shapespace/matching/detail/working_surface.h>

namespace shapespace::internal {

/// The inner geometry of one body, from which maps are found. Vertices are those of the working
/// surface, lengths shares of the root of its area.
struct MatchingBody {
  /// \throw as MakeWorkingSurface; SolverError.
  MatchingBody(const std::string& name, const Connectivity& connectivity, const Shape& shape,
               Progress* progress);

  /// The values of `field` (n x columns) without their waves shorter than those of the first
  /// eigenfunctions, at chosen vertices: rows.size() x columns.
  Eigen::MatrixXf Smooth(const Eigen::MatrixXf& field, const std::vector<int>& rows) const;

  /// Whether it lacks a part: has a border longer than that of a hole.
  bool IsOpen() const { return border.longest > kLongestHole; }

  /// Whether a vertex is so far from the border that curvature and heat there are those of the
  /// body.
  bool IsInner(int vertex) const;

  WorkingSurface surface;
  SurfaceGraph graph;
  Laplacian laplacian;
  Spectrum spectrum;
  EvenSamples even;                  ///< 200, evenly along the surface
  std::vector<int> spread;           ///< 1500, evenly among the first eigenfunctions
  std::vector<int> extremities;      ///< the principal ones, in descending order of persistence
  std::vector<int> all_extremities;  ///< these, then minor ones
  SurfaceBorder border;
  Eigen::VectorXf from_border;  ///< of each vertex, its distance; infinite if there is no border
  /// The principal ones among extremities that are not where something is cut off.
  std::vector<int> inner_extremities;
  /// These, and behind them the principal ones that are on the border: corners of a cut, or ends of
  /// limbs that are cut lengthwise or seen from one side.
  std::vector<int> part_extremities;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_MATCHING_BODY_H_
