#ifndef SHAPESPACE_TOOLS_SUPPORT_POSES_H_
#define SHAPESPACE_TOOLS_SUPPORT_POSES_H_

#include <string>
#include <vector>

#include <shapespace/mesh/read.h>

namespace shapespace::tools {

/// Reads pose files as the flags --stiffeners, --allow_nonmanifold and --mirror say; tells stderr
/// the warnings, and what the files hold that no output will. \throw UsageError if a flag of the
/// metric asks for what the mesh cannot have.
Poses ReadPosesFromFlags(const std::vector<std::string>& files);

/// These files, and the one of --stiffeners if it was given: all that is read.
std::vector<std::string> WithStiffeners(std::vector<std::string> files);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_POSES_H_
