#ifndef SHAPESPACE_TOOLS_SUPPORT_POSES_H_
#define SHAPESPACE_TOOLS_SUPPORT_POSES_H_

#include <string>
#include <vector>

#include <shapespace/files/read.h>
#include <shapespace/path/path.h>

namespace shapespace::tools {

/// Reads files with two or more poses in all (or with `least`), according to --stiffeners,
/// --loose_components, --allow_nonmanifold, --open_seams and --mirror; prints warnings, and notes
/// on content that outputs will not have. Unless the order of the poses means nothing
/// (`any_order`), the warning of `OrderWarning` is one of them.
/// \throw UsageError if there are fewer poses, or if a flag of the metric cannot be applied to the
///        mesh.
Poses ReadPosesFromFlags(const std::vector<std::string>& files, size_t least = 2,
                         bool any_order = false);

/// The same for one mesh of each file: of a file of several poses the first. Without `tie`, for
/// meshes of which only shapes or triangles are used, components stay loose.
Poses ReadMeshesFromFlags(const std::vector<std::string>& files, bool tie = true);

/// The same for soups that were read.
Poses MakePosesFromFlags(std::vector<Soup> soups, bool tie = true);

/// A mesh, as a pose of the mesh of a path that was read from `path_file`: the first pose of
/// `file`. \throw MismatchError if it is another mesh.
Poses ReadPoseOf(const Path& path, const std::string& path_file, const std::string& file);

/// These files, and that of --stiffeners if it was given: all inputs.
std::vector<std::string> WithStiffeners(std::vector<std::string> files);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_POSES_H_
