#ifndef SHAPESPACE_MESH_WRITE_H_
#define SHAPESPACE_MESH_WRITE_H_

#include <string>
#include <vector>

#include <shapespace/mesh/shape.h>
#include <shapespace/mesh/soup.h>

namespace shapespace {

/// Writes `vertices` with the polygons, segments and appearance of `soup` (whose own vertices are
/// not used): OBJ (text) or PLY (binary little-endian), according to the extension. Coordinates are
/// stored exactly. PLY stores texture coordinates, in single precision, and vertex colours, in
/// eight bits; `NotKept` lists what is lost. Material libraries are referenced by the names in
/// `soup`, not copied. The file is written completely or not at all.
/// \throw FileError if the extension is neither or the file cannot be written; MeshError if a
///        coordinate is not finite, the number of vertices is not the soup's, or its appearance is
///        not valid.
void WriteMesh(const std::string& file, const Shape& vertices, const Soup& soup);

/// What of the soup's appearance a file with this extension cannot store: sentences, mostly none.
std::vector<std::string> NotKept(const std::string& file, const Soup& soup);

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_WRITE_H_
