#ifndef SHAPESPACE_EXPLORATION_INTERNAL_SPACE_ARRAYS_H_
#define SHAPESPACE_EXPLORATION_INTERNAL_SPACE_ARRAYS_H_

#include <string>

#include <shapespace/exploration/space.h>
#include <shapespace/path/internal/metric_arrays.h>

namespace shapespace::internal {

/// Adds a space, which must be valid, to what is written to `file`, to which names of folders are
/// relative.
void AddSpace(const PoseSpace& space, const std::string& file, HeaderJson* header,
              ArrayWriter* arrays);

/// Reads it back.
/// \throw FileError, MeshError, or another exception if the header is inconsistent.
PoseSpace ReadSpace(const std::string& file, const HeaderJson& header, const ArrayReader& arrays);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_EXPLORATION_INTERNAL_SPACE_ARRAYS_H_
