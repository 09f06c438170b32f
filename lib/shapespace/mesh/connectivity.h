#ifndef SHAPESPACE_MESH_CONNECTIVITY_H_
#define SHAPESPACE_MESH_CONNECTIVITY_H_

#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Core>

namespace shapespace {

/// Lists of indices, one per row, concatenated in one array.
class IndexLists {
 public:
  /// One list; valid as long as the `IndexLists` is.
  class Row {
   public:
    Row(const int* begin, const int* end) : begin_(begin), end_(end) {}
    const int* begin() const { return begin_; }
    const int* end() const { return end_; }
    int size() const { return static_cast<int>(end_ - begin_); }
    int operator[](int i) const { return begin_[i]; }

   private:
    const int *begin_, *end_;
  };

  /// Row i is items[begin[i]] ... items[begin[i + 1] - 1]; `begin` has one entry more than rows.
  IndexLists(std::vector<int> begin, std::vector<int> items)
      : begin_(std::move(begin)), items_(std::move(items)) {}
  IndexLists() : begin_{0} {}

  int NumRows() const { return static_cast<int>(begin_.size()) - 1; }
  Row operator[](int row) const {
    return {items_.data() + begin_[row], items_.data() + begin_[row + 1]};
  }

 private:
  std::vector<int> begin_, items_;
};

/// The elements that all poses of a mesh share. Immutable, and therefore safe to read from several
/// threads. Plain index arrays, one column per element, so that metrics work on any graph, manifold
/// or not. Properties of manifolds (boundary loops, genus) are in mesh/topology.h.
///
/// Files store a vertex several times where texture coordinates, normals or materials change. Of
/// such vertices, which are one point of the surface (mesh/seams.h), one is the representative and
/// the others are its twins. Triangles, edges and hinges have representatives as corners, so that
/// they are those of the whole surface; a twin belongs to none, and lies where its representative
/// does (`CopyToTwins`). Numbers of vertices are the file's everywhere.
class Connectivity {
 public:
  /// Polygons are as in `Soup` (`polygon_begin` of size P + 1, `corners`); `segments` are the edges
  /// of straight-line graphs; `stiffeners` are additional edges for the metric. `triangles`, 3 x T,
  /// is the triangulation of the polygons (`Triangulate`), polygon after polygon, for each two
  /// triangles less than it has corners. By default they are triangulated as fans from their
  /// smallest vertex, which is correct for convex polygons. All diagonals of a polygon that cut off
  /// one corner become edges, so that its shape is measured independently of its triangulation.
  /// `representatives` has one entry per vertex, or none if every vertex represents itself; what
  /// the other arguments say of twins holds of their representatives.
  /// \throw MeshError if there is no vertex, a polygon has fewer than three corners, an index is
  ///        outside [0, num_vertices), a segment or stiffener joins a vertex to itself, the
  ///        triangles are not those of the polygons, or a representative does not represent itself.
  static std::shared_ptr<const Connectivity> Make(
      int num_vertices, std::vector<int> polygon_begin, std::vector<int> corners,
      const std::vector<std::pair<int, int>>& segments = {},
      const std::vector<std::pair<int, int>>& stiffeners = {},
      const Eigen::Matrix3Xi& triangles = {}, std::vector<int> representatives = {});

  /// A triangle mesh without extra edges; `triangles` is 3 x F.
  static std::shared_ptr<const Connectivity> FromTriangles(int num_vertices,
                                                           const Eigen::Matrix3Xi& triangles);

  int NumVertices() const { return num_vertices_; }
  int NumPolygons() const { return static_cast<int>(polygon_begin_.size()) - 1; }
  int NumTriangles() const { return static_cast<int>(triangles_.cols()); }
  int NumEdges() const { return static_cast<int>(edges_.cols()); }
  int NumHinges() const { return static_cast<int>(hinges_.cols()); }

  /// The file's polygons and segments, for output.
  const std::vector<int>& PolygonBegin() const { return polygon_begin_; }
  const std::vector<int>& Corners() const { return corners_; }
  const std::vector<std::pair<int, int>>& Segments() const { return segments_; }

  /// The triangulation of the polygons, 3 x F, with representatives as corners.
  const Eigen::Matrix3Xi& Triangles() const { return triangles_; }
  /// The same with the polygons' own corners, twins included, for output.
  const Eigen::Matrix3Xi& FileTriangles() const {
    return twins_.empty() ? triangles_ : file_triangles_;
  }

  /// The vertex that stands for `vertex` in all elements: mostly itself.
  int Representative(int vertex) const {
    return representatives_.empty() ? vertex : representatives_[vertex];
  }
  /// All of them, one per vertex; empty if every vertex represents itself.
  const std::vector<int>& Representatives() const { return representatives_; }
  /// The vertices that another one represents, in ascending order.
  const std::vector<int>& Twins() const { return twins_; }
  /// Gives twins the positions (or any columns, or numbers) of their representatives; `values` has
  /// one column, or one entry, per vertex. Everything that computes these calls it.
  template <typename Derived>
  void CopyToTwins(Eigen::PlainObjectBase<Derived>* values) const {
    for (const int twin : twins_) {
      if constexpr (Derived::IsVectorAtCompileTime) {
        values->coeffRef(twin) = values->coeff(representatives_[twin]);
      } else {
        values->col(twin) = values->col(representatives_[twin]);
      }
    }
  }
  template <typename T>
  void CopyToTwins(std::vector<T>* values) const {
    for (const int twin : twins_) (*values)[twin] = (*values)[representatives_[twin]];
  }

  /// Unique edges, 2 x E, each with its smaller vertex first. The first `NumTriangleEdges()` are
  /// sides of triangles, in lexicographic order; the others are segments, diagonals of polygons
  /// that cut off one corner, and stiffeners, unless they are sides of triangles.
  const Eigen::Matrix2Xi& Edges() const { return edges_; }
  int NumTriangleEdges() const { return num_triangle_edges_; }

  /// Hinges, 4 x H: an edge (first, second) with exactly two triangles of consistent orientation;
  /// (first, second, third) is one triangle in its own orientation, (second, first, fourth) the
  /// other.
  const Eigen::Matrix4Xi& Hinges() const { return hinges_; }

  /// Adjacency lists, in ascending order. They are computed at construction, which takes less time
  /// than the rest of it, so that no call changes the object. Row v: the triangles that have vertex
  /// v as a corner.
  const IndexLists& TrianglesOfVertices() const { return triangles_of_vertices_; }
  /// Row v: the edges of any kind that end at vertex v; `OtherEnd` gives its neighbours.
  const IndexLists& EdgesOfVertices() const { return edges_of_vertices_; }
  /// Row e, for each of the first `NumTriangleEdges()` edges: the triangles that have it as a side.
  const IndexLists& TrianglesOfEdges() const { return triangles_of_edges_; }

  /// The end of edge `edge` that is not `vertex`; `vertex` must be one of its ends.
  int OtherEnd(int edge, int vertex) const { return edges_(0, edge) + edges_(1, edge) - vertex; }

  /// True for a straight-line graph: edges and no polygon.
  bool IsGraph() const { return NumTriangles() == 0; }

 private:
  Connectivity() = default;

  int num_vertices_ = 0;
  int num_triangle_edges_ = 0;
  std::vector<int> polygon_begin_, corners_;
  std::vector<std::pair<int, int>> segments_;
  Eigen::Matrix3Xi triangles_;
  Eigen::Matrix2Xi edges_;
  Eigen::Matrix4Xi hinges_;
  IndexLists triangles_of_vertices_, edges_of_vertices_, triangles_of_edges_;
  // Only if there are twins:
  std::vector<int> representatives_, twins_;
  Eigen::Matrix3Xi file_triangles_;
};

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_CONNECTIVITY_H_
