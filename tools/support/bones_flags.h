#ifndef SHAPESPACE_TOOLS_SUPPORT_BONES_FLAGS_H_
#define SHAPESPACE_TOOLS_SUPPORT_BONES_FLAGS_H_

#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/output/gltf.h>
#include <shapespace/path/path.h>

namespace shapespace::tools {

/// Whether a .glb is to have bones instead of morph targets.
bool BonesAreAsked();

/// Checks the flags of bones, before a solve; `outputs` are the files that are to be written.
/// \throw UsageError if a value is invalid, or there is nothing that would have bones.
void CheckBonesFlags(const std::vector<std::string>& outputs);

/// Finds bones that reproduce the path, and writes them as a .glb; tells how well they do.
/// \throw as `Skin` and `WriteSkinnedGltf`.
void WriteBones(const std::string& file, const Path& path, const GltfOptions& options);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_BONES_FLAGS_H_
