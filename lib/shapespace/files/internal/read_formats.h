#ifndef SHAPESPACE_FILES_INTERNAL_READ_FORMATS_H_
#define SHAPESPACE_FILES_INTERNAL_READ_FORMATS_H_

#include <string>
#include <vector>

#include <shapespace/mesh/soup.h>

// One reader per format. `text` is the content of `file`, whose name is used in messages.
// Each throws FileError as `ReadSoup`.

namespace shapespace::internal {

Soup ReadObj(const std::string& file, std::string text);
Soup ReadPly(const std::string& file, const std::string& text);
Soup ReadOff(const std::string& file, const std::string& text);
Soup ReadStl(const std::string& file, const std::string& bytes);
/// All poses: the mesh, and each of its morph targets. Buffers are read from the file's folder and
/// those below it, or from anywhere.
std::vector<Soup> ReadGltf(const std::string& file, const std::string& bytes,
                           bool allow_outside_files);

/// A property of the vertices of a PLY file; any but a list.
Eigen::VectorXd ReadPlyProperty(const std::string& file, const std::string& text,
                                const std::string& property);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_FILES_INTERNAL_READ_FORMATS_H_
