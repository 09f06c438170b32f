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

/// How the metric is integrated along a segment of a path.
enum class Discretization {
  kMidpoint,   ///< differences of Phi: second order, certified by a lower bound
  kTrapezoid,  ///< the paper's (6) for edge lengths and positions; penalises rotation of edges
};

/// A registered feature (define_feature.h) in a blend.
struct FeatureTerm {
  std::string name;
  double coefficient = 1;  ///< zero or more
};

/// Which motions cost how much: non-negative coefficients of a blend. Pure numbers: everything is
/// measured in units in which the surface has area 1.
struct MetricOptions {
  double isometric = 1;   ///< change of edge lengths, the paper's (4)
  double strain = 0;      ///< change of the triangles' logarithmic strains; paths can always go on
  double rigid = 0;       ///< deviation from rigid motion of the whole, the paper's (3)
  double lambda = 1e-4;   ///< motion of vertices, the paper's (5); harmless up to 1e-3
  double bending = 1e-5;  ///< change of dihedral angles: t^2 / 12 for a shell of thickness t
  double volume = 0;      ///< change of enclosed volume, closed meshes only; start from 0.3
  std::vector<FeatureTerm> features;  ///< of your own: docs/guide/features.md
  Weighting weights = Weighting::kArea;
  Discretization discretization = Discretization::kMidpoint;

  /// Factors, all positive, on the cost of stretching (isometric and strain) and of bending, where
  /// a body is stiffer or softer: one number a vertex, or else one an edge (Connectivity::Edges).
  /// Edges take the mean of their two ends, triangles that of their three sides. Empty: 1
  /// everywhere. Coarser levels of a solver take geometric means over the vertices that a vertex of
  /// theirs stands for.
  Eigen::VectorXd stretching_stiffness, bending_stiffness;

  static MetricOptions Isometric() { return {}; }
  /// As isometric as possible, by strains: paths between poses are much as under `Isometric`, and
  /// can be continued without end.
  static MetricOptions Strain();
  /// For moving parts of a mesh by handles: stretching partly as lengths and partly as strains, and
  /// no cost of position. A closed mesh is the skin of a solid body, stiff in bending, whose volume
  /// counts (it stays within some per cent; ask for a volume of 30 to have it within .3 %); an open
  /// one is a sheet.
  static MetricOptions Deformation(const Connectivity& connectivity);
  /// As rigid as possible: (3) + lambda (5).
  static MetricOptions Rigid();
  /// The paper's setting: isometric 1 with weight w_e = 1 for every edge, lambda 0.001, no bending,
  /// trapezoid. (4), (5), w_e, lambda and the energy (6) are the paper's, to rounding. What is not:
  /// the areas A_p are means over the poses and stay so, where the paper's move with the shape; and
  /// what holds for all metrics here: poses are aligned rigidly first, and the rigid motion between
  /// them is carried beside the path, and costs nothing. (Inner shapes are not moved rigidly, as
  /// they are in midpoint form: rotation has a cost in (6).) While few shapes prepare more, the
  /// part of (6) that penalises the rotation of edges is weighted down (docs/mathematics.md,
  /// section 6). Lengths are measured in the unit in which the surface has area 1, which changes
  /// the energy's value and not the path: (4) and (5) both go with the fourth power of length. But
  /// (4) has a term an edge, so that lambda means something else at every mesh resolution.
  /// Schedule::kPaper has the paper's order of levels, which must be asked for. Paths are continued
  /// in midpoint form.
  static MetricOptions Paper();

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// A blend frozen on a connectivity and the poses that take part: all weights are numbers, so that
/// every solver, and every path between these poses, means the same by a length. Works on shapes in
/// its own unit: divide the user's coordinates by `unit`. Immutable, since the coarser levels of a
/// solver make metrics of their own from `options`: to weigh elements differently, use the options'
/// stiffness, or a feature of your own.
struct Metric {
  MetricOptions options;  ///< as given; but bending is 0 where the mesh has no hinge
  std::shared_ptr<const Connectivity> connectivity;
  double unit = 1;              ///< length, in the user's units, that has length 1 here
  Eigen::VectorXd vertex_area;  ///< A_p, of sum 1 (all positive, also where the mesh degenerates)
  Eigen::VectorXd edge_area;    ///< A_e, a third of the triangles at the edge
  Eigen::VectorXd hinge_area;   ///< A_f, a third of the hinge's two triangles
  std::vector<std::shared_ptr<const Feature>> features;
  RigidForm rigid;

  /// True if rigid motion of a shape costs nothing but position: then solvers take it out exactly.
  bool RigidInvariantButForPosition() const;
};

/// Freezes `options` on all `poses` (user's units; each 3 x m): squared edge lengths and areas are
/// the poses' means, the damping of hinges looks at the `pairs`. Graphs without faces
/// have total edge length 1 instead of area 1. `unit` > 0 is the unit to take instead: coarse
/// levels of a mesh take the finest one's. Where no two triangles share an edge, as in graphs,
/// nothing can bend: `Metric::options.bending` is 0 then.
/// \throw InvalidOptions if the options are invalid, name a feature that is not registered, have
/// stiffness for another number of vertices or edges, or ask for volume and the mesh is not closed;
/// MeshError if a shape has another number of vertices, is not finite, has no extent or lies beyond
/// `kLargestCoordinate`.
std::shared_ptr<const Metric> FreezeMetric(const MetricOptions& options,
                                           const std::shared_ptr<const Connectivity>& connectivity,
                                           const std::vector<Shape>& poses, double unit = 0,
                                           PosePairs pairs = PosePairs::kConsecutive);

/// The same blend, by name, for reports: e.g. "isometric 1, lambda 0.0001, bending 1e-05".
std::string Describe(const MetricOptions& options);

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_METRIC_H_
