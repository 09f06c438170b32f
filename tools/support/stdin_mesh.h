#ifndef SHAPESPACE_TOOLS_SUPPORT_STDIN_MESH_H_
#define SHAPESPACE_TOOLS_SUPPORT_STDIN_MESH_H_

#include <string>
#include <vector>

#include <shapespace/mesh/soup.h>

namespace shapespace::tools {

/// `ReadSoups` according to --allow_outside_files, of a file or, if it is "-", of stdin: one mesh
/// in any of the formats, which its content tells. \throw FileError as `ReadSoups`.
std::vector<Soup> ReadSoupsOrStdin(const std::string& file);

/// The first of these poses: `ReadSoup`.
Soup ReadSoupOrStdin(const std::string& file);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_STDIN_MESH_H_
