#ifndef SHAPESPACE_TOOLS_SUPPORT_FILES_H_
#define SHAPESPACE_TOOLS_SUPPORT_FILES_H_

#include <cstdint>
#include <string>
#include <vector>

#include <shapespace/path/path.h>

namespace shapespace::tools {

/// The files named by the flag `flag`; for frames, their number.
struct FlagOutputs {
  std::string flag;
  std::vector<std::string> files;
  std::int64_t frames = 0;
};

/// Prevents overwriting of files that are read or written in the same run: no output may be one of
/// `inputs`, and no two outputs the same file, also if their names differ.
/// \throw UsageError naming both.
void CheckNothingIsOverwritten(const std::vector<std::string>& inputs,
                               const std::vector<FlagOutputs>& outputs);

/// To be called before a solve, so that its result can be written: checks that files
/// can be made in `file`'s folder, or in that in which the folder would be made. "-" is stdout, and
/// can. \throw FileError.
void CheckCanBeWritten(const std::string& file);

/// Whether a file is a .path, by its name.
bool IsPathFile(const std::string& file);

/// Whether the inputs are one .path file, and not meshes. \throw UsageError if there are no inputs,
/// or a path beside others.
bool IsPathAlone(const std::vector<std::string>& files);

/// Reads a .path file, and prints a warning if its solve did not converge.
/// \throw FileError.
Path ReadPathAndTell(const std::string& file);

/// The program, its version and the names of the input files, without folders, because outputs are
/// passed on to others: for `Path::provenance`.
std::string Provenance(const char* program, const std::vector<std::string>& files);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_FILES_H_
