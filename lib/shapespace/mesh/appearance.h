#ifndef SHAPESPACE_MESH_APPEARANCE_H_
#define SHAPESPACE_MESH_APPEARANCE_H_

#include <string>
#include <vector>

#include <Eigen/Core>

namespace shapespace {

/// Names that polygons of a mesh share, such as those of their materials.
struct PolygonNames {
  std::vector<std::string> names;  ///< no repetitions
  std::vector<int> of_polygon;     ///< index into `names` per polygon, -1: none; may be empty
};

/// The visual properties of a mesh and the names of its parts: used by outputs, not by metrics. It
/// refers to polygons, corners and vertices of a `Soup` or a `Connectivity`. Any part of it may be
/// empty.
struct Appearance {
  /// Texture coordinates, 2 x k, with v pointing up as in OBJ, and per corner an index into them,
  /// -1 for a corner without. Both are empty or neither is.
  Eigen::Matrix2Xd texture_coordinates;
  std::vector<int> corner_texture;

  std::vector<std::string> material_libraries;  ///< files, as in OBJ `mtllib`
  std::string folder;                           ///< to which names of libraries are relative
  std::string own_folder;                       ///< of the file that named the libraries: they and
                                                ///< their textures are read from there and below
  PolygonNames materials;                       ///< OBJ `usemtl`
  PolygonNames groups;                          ///< OBJ `g`, all names of a polygon as one text
  PolygonNames objects;                         ///< OBJ `o`

  /// Red, green and blue of every vertex, and its opacity if there is a fourth row: 3 or 4 x m,
  /// from 0 to 1.
  Eigen::MatrixXd vertex_colours;

  /// \throw MeshError if a size or an index does not fit a mesh with these numbers of vertices,
  ///        polygons and corners, or a number is out of its range.
  void Validate(int num_vertices, int num_polygons, int num_corners) const;
};

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_APPEARANCE_H_
