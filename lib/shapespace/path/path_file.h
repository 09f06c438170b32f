#ifndef SHAPESPACE_PATH_PATH_FILE_H_
#define SHAPESPACE_PATH_PATH_FILE_H_

#include <string>

#include <shapespace/path/path.h>

namespace shapespace {

/// Writes a complete path (connectivity, metric with its frozen weights, aligned shapes, rigid
/// motions, unit, appearance, provenance) to a `.path` file: docs/file-formats.md. Doubles are
/// stored exactly. Material libraries and textures are referenced relative to the file, not copied.
/// The file is written completely or not at all.
/// \throw FileError if it cannot be written, MeshError if the path is not valid.
void WritePath(const std::string& file, const Path& path);

/// Reads it back.
/// \throw FileError naming the file: not a path, of another version, truncated or damaged
///        (its checksum does not fit), or inconsistent.
Path ReadPath(const std::string& file);

}  // namespace shapespace

#endif  // SHAPESPACE_PATH_PATH_FILE_H_
