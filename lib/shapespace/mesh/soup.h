#ifndef SHAPESPACE_MESH_SOUP_H_
#define SHAPESPACE_MESH_SOUP_H_

#include <string>
#include <utility>
#include <vector>

#include <shapespace/mesh/appearance.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// The content of a mesh file, with nothing merged, dropped or reordered.
struct Soup {
  std::string file;  ///< from which it was read; empty if made in code
  std::string name;  ///< its name, for all but the first pose of a file of several
  Shape vertices;    ///< 3 x m, in the file's order and units

  /// Polygons (three or more corners each), concatenated: polygon i has the vertex indices
  /// corners[polygon_begin[i]] ... corners[polygon_begin[i + 1] - 1], counted from 0.
  std::vector<int> polygon_begin = {0};
  std::vector<int> corners;

  /// How the polygons are cut into triangles, 3 x T, if that has been decided, as by a
  /// `Connectivity`; otherwise empty. Used by formats that store triangles only.
  Eigen::Matrix3Xi triangles;

  /// Straight lines (OBJ `l`), as their consecutive segments.
  std::vector<std::pair<int, int>> segments;

  /// The file's line of each element, counted from 1; empty for files without lines (binary PLY)
  /// and for meshes made in code.
  std::vector<int> vertex_line, polygon_line, segment_line;

  Appearance appearance;  ///< for outputs

  /// Sentences about content of the file that is not stored (normals, points, ...).
  std::vector<std::string> dropped;

  int NumVertices() const { return static_cast<int>(vertices.cols()); }
  int NumPolygons() const { return static_cast<int>(polygon_begin.size()) - 1; }
};

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_SOUP_H_
