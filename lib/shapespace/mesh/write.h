#ifndef SHAPESPACE_MESH_WRITE_H_
#define SHAPESPACE_MESH_WRITE_H_

#include <string>

#include <shapespace/mesh/shape.h>
#include <shapespace/mesh/soup.h>

namespace shapespace {

/// Writes `vertices` with the polygons, segments, texture coordinates and materials of `appearance`
/// (its own vertices are not used): OBJ (text, 9 significant digits) or PLY (binary little-endian,
/// double), told by the extension. PLY keeps polygons and segments only.
/// Material libraries are named as `appearance` names them, not copied.
/// The file appears whole or not at all.
/// \throw FileError if the extension is neither or the file cannot be written; MeshError if a
///        coordinate is not finite or the number of vertices is not the appearance's.
void WriteMesh(const std::string& file, const Shape& vertices, const Soup& appearance);

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_WRITE_H_
