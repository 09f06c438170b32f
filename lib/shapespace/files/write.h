#ifndef SHAPESPACE_FILES_WRITE_H_
#define SHAPESPACE_FILES_WRITE_H_

#include <iosfwd>
#include <string>
#include <vector>

#include <shapespace/mesh/shape.h>
#include <shapespace/mesh/soup.h>

namespace shapespace {

/// Writes `vertices` with the polygons, segments and appearance of `soup` (whose own vertices are
/// not used): OBJ or OFF (text), PLY or STL (binary little-endian), according to the extension.
/// Coordinates are stored exactly, except in STL, which has triangles with corners in single
/// precision (the soup's `triangles` or, if there are none, `Triangulate`). PLY stores texture
/// coordinates, in single precision, and vertex colours, in eight bits; `NotKept` lists what is
/// lost. Material libraries are referenced by the names in `soup`, not copied. The file is written
/// completely or not at all.
/// \throw FileError if the extension is another or the file cannot be written; MeshError if a
///        coordinate is not finite, the number of vertices is not the soup's, its appearance is not
///        valid, a graph is to be written as OFF or STL, or STL would change a coordinate by more
///        than a ten-thousandth of the shape's diagonal.
void WriteMesh(const std::string& file, const Shape& vertices, const Soup& soup);

/// The same into a stream, as PLY; binary, so the stream must be too. `name` is used in messages.
/// \throw FileError if the stream fails.
void WritePly(std::ostream& stream, const std::string& name, const Shape& vertices,
              const Soup& soup);

/// Whether the file's extension is one of these four.
bool IsWritableMesh(const std::string& file);

/// What of the soup, besides the positions' precision, a file with this extension cannot store:
/// sentences, mostly none.
std::vector<std::string> NotKept(const std::string& file, const Soup& soup);

}  // namespace shapespace

#endif  // SHAPESPACE_FILES_WRITE_H_
