#ifndef SHAPESPACE_MESH_SOUP_H_
#define SHAPESPACE_MESH_SOUP_H_

#include <string>
#include <utility>
#include <vector>

#include <shapespace/mesh/appearance.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// What a mesh file says, before anything is made of it: nothing merged, dropped or reordered.
struct Soup {
  std::string file;  ///< the path it was read from; empty if made in code
  Shape vertices;    ///< 3 x m, in the file's order and units

  /// Polygons (three or more corners each), concatenated: polygon i holds the vertex indices
  /// corners[polygon_begin[i]] ... corners[polygon_begin[i + 1] - 1], counted from 0.
  std::vector<int> polygon_begin = {0};
  std::vector<int> corners;

  /// Straight-line elements (OBJ `l`), each as its consecutive segments.
  std::vector<std::pair<int, int>> segments;

  /// Line of the file on which each element stands, counted from 1; empty where the file has no
  /// lines (binary PLY) or the mesh was made in code.
  std::vector<int> vertex_line, polygon_line, segment_line;

  Appearance appearance;  ///< kept for outputs

  /// Sentences about what the file holds and shapespace does not keep (normals, points, ...).
  std::vector<std::string> dropped;

  int NumVertices() const { return static_cast<int>(vertices.cols()); }
  int NumPolygons() const { return static_cast<int>(polygon_begin.size()) - 1; }
};

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_SOUP_H_
