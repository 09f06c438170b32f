#ifndef SHAPESPACE_CORRESPONDENCE_DETAIL_MARKER_DISTANCES_H_
#define SHAPESPACE_CORRESPONDENCE_DETAIL_MARKER_DISTANCES_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// Distances along a mesh's edges (Dijkstra) from each of `vertices`, one per column; infinite if
/// there is no connection. Bending does not change them, which both uses rely on.
Eigen::MatrixXf DistancesFrom(const Connectivity& connectivity, const Shape& shape,
                              const std::vector<int>& vertices);

/// Per vertex, the nearest of `vertices` along the mesh's edges; -1 if none is connected to it.
std::vector<int> NearestOf(const Connectivity& connectivity, const Shape& shape,
                           const std::vector<int>& vertices);

/// Tells which points of two bodies may correspond, according to their distances from the markers:
/// the marker nearest to the one must not be far from the other. For instance, this keeps a hand
/// that rests on a hip from being matched with the hip.
class MarkerDistances {
 public:
  /// Distances on both bodies, one row per vertex and one column per marker, in units in which the
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
  // A factor of two for different proportions, and an offset because near a marker small distances
  // easily differ by more than that factor.
  static bool IsNear(float distance, float wanted) { return distance <= 2 * wanted + 0.15F; }

  Eigen::MatrixXf on_template_, on_target_;
  std::vector<int> nearest_template_, nearest_target_;  // index of the marker
  std::vector<float> least_template_, least_target_;    // distance from it
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CORRESPONDENCE_DETAIL_MARKER_DISTANCES_H_
