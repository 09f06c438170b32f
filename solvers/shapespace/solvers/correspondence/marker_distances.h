#ifndef SHAPESPACE_SOLVERS_CORRESPONDENCE_MARKER_DISTANCES_H_
#define SHAPESPACE_SOLVERS_CORRESPONDENCE_MARKER_DISTANCES_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

// Private.

namespace shapespace::internal {

/// Distances along a mesh's edges (Dijkstra) from each of `vertices`, one a column; infinite where
/// no edge leads. Bends leave them as they are, which is what both uses of them rest on.
Eigen::MatrixXf DistancesFrom(const Connectivity& connectivity, const Shape& shape,
                              const std::vector<int>& vertices);

/// Of each vertex the one of `vertices` that is nearest along the mesh's edges; -1 where no edge
/// leads from one.
std::vector<int> NearestOf(const Connectivity& connectivity, const Shape& shape,
                           const std::vector<int>& vertices);

/// Which points of two bodies may belong together, as far as their distances from the markers
/// tell: the marker nearest to the one must not be far from the other. So a hand that rests on a
/// hip is not taken for a piece of the hip.
class MarkerDistances {
 public:
  /// Distances on both bodies, one row a vertex and one column a marker, in units in which the
  /// bodies are equally large and the target's area is 1.
  MarkerDistances(Eigen::MatrixXf on_template, Eigen::MatrixXf on_target);

  bool MayMatch(int template_vertex, int target_vertex) const {
    return IsNear(on_target_(target_vertex, nearest_template_[template_vertex]),
                  least_template_[template_vertex]) &&
           IsNear(on_template_(template_vertex, nearest_target_[target_vertex]),
                  least_target_[target_vertex]);
  }

  const Eigen::MatrixXf& OnTemplate() const { return on_template_; }
  const Eigen::MatrixXf& OnTarget() const { return on_target_; }

 private:
  // Twice as far, for proportions differ, and a tenth or so of the body more, for near a marker
  // all is soon twice as far.
  static bool IsNear(float distance, float wanted) { return distance <= 2 * wanted + 0.15F; }

  Eigen::MatrixXf on_template_, on_target_;
  std::vector<int> nearest_template_, nearest_target_;  // marker
  std::vector<float> least_template_, least_target_;    // distance
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_CORRESPONDENCE_MARKER_DISTANCES_H_
