#ifndef SHAPESPACE_ANALYSIS_NEAR_PAIRS_H_
#define SHAPESPACE_ANALYSIS_NEAR_PAIRS_H_

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <shapespace/analysis/distance.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// Two elements of a surface that may be near to each other during a part of a motion.
struct NearPair {
  PairKind kind;
  std::array<int, 4> vertices;  ///< in the order of `PairKind`; of two edges the one with the
                                ///< smaller index is first
  float begin, end;             ///< the part of the motion, within 0 and 1

  FourPoints At(const Shape& shape) const {
    FourPoints points;
    for (int k = 0; k < 4; ++k) points.col(k) = shape.col(vertices[k]);
    return points;
  }
};

/// Finds which parts of a surface come near to others while all vertices move on straight lines.
/// Elements that are neighbours on the surface do not count: those with vertices that are joined by
/// at most two edges, or by edges with a sum of at most twice the length at one of the vertices
/// (the mean of its edges' lengths). Segments of the mesh are edges like those of triangles, and
/// their ends are vertices. Vertices that belong to neither do not count.
///
/// Triangles and segments are kept in a tree of boxes, which is made once. For each motion the
/// boxes at both ends are computed, and boxes in between lie between these. A search begins at
/// pairs of nodes that have no corner in common, which are found once too: nearly all triangles
/// whose boxes meet share a corner. Immutable, so several threads may search at once.
class NearPairs {
 public:
  /// Lengths are the mean of those in `shapes`, at least one. The vertices from `num_moving` on
  /// never move, and pairs of elements with no other vertices do not count. The vertices of each of
  /// `exempt` count as neighbours too.
  /// \throw MeshError if there is no triangle, or a shape is not finite or has another number of
  ///        vertices.
  NearPairs(std::shared_ptr<const Connectivity> connectivity, const std::vector<Shape>& shapes,
            int num_moving, const std::vector<std::pair<int, int>>& exempt = {});

  /// Pairs of a segment and a triangle, or of two segments, that touch in a shape, or are nearer to
  /// each other than `share` times their length, unless they are neighbours: the corners of both,
  /// of a segment its last one twice.
  std::vector<std::pair<Eigen::Vector3i, Eigen::Vector3i>> FindTouchingSegments(const Shape& shape,
                                                                                double share) const;

  /// The length at a vertex.
  double Length(int vertex) const { return lengths_[vertex]; }
  /// The least of the lengths at a pair's vertices.
  double Length(const NearPair& pair) const;

  /// All pairs that, at some time of the motion, may be nearer to each other than `share` times
  /// their length, plus `margin`. Those that are not are farther away at all times. In an order
  /// that depends on nothing but the arguments.
  std::vector<NearPair> Find(const Shape& from, const Shape& to, double share, double margin) const;

 private:
  struct Node {
    int left, right;  // children; of a leaf: the element, and -1
    int elements;
    double length;  // greatest at any vertex
    bool moves;
  };
  class Search;

  // The elements, the nodes and fronts, and what belongs to which element.
  void FindElements();
  void BuildTree(const Shape& shape);
  int Build(const Shape& centres, int* begin, int* end);
  // Appends the largest pairs of nodes below these two that have no corner in common, or the two
  // themselves; returns whether they have one. `boxes` are those of one shape.
  bool FindFronts(int a, int b, const std::vector<Eigen::AlignedBox3d>& boxes);
  bool AreNeighbours(int v, int w) const;
  bool AreNeighbours(const NearPair& pair) const;

  std::shared_ptr<const Connectivity> connectivity_;
  int num_moving_;
  std::vector<double> lengths_;
  IndexLists neighbours_;      // by vertex, ascending, itself included
  Eigen::Matrix3Xi elements_;  // the triangles, and then segments, with their last vertex twice
  std::vector<Node> nodes_;    // children after their parents
  // Elements that share no corner, and of which one moves, are in one of these pairs of nodes.
  std::vector<std::pair<int, int>> fronts_;
  // Each vertex and each edge belongs to one of its elements, so that pairs are found once.
  IndexLists vertices_of_elements_, edges_of_elements_;
};

}  // namespace shapespace

#endif  // SHAPESPACE_ANALYSIS_NEAR_PAIRS_H_
