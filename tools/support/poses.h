#ifndef SHAPESPACE_TOOLS_SUPPORT_POSES_H_
#define SHAPESPACE_TOOLS_SUPPORT_POSES_H_

#include <string>
#include <vector>

#include <shapespace/mesh/read.h>

namespace shapespace::tools {

/// Reads pose files according to --stiffeners, --allow_nonmanifold and --mirror; prints warnings,
/// and notes on content that outputs will not have.
/// \throw UsageError if a flag of the metric cannot be applied to the mesh.
Poses ReadPosesFromFlags(const std::vector<std::string>& files);

/// These files, and that of --stiffeners if it was given: all inputs.
std::vector<std::string> WithStiffeners(std::vector<std::string> files);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_POSES_H_
