#ifndef SHAPESPACE_TOOLS_SUPPORT_FILES_H_
#define SHAPESPACE_TOOLS_SUPPORT_FILES_H_

#include <cstdint>
#include <string>
#include <vector>

#include <shapespace/path/path.h>

namespace shapespace::tools {

/// Files that the flag `flag` names; of frames, `frames` will be written.
struct FlagOutputs {
  std::string flag;
  std::vector<std::string> files;
  std::int64_t frames = 0;
};

/// So that no run destroys what it reads, nor what it has written itself: no output is one of
/// `inputs`, and no two outputs are one file, by whatever names. \throw UsageError naming both.
void CheckNothingIsOverwritten(const std::vector<std::string>& inputs,
                               const std::vector<FlagOutputs>& outputs);

/// So that nobody waits for a solve whose result has nowhere to go, and nothing is written if
/// something cannot be: `file`'s folder exists, or can probably be made, and can be written to.
/// \throw FileError.
void CheckCanBeWritten(const std::string& file);

/// Whether a file is a .path, by its name.
bool IsPathFile(const std::string& file);

/// Reads a .path file, and tells stderr if the solve that made it did not converge. \throw
/// FileError.
Path ReadPathAndTell(const std::string& file);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_FILES_H_
