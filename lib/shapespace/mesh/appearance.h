#ifndef SHAPESPACE_MESH_APPEARANCE_H_
#define SHAPESPACE_MESH_APPEARANCE_H_

#include <string>
#include <vector>

#include <Eigen/Core>

namespace shapespace {

/// Names that polygons of a mesh share, such as those of their materials.
struct PolygonNames {
  std::vector<std::string> names;  ///< each once
  std::vector<int> of_polygon;     ///< per polygon an index into `names`, -1 for none; empty if all
                                   ///< have none
};

/// How a mesh looks and what its parts are called: what outputs show and no metric sees. It belongs
/// to polygons, corners and vertices as a `Soup` or a `Connectivity` has them. Any part of it may
/// be empty.
struct Appearance {
  /// Texture coordinates, 2 x k, v pointing up as in OBJ, and per corner an index into them, -1
  /// where a corner has none. Either both are empty or none is.
  Eigen::Matrix2Xd texture_coordinates;
  std::vector<int> corner_texture;

  std::vector<std::string> material_libraries;  ///< files, as OBJ `mtllib` names them
  std::string folder;                           ///< that names of libraries are relative to
  PolygonNames materials;                       ///< OBJ `usemtl`
  PolygonNames groups;                          ///< OBJ `g`, all names of a polygon as one text
  PolygonNames objects;                         ///< OBJ `o`

  /// Red, green and blue of every vertex, and its opacity where a fourth row is there: 3 or 4 x m,
  /// from 0 to 1.
  Eigen::MatrixXd vertex_colours;

  /// \throw MeshError if a size or an index is not that of a mesh with so many vertices, polygons
  ///        and corners, or a number is out of its range.
  void Validate(int num_vertices, int num_polygons, int num_corners) const;
};

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_APPEARANCE_H_
