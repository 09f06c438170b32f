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
  kArea,     ///< by the surrounding area: invariant under scale, nearly so under tessellation
  kUniform,  ///< 1, as in the paper; the meaning depends on the mesh resolution
};

/// What the numbers of a stiffness (MetricOptions) belong to.
enum class StiffnessOn {
  kVertices,  ///< one number per vertex
  kEdges,     ///< one number per edge, in the order of Connectivity::Edges
};

/// The pairs of poses for which the metric is intended. Hinges that turn by more than 90 degrees
/// between the poses of a pair are down-weighted.
enum class PosePairs {
  kConsecutive,  ///< each pose and the next: for a path through them
  kAll,          ///< all pairs: independent of the poses' order
};

/// The data from which features compute their weights: a mesh and poses, in the metric's unit of
/// length. Measures are means over the poses.
struct MetricBasis {
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<Shape> poses;
  PosePairs pairs = PosePairs::kConsecutive;
  Weighting weighting = Weighting::kArea;

  double unit = 1;                 ///< length, in the user's unit, that has length 1 in the metric
  Eigen::VectorXd triangle_area;   ///< with sum 1 (for graphs, the sum of edge lengths is 1)
  Eigen::VectorXd vertex_area;     ///< A_p, as in `Metric`
  Eigen::VectorXd edge_area;       ///< A_e, as in `Metric`
  Eigen::VectorXd hinge_area;      ///< A_f, a third of the area of the hinge's two triangles
  Eigen::VectorXd squared_length;  ///< of edges

  /// The user's stiffness (MetricOptions), 1 by default: of edges and triangles for stretching, of
  /// hinges and edges for bending. That of edges is for curves.
  Eigen::VectorXd edge_stiffness, triangle_stiffness, hinge_stiffness, edge_bending_stiffness;

  /// Relative to the mean edge: shorter edges, and triangles of that size, count as collapsed.
  static constexpr double kCollapsed = 1e-8;
  /// The square of that length, with which features of collapsed elements remain finite.
  double CollapsedSquared() const { return kCollapsed * kCollapsed * squared_length.mean(); }
};

struct MetricOptions;

/// Measures the mesh for a metric; arguments as for `FreezeMetric`, whose exceptions it throws.
MetricBasis MakeMetricBasis(const MetricOptions& options,
                            const std::shared_ptr<const Connectivity>& connectivity,
                            const std::vector<Shape>& poses, double unit, PosePairs pairs);

/// The user's stiffness (MetricOptions), given `on` vertices or edges, as one number per vertex: of
/// edges the geometric mean over those at the vertex.
Eigen::VectorXd VertexStiffness(const Eigen::VectorXd& field, StiffnessOn on,
                                const Connectivity& connectivity);

/// The same as one number per edge: of vertices the mean of the edge's two ends.
Eigen::VectorXd EdgeStiffness(const Eigen::VectorXd& field, StiffnessOn on,
                              const Connectivity& connectivity);

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_METRIC_BASIS_H_
