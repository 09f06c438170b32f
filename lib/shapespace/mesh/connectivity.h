#ifndef SHAPESPACE_MESH_CONNECTIVITY_H_
#define SHAPESPACE_MESH_CONNECTIVITY_H_

#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace shapespace {

/// What all poses of a mesh share; immutable. Plain index arrays, one element a column, so that
/// metrics work on any graph, manifold or not. What needs a manifold (boundary loops, genus) is in
/// mesh/topology.h.
class Connectivity {
 public:
  /// Polygons as in `Soup` (`polygon_begin` of size P + 1, `corners`); `segments` are the edges of
  /// straight-line graphs; `stiffeners` are further edges that the metric is to hold.
  /// Polygons are triangulated as fans from their first corner; the second diagonal of every
  /// quadrilateral becomes an extra edge, so that a metric does not depend on which one was taken.
  /// \throw MeshError if there is no vertex, or an index is outside [0, num_vertices), or a segment
  ///        or stiffener joins a vertex to itself.
  static std::shared_ptr<const Connectivity> Make(
      int num_vertices, std::vector<int> polygon_begin, std::vector<int> corners,
      const std::vector<std::pair<int, int>>& segments = {},
      const std::vector<std::pair<int, int>>& stiffeners = {});

  /// A triangle mesh without extra edges; `triangles` is 3 x F.
  static std::shared_ptr<const Connectivity> FromTriangles(int num_vertices,
                                                           const Eigen::Matrix3Xi& triangles);

  int NumVertices() const { return num_vertices_; }
  int NumPolygons() const { return static_cast<int>(polygon_begin_.size()) - 1; }
  int NumTriangles() const { return static_cast<int>(triangles_.cols()); }
  int NumEdges() const { return static_cast<int>(edges_.cols()); }
  int NumHinges() const { return static_cast<int>(hinges_.cols()); }

  /// The file's polygons, for output.
  const std::vector<int>& PolygonBegin() const { return polygon_begin_; }
  const std::vector<int>& Corners() const { return corners_; }

  /// The fan triangulation, for metrics, 3 x F.
  const Eigen::Matrix3Xi& Triangles() const { return triangles_; }

  /// Unique edges, 2 x E, each with its smaller vertex first. The first `NumTriangleEdges()` are
  /// sides of triangles, in lexicographic order; the others are segments, quadrilaterals' second
  /// diagonals and stiffeners that are no sides of triangles.
  const Eigen::Matrix2Xi& Edges() const { return edges_; }
  int NumTriangleEdges() const { return num_triangle_edges_; }

  /// Hinges, 4 x H: an edge (first, second) with exactly two triangles, wound consistently;
  /// (first, second, third) is one triangle in its own winding, (second, first, fourth) the other.
  const Eigen::Matrix4Xi& Hinges() const { return hinges_; }

  /// True for a straight-line graph: edges and no polygon.
  bool IsGraph() const { return NumTriangles() == 0; }

 private:
  Connectivity() = default;

  int num_vertices_ = 0;
  int num_triangle_edges_ = 0;
  std::vector<int> polygon_begin_, corners_;
  Eigen::Matrix3Xi triangles_;
  Eigen::Matrix2Xi edges_;
  Eigen::Matrix4Xi hinges_;
};

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_CONNECTIVITY_H_
