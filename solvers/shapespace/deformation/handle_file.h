#ifndef SHAPESPACE_DEFORMATION_HANDLE_FILE_H_
#define SHAPESPACE_DEFORMATION_HANDLE_FILE_H_

#include <string>
#include <vector>

#include <shapespace/deformation/handle.h>
#include <shapespace/mesh/appearance.h>
#include <shapespace/mesh/connectivity.h>

namespace shapespace {

/// Reads a file of handles written by the user: JSON, described in docs/file-formats.md and
/// docs/handles.schema.json. Vertices are selected in `shape`, in the user's unit and frame.
/// \throw FileError naming the file, the handle (its number, from 1, and its name) and the field,
///        or the line if the file is not valid JSON. MeshError if the arguments do not belong to
///        one mesh.
std::vector<DeformationHandle> ReadHandles(const std::string& file, const Shape& shape,
                                           const Connectivity& connectivity,
                                           const Appearance& appearance);

}  // namespace shapespace

#endif  // SHAPESPACE_DEFORMATION_HANDLE_FILE_H_
