#ifndef SHAPESPACE_PATH_INTERNAL_PATH_ARRAYS_H_
#define SHAPESPACE_PATH_INTERNAL_PATH_ARRAYS_H_

#include <string>

#include <shapespace/path/internal/metric_arrays.h>
#include <shapespace/path/path.h>

namespace shapespace::internal {

/// Adds a path, which must be valid, to what is written to `file`, to which names of folders are
/// relative.
void AddPath(const Path& path, const std::string& file, HeaderJson* header, ArrayWriter* arrays);

/// Reads it back.
/// \throw FileError, MeshError, or another exception if the header is inconsistent.
Path ReadPath(const std::string& file, const HeaderJson& header, const ArrayReader& arrays);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_PATH_INTERNAL_PATH_ARRAYS_H_
