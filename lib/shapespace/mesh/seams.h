#ifndef SHAPESPACE_MESH_SEAMS_H_
#define SHAPESPACE_MESH_SEAMS_H_

#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// Where a file cuts a surface that is whole: programs store a vertex once for each of its texture
/// coordinates, normals or materials, so that polygons on both sides of a seam have vertices of
/// their own at the same places.
struct Seams {
  /// Per vertex the one that stands for it, the first of those that are joined: what
  /// `Connectivity::Make` takes. Empty if no two vertices are joined.
  std::vector<int> representatives;
  int joined = 0;  ///< vertices that another one represents
  /// Places where borders lie on each other in all poses and were left open, because the polygons
  /// there do not continue each other in one way only: they are wound alike, or more than two.
  int unclear = 0;
};

/// Finds the seams of polygons (as in `Soup`; their indices must be valid) in `poses`, of which
/// there is at least one, all finite: two sides of polygons that have no other neighbour are one
/// edge if their ends coincide in all poses, up to the rounding of what wrote the file, and they
/// run in opposite directions, as those of neighbours do. The ends are joined, except where a
/// polygon would get the same vertex at two corners. The two sides of a double-sided polygon are no
/// neighbours. Borders that touch in some poses only are not seams, nor are vertices that coincide
/// without a common edge. Invariant under rigid motion, scale and the order of poses. O(m log m)
/// per pose.
Seams FindSeams(const std::vector<int>& polygon_begin, const std::vector<int>& corners,
                const std::vector<Shape>& poses);

/// How many twins are farther from their representatives in `shape` than a millionth of its extent:
/// in a pose that was not among those for which seams were found, they may be.
int CountParted(const Connectivity& connectivity, const Shape& shape);

/// The representatives of some vertices, ascending and each once; if no two vertices of the mesh
/// are joined, the vertices as they are.
std::vector<int> RepresentativesOf(const Connectivity& connectivity,
                                   const std::vector<int>& vertices);

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_SEAMS_H_
