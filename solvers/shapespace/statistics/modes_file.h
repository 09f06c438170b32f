#ifndef SHAPESPACE_STATISTICS_MODES_FILE_H_
#define SHAPESPACE_STATISTICS_MODES_FILE_H_

#include <string>

#include <shapespace/statistics/shape_model.h>

namespace shapespace {

/// Writes the mean and the modes, with the poses of which they were made, to a `.modes` file
/// (docs/file-formats.md). Doubles are stored exactly. The file is written completely or not at
/// all. \throw FileError if it cannot be written, MeshError if the modes are not valid.
void WriteModes(const std::string& file, const PoseModes& modes);

/// Reads them back.
/// \throw FileError naming the file: no modes, of another version, truncated or damaged (its
///        checksum does not fit), or inconsistent.
PoseModes ReadModes(const std::string& file);

}  // namespace shapespace

#endif  // SHAPESPACE_STATISTICS_MODES_FILE_H_
