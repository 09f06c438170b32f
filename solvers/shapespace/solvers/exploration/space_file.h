#ifndef SHAPESPACE_SOLVERS_EXPLORATION_SPACE_FILE_H_
#define SHAPESPACE_SOLVERS_EXPLORATION_SPACE_FILE_H_

#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/solvers/exploration/space.h>

namespace shapespace {

/// Writes everything a space is to a `.space` file: docs/file-formats.md. Doubles keep all their
/// bits. The file appears whole or not at all.
/// \throw FileError if it cannot be written, MeshError if the space is not valid.
void WriteSpace(const std::string& file, const Space& space);

/// Reads it back.
/// \throw FileError naming the file: not a space, of another version, truncated or damaged (its
///        checksum does not fit), or inconsistent.
Space ReadSpace(const std::string& file);

/// Reads a curve on the plane, docs/file-formats.md: points, or names of poses, that it leads
/// through. \throw FileError naming the file and what is wrong in it.
std::vector<Eigen::Vector2d> ReadCurve(const std::string& file, const Space& space);

}  // namespace shapespace

#endif  // SHAPESPACE_SOLVERS_EXPLORATION_SPACE_FILE_H_
