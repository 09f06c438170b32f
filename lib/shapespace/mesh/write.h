#ifndef SHAPESPACE_MESH_WRITE_H_
#define SHAPESPACE_MESH_WRITE_H_

#include <string>
#include <vector>

#include <shapespace/mesh/shape.h>
#include <shapespace/mesh/soup.h>

namespace shapespace {

/// Writes `vertices` with the polygons, segments and appearance of `soup` (its own vertices are not
/// used): OBJ (text) or PLY (binary little-endian), told by the extension. Coordinates read back as
/// they were, to the last bit. PLY keeps of the appearance texture coordinates, in single
/// precision, and vertex colours, in eight bits; `NotKept` says what it drops. Material libraries
/// are named as `soup` names them, not copied. The file appears whole or not at all. \throw
/// FileError if the extension is neither or the file cannot be written; MeshError if a
///        coordinate is not finite, the number of vertices is not the soup's, or its appearance is
///        not valid.
void WriteMesh(const std::string& file, const Shape& vertices, const Soup& soup);

/// What of the soup's appearance a file of this extension cannot hold: sentences, mostly none.
std::vector<std::string> NotKept(const std::string& file, const Soup& soup);

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_WRITE_H_
