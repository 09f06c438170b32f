#ifndef SHAPESPACE_EXPLORATION_SPACE_FILE_H_
#define SHAPESPACE_EXPLORATION_SPACE_FILE_H_

#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/exploration/space.h>

namespace shapespace {

/// Writes a complete space to a `.space` file (docs/file-formats.md). Doubles are stored exactly.
/// The file is written completely or not at all.
/// \throw FileError if it cannot be written, MeshError if the space is not valid.
void WriteSpace(const std::string& file, const PoseSpace& space);

/// Reads it back.
/// \throw FileError naming the file: not a space, of another version, truncated or damaged (its
///        checksum does not fit), or inconsistent.
PoseSpace ReadSpace(const std::string& file);

/// Reads a curve on the plane (docs/file-formats.md), given by the points or the names of the poses
/// through which it leads.
/// \throw FileError naming the file and the error in it.
std::vector<Eigen::Vector2d> ReadCurve(const std::string& file, const PoseSpace& space);

}  // namespace shapespace

#endif  // SHAPESPACE_EXPLORATION_SPACE_FILE_H_
