#ifndef SHAPESPACE_METRIC_METRIC_BASIS_H_
#define SHAPESPACE_METRIC_METRIC_BASIS_H_

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// Weights of edges and triangles in the isometric and strain features, and of vertices in the
/// rigid metric.
enum class Weighting {
  kArea,     ///< by the surface around: unchanged by scale, nearly so by tessellation
  kUniform,  ///< 1: the paper's, which means something else at every mesh resolution
};

/// Between which of the poses that it is frozen on a metric is to be good: hinges that jump from
/// one to the other are damped.
enum class PosePairs {
  kConsecutive,  ///< from each to the next: for a path through them
  kAll,          ///< from each to every other: their order does not matter
};

/// What features make their weights from: a mesh and the poses that take part, in the metric's unit
/// of length. Measures are means over the poses.
struct MetricBasis {
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<Shape> poses;
  PosePairs pairs = PosePairs::kConsecutive;
  Weighting weighting = Weighting::kArea;

  double unit = 1;                 ///< length, in the user's units, that has length 1 here
  Eigen::VectorXd triangle_area;   ///< their sum is 1, or that of a graph's edge lengths is
  Eigen::VectorXd vertex_area;     ///< A_p, of sum 1; all positive, also where the mesh degenerates
  Eigen::VectorXd edge_area;       ///< A_e, a third of the triangles at the edge
  Eigen::VectorXd hinge_area;      ///< A_f, a third of the hinge's two triangles
  Eigen::VectorXd squared_length;  ///< of edges

  /// The user's stiffness (MetricOptions), 1 where there is none: of edges and triangles against
  /// stretching, of hinges against bending.
  Eigen::VectorXd edge_stiffness, triangle_stiffness, hinge_stiffness;

  /// Relative to the mean edge: below such lengths an edge or triangle counts as collapsed.
  static constexpr double kCollapsed = 1e-8;
  /// The square of that length, which keeps features of what has collapsed finite.
  double CollapsedSquared() const { return kCollapsed * kCollapsed * squared_length.mean(); }
};

struct MetricOptions;

/// Measures the mesh for a metric; arguments as for `FreezeMetric`, whose exceptions it throws.
MetricBasis MakeMetricBasis(const MetricOptions& options,
                            const std::shared_ptr<const Connectivity>& connectivity,
                            const std::vector<Shape>& poses, double unit, PosePairs pairs);

/// The user's stiffness (MetricOptions), of vertices or of edges, as one number a vertex: of edges
/// the geometric mean over those at the vertex.
Eigen::VectorXd VertexStiffness(const Eigen::VectorXd& field, const Connectivity& connectivity);

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_METRIC_BASIS_H_
