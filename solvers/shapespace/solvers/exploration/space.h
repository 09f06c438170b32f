#ifndef SHAPESPACE_SOLVERS_EXPLORATION_SPACE_H_
#define SHAPESPACE_SOLVERS_EXPLORATION_SPACE_H_

#include <array>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/appearance.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/path.h>

namespace shapespace {

/// Where a point of the plane lies between the nodes of a space.
struct PlaneLocation {
  std::array<int, 3> nodes = {0, 0, 0};
  /// Of these, not negative, of sum 1; 0 for a node that takes no part, as the third on a segment.
  std::array<double, 3> weights = {1, 0, 0};
  Eigen::Vector2d point = Eigen::Vector2d::Zero();  ///< the point itself, or the nearest inside
  bool inside = true;                               ///< false: the point lies outside the hull
};

/// scale (w_1 node_1 + w_2 node_2 + w_3 node_3).
Shape BlendNodes(const std::vector<Shape>& nodes, const PlaneLocation& location, double scale = 1);

/// Poses of a mesh and shapes between them, spread out on a plane such that distances on the plane
/// are about the lengths of geodesics (Kilian et al. 2007, section 5 and Figures 7 and 8). Between
/// nodes shapes are blended linearly, over the triangles of the plane.
struct Space {
  std::shared_ptr<const Metric> metric;  ///< frozen on all poses; has the connectivity

  /// The poses, then the shapes found half way between nodes: all turned onto the first pose,
  /// centred, in the metric's unit. Use `Placed` for shapes as large as the user's are.
  std::vector<Shape> nodes;
  std::vector<std::string> names;                         ///< of the poses
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< of all shapes, to where the first
                                                          ///< pose is, in the user's unit
  Eigen::Matrix2Xd points;  ///< each node's place on the plane, in the unit of lengths

  /// Corners, counterclockwise, of the triangles that tile the hull; no node lies inside a side.
  Eigen::Matrix3Xi triangles;
  /// In their place, where all poses lie on a line: from each node to the next on it.
  Eigen::Matrix2Xi segments;

  /// Of node NumPoses() + i: the two nodes that it lies half way between.
  std::vector<std::array<int, 2>> parents;

  Eigen::MatrixXd distances;  ///< between every two poses: lengths of geodesics, pure numbers
  double stress = 0;          ///< of the poses' places (Embedding::stress)
  std::string provenance;     ///< who made it, from what
  Appearance appearance;      ///< of the connectivity's polygons: for outputs

  int NumNodes() const { return static_cast<int>(nodes.size()); }
  int NumPoses() const { return static_cast<int>(names.size()); }
  Shape Placed(int node) const { return Blend({{node, node, node}, {1, 0, 0}, {}, true}); }

  /// O(triangles). A point outside is moved to the nearest one of the hull.
  PlaneLocation Locate(const Eigen::Vector2d& point) const;

  /// The blend of nodes, in the user's unit.
  Shape Blend(const PlaneLocation& location) const;

  /// The shape at a point of the plane, in the user's unit: continuous, linear within a triangle,
  /// and at a node's place that node.
  Shape At(const Eigen::Vector2d& point) const { return Blend(Locate(point)); }

  /// \throw MeshError if numbers of nodes, vertices or anything else do not fit together, an index
  ///        is out of range, or a number is not finite.
  void Validate() const;
};

/// A motion that a curve on the plane leads to.
struct Walk {
  Path path;  ///< no geodesic: a sequence of blends; `poses` are those that are met exactly
  std::vector<PlaneLocation> locations;  ///< of its shapes
  int outside = 0;                       ///< how many of these were moved into the hull
};

/// The shapes along a polyline of the plane, at `frames` points that are evenly spaced along it.
/// \throw InvalidOptions if there is no point, one is not finite, or frames are fewer than 1.
Walk WalkAlong(const Space& space, const std::vector<Eigen::Vector2d>& polyline, int frames);

}  // namespace shapespace

#endif  // SHAPESPACE_SOLVERS_EXPLORATION_SPACE_H_
