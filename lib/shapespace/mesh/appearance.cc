#include <shapespace/mesh/appearance.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/text.h>

namespace shapespace {
namespace {

/// In OBJ a name is the rest of a line.
void CheckNames(const std::vector<std::string>& names) {
  for (const std::string& name : names) {
    if (name.empty() || name.find_first_of(std::string("\r\n\0", 3)) != std::string::npos) {
      throw MeshError("name " + internal::Quoted(name) + " is empty or holds a line end");
    }
  }
}

/// Checks indices from -1 to `limit` - 1; their number must be `count` or 0.
void CheckIndices(const std::vector<int>& indices, const std::string& what, int count, int limit) {
  if (indices.empty()) return;
  if (static_cast<int>(indices.size()) != count) {
    throw MeshError(what + ": given " + std::to_string(indices.size()) + " times, the mesh has " +
                    std::to_string(count));
  }
  for (const int index : indices) {
    if (index < -1 || index >= limit) {
      throw MeshError(what + ": index " + std::to_string(index) + " is not in -1 .. " +
                      std::to_string(limit - 1));
    }
  }
}

}  // namespace

void Appearance::Validate(int num_vertices, int num_polygons, int num_corners) const {
  if (corner_texture.empty() != (texture_coordinates.cols() == 0)) {
    throw MeshError("texture coordinates and their indices must both be there, or neither");
  }
  if (!texture_coordinates.allFinite()) {
    throw MeshError("a texture coordinate is not a finite number");
  }
  CheckIndices(corner_texture, "texture coordinates of corners", num_corners,
               static_cast<int>(texture_coordinates.cols()));
  const auto check_names = [num_polygons](const PolygonNames& names, const std::string& what) {
    CheckIndices(names.of_polygon, what + " of polygons", num_polygons,
                 static_cast<int>(names.names.size()));
    CheckNames(names.names);
  };
  CheckNames(material_libraries);
  check_names(materials, "materials");
  check_names(groups, "groups");
  check_names(objects, "objects");
  if (vertex_colours.size() == 0) return;
  if (vertex_colours.cols() != num_vertices || vertex_colours.rows() < 3 ||
      vertex_colours.rows() > 4) {
    throw MeshError("vertex colours: " + std::to_string(vertex_colours.rows()) + " x " +
                    std::to_string(vertex_colours.cols()) + " instead of 3 or 4 x " +
                    std::to_string(num_vertices));
  }
  if (!((vertex_colours.array() >= 0).all() && (vertex_colours.array() <= 1).all())) {
    throw MeshError("vertex colours: a number is not in 0 .. 1");
  }
}

}  // namespace shapespace
