#ifndef SHAPESPACE_STATISTICS_INTERNAL_MODES_ARRAYS_H_
#define SHAPESPACE_STATISTICS_INTERNAL_MODES_ARRAYS_H_

#include <string>

#include <shapespace/path/internal/metric_arrays.h>
#include <shapespace/statistics/shape_model.h>

namespace shapespace::internal {

/// Adds modes, which must be valid, to what is written to `file`, to which names of folders are
/// relative.
void AddModes(const PoseModes& modes, const std::string& file, HeaderJson* header,
              ArrayWriter* arrays);

/// Reads it back.
/// \throw FileError, MeshError, or another exception if the header is inconsistent.
PoseModes ReadModes(const std::string& file, const HeaderJson& header, const ArrayReader& arrays);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_STATISTICS_INTERNAL_MODES_ARRAYS_H_
