#ifndef SHAPESPACE_EXPLORATION_SPACE_H_
#define SHAPESPACE_EXPLORATION_SPACE_H_

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

/// The position of a point of the plane relative to the nodes of a space.
struct PlaneLocation {
  std::array<int, 3> nodes = {0, 0, 0};
  /// Weights of these: not negative, with sum 1; 0 for unused nodes, such as the third one for a
  /// segment.
  std::array<double, 3> weights = {1, 0, 0};
  Eigen::Vector2d point = Eigen::Vector2d::Zero();  ///< the point, or the nearest of the hull
  bool inside = true;                               ///< whether the point lies in the hull
};

/// scale (w_1 node_1 + w_2 node_2 + w_3 node_3).
Shape BlendNodes(const std::vector<Shape>& nodes, const PlaneLocation& location, double scale = 1);

/// Poses of a mesh and shapes between them, arranged on a plane such that distances on the plane
/// approximate the lengths of geodesics (Kilian et al. 2007, section 5 and Figures 7 and 8).
/// Between nodes shapes are blended linearly, over the triangles of the plane.
struct PoseSpace {
  std::shared_ptr<const Metric> metric;  ///< frozen on all poses; has the connectivity

  /// The poses, followed by the midpoints of geodesics: all aligned with the first pose, centred,
  /// in the metric's unit. Use `Placed` for shapes in the user's unit.
  std::vector<Shape> nodes;
  std::vector<std::string> names;                         ///< of the poses
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();  ///< of all shapes, to the position of the
                                                          ///< first pose, in the user's unit
  Eigen::Matrix2Xd points;  ///< positions of the nodes on the plane, in the unit of lengths

  /// Vertices, counterclockwise, of the triangles that cover the hull; no node lies inside a side.
  Eigen::Matrix3Xi triangles;
  /// Instead of triangles, if all poses lie on a line: from each node to the next one on it.
  Eigen::Matrix2Xi segments;

  /// Of node NumPoses() + i: the two nodes of whose geodesic it is the midpoint.
  std::vector<std::array<int, 2>> parents;

  Eigen::MatrixXd distances;  ///< between all pairs of poses: lengths of geodesics, pure numbers
  double stress = 0;          ///< of the poses' positions (Embedding::stress)
  std::string provenance;     ///< the program and the inputs from which it was made
  Appearance appearance;      ///< of the connectivity's polygons: for outputs

  int NumNodes() const { return static_cast<int>(nodes.size()); }
  int NumPoses() const { return static_cast<int>(names.size()); }
  Shape Placed(int node) const { return Blend({{node, node, node}, {1, 0, 0}, {}, true}); }

  /// O(triangles). A point outside is projected to the nearest point of the hull, and
  /// `PlaneLocation::inside` is then false.
  /// \throw InvalidOptions if the point is not finite.
  PlaneLocation Locate(const Eigen::Vector2d& point) const;

  /// The blend of nodes, in the user's unit.
  Shape Blend(const PlaneLocation& location) const;

  /// The shape at a point of the plane, in the user's unit: continuous, linear within a triangle,
  /// and equal to the node at a node's position. Outside of the hull it is the shape at the nearest
  /// point of it; `Locate` says whether a point is inside.
  /// \throw InvalidOptions if the point is not finite.
  Shape At(const Eigen::Vector2d& point) const { return Blend(Locate(point)); }

  /// \throw MeshError if numbers of nodes, vertices or anything else do not fit together, an index
  ///        is out of range, or a number is not finite.
  void Validate() const;
};

/// The motion that belongs to a curve on the plane.
struct PlaneWalk {
  Path path;  ///< not a geodesic but a sequence of blends; `poses` are those reached exactly
  std::vector<PlaneLocation> locations;  ///< of its shapes
  int outside = 0;                       ///< number of points projected onto the hull
};

/// The shapes along a polyline of the plane, at `frames` points evenly spaced along it.
/// \throw InvalidOptions if there is no point, one is not finite, or frames is less than 1.
PlaneWalk WalkAlong(const PoseSpace& space, const std::vector<Eigen::Vector2d>& polyline,
                    int frames);

}  // namespace shapespace

#endif  // SHAPESPACE_EXPLORATION_SPACE_H_
