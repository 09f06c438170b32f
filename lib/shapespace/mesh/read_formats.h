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

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MESH_READ_FORMATS_H_
