#ifndef SHAPESPACE_METRIC_METRIC_H_
#define SHAPESPACE_METRIC_METRIC_H_

#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/dihedral.h>
#include <shapespace/metric/edge_length.h>
#include <shapespace/metric/feature.h>
#include <shapespace/metric/metric_basis.h>
#include <shapespace/metric/position.h>
#include <shapespace/metric/rigid.h>
#include <shapespace/metric/triangle_strain.h>
#include <shapespace/metric/volume.h>

namespace shapespace {

/// The discretisation of a segment's energy.
enum class Discretization {
  kMidpoint,   ///< differences of Phi: second order, certified by a lower bound
  kTrapezoid,  ///< the paper's (6) for edge lengths and positions; penalises rotation of edges
};

/// A registered feature (define_feature.h) with its coefficient.
struct FeatureTerm {
  std::string name;
  double coefficient = 1;  ///< zero or more
};

/// The coefficients of a metric, a blend of features; not negative. Pure numbers, for units in
/// which the surface has area 1.
struct MetricOptions {
  double isometric = 0;  ///< change of edge lengths, the paper's (4)
  double strain = 1;     ///< change of the triangles' logarithmic strains, and of the logarithms of
                         ///< the lengths of edges that are no sides of triangles
  double rigid = 0;      ///< deviation from rigid motion of the whole, the paper's (3)
  double lambda = 1e-4;  ///< motion of vertices, the paper's (5); harmless up to 1e-3
  double bending = 1e-5;  ///< change of dihedral angles, and of the angles by which curves turn:
                          ///< t^2 / 12 for a shell of thickness t
  double volume = 0;      ///< change of enclosed volume, closed meshes only; start from 0.3
  std::vector<FeatureTerm> features;  ///< user-defined: docs/guide/features.md
  Weighting weights = Weighting::kArea;
  Discretization discretization = Discretization::kMidpoint;

  /// Positive factors on the cost of stretching (isometric and strain) and of bending, for bodies
  /// of varying stiffness: one number per vertex or per edge, as `stiffness_on` says. Where they
  /// are given on vertices, edges have the mean of their two ends; triangles have the mean of their
  /// three sides. Empty: 1 everywhere. On coarser levels of a solver they are geometric means over
  /// the vertices that have collapsed to a vertex.
  Eigen::VectorXd stretching_stiffness, bending_stiffness;
  StiffnessOn stiffness_on = StiffnessOn::kVertices;  ///< of both

  /// The default: as isometric as possible, measured by strains. Paths can be continued without
  /// limit, and fewer of them jump than under `Isometric` (docs/measurements.md, section 3).
  static MetricOptions Strain() { return {}; }
  /// As isometric as possible, measured by squared edge lengths as in the paper's (4).
  static MetricOptions Isometric();
  /// For deformation by handles: stretching is measured partly by lengths and partly by strains,
  /// and there is no cost of position. A mesh that encloses a volume in the shape `rest` (3 x m,
  /// any unit) is regarded as the surface of a solid body, stiff in bending, with a cost of volume
  /// (which keeps it within some per cent; a coefficient of 30 keeps it within .3 %); any other as
  /// a sheet. \throw MeshError if the shape has another number of vertices.
  static MetricOptions Deformation(const Connectivity& connectivity, const Shape& rest);
  /// As rigid as possible: (3) + lambda (5).
  static MetricOptions Rigid();
  /// The paper's metric: isometric 1 with weight w_e = 1 for every edge, lambda 0.001, no bending,
  /// trapezoid. (4), (5), w_e, lambda and the energy (6) are the paper's, to rounding. There are
  /// these differences. The areas A_p are constant means over the poses; in the paper they change
  /// with the shape. As for all metrics here, poses are aligned rigidly first, and the rigid motion
  /// between them is stored separately and has no cost. (Inner shapes are not moved rigidly, as
  /// they are in midpoint form, because rotation has a cost in (6).) In solves with fewer shapes,
  /// which only prepare others, the part of (6) that penalises the rotation of edges has a smaller
  /// weight (docs/mathematics.md, section 6). Lengths are measured in the unit in which the surface
  /// has area 1, which changes the energy's value but not the path, because (4) and (5) both scale
  /// with the fourth power of length. Since (4) has one term per edge, the meaning of lambda
  /// depends on the mesh resolution. The paper's order of levels is GeodesicSchedule::kPaper, which
  /// must be selected separately. Paths are continued in midpoint form.
  static MetricOptions Paper();

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// A blend frozen on a connectivity and given poses: all weights are constants, so that all solvers
/// and all paths between these poses use the same lengths. It applies to shapes in its own unit:
/// divide the user's coordinates by `unit`. Immutable, because the coarser levels of a solver make
/// metrics of their own from `options`: to weight elements differently, use the stiffness in the
/// options, or define a feature.
struct Metric {
  MetricOptions options;  ///< as given, except that bending is 0 if the mesh cannot bend
  std::shared_ptr<const Connectivity> connectivity;
  double unit = 1;  ///< length, in the user's unit, that has length 1 in the metric
  /// A_p, a third of the area of the triangles at the vertex; with sum 1 unless there are vertices
  /// without triangles. All positive, also for degenerate meshes.
  Eigen::VectorXd vertex_area;
  /// A_e, a third of the area of the triangles at the edge; of edges that are no sides of triangles
  /// a sixth of the areas at their two ends.
  Eigen::VectorXd edge_area;
  Eigen::VectorXd hinge_area;  ///< A_f, a third of the area of the hinge's two triangles
  std::vector<std::shared_ptr<const Feature>> features;
  RigidForm rigid;

  /// True if rigid motion of a shape has no cost except that of position; then solvers remove it
  /// exactly.
  bool RigidInvariantButForPosition() const;
};

/// Freezes `options` on all `poses` (user's units; each 3 x m): squared edge lengths and areas are
/// the means over the poses; the `pairs` determine which hinges are down-weighted. Graphs without
/// faces have total edge length 1 instead of area 1. `unit` > 0 specifies the unit, which coarse
/// levels of a mesh take from the finest one. If the mesh cannot bend (`Bends`),
/// `Metric::options.bending` is 0.
/// \throw InvalidOptions if the options are invalid, name a feature that is not registered, have
///        stiffness of another number than the mesh has vertices (or edges, `stiffness_on`), or ask
///        for volume and the mesh is not closed; MeshError if a shape has another number of
///        vertices, is not finite, has no extent or lies beyond `kLargestCoordinate`.
std::shared_ptr<const Metric> FreezeMetric(const MetricOptions& options,
                                           const std::shared_ptr<const Connectivity>& connectivity,
                                           const std::vector<Shape>& poses, double unit = 0,
                                           PosePairs pairs = PosePairs::kConsecutive);

/// Whether bending can have a cost: two triangles share an edge, or segments form a curve
/// (`TurningAngle`).
bool Bends(const Connectivity& connectivity);

/// The blend by name, for reports: e.g. "strain 1, lambda 0.0001, bending 1e-05".
std::string DescribeMetric(const MetricOptions& options);

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_METRIC_H_
