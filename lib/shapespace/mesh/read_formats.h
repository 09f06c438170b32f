#ifndef SHAPESPACE_MESH_READ_FORMATS_H_
#define SHAPESPACE_MESH_READ_FORMATS_H_

#include <string>

#include <shapespace/mesh/soup.h>

// Private: one reader a format. `text` is the content of `file`, which is named in messages.
// Each throws FileError as `ReadSoup` does.

namespace shapespace::internal {

Soup ReadObj(const std::string& file, std::string text);
Soup ReadPly(const std::string& file, const std::string& text);
Soup ReadOff(const std::string& file, const std::string& text);

/// A property of the vertices of a PLY file, which may be any but a list.
Eigen::VectorXd ReadPlyProperty(const std::string& file, const std::string& text,
                                const std::string& property);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MESH_READ_FORMATS_H_
