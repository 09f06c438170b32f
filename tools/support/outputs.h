#ifndef SHAPESPACE_TOOLS_SUPPORT_OUTPUTS_H_
#define SHAPESPACE_TOOLS_SUPPORT_OUTPUTS_H_

#include <string>
#include <vector>

#include <shapespace/path/path.h>

namespace shapespace::tools {

/// The files that --output names, separated by commas.
/// \throw UsageError if one is of no kind that can be written, FileError as `CheckCanBeWritten`.
std::vector<std::string> OutputsFromFlags();

/// The same of another flag, whose value is `list`.
std::vector<std::string> OutputsFromFlag(const std::string& flag, const std::string& list);

/// So that nobody waits for a solve whose result has nowhere to go, and nothing is written if
/// something cannot be: `file`'s folder exists, or can probably be made, and can be written to.
/// \throw FileError.
void CheckCanBeWritten(const std::string& file);

/// Who made a path from which files, with the version: for `Path::provenance`.
std::string Provenance(const char* program, const std::vector<std::string>& files);

/// Writes each: `.path`, `.png` film strip, `.glb` animation, or frames (`frames/%03d.obj`,
/// `.ply`). Where a format drops something of the path's appearance, stderr is told. `whole` is the
/// path that `path` shows, perhaps at other times: colours of deviation compare with its first
/// shape, those of parts are of its near-rigid parts.
void WriteOutputs(const std::vector<std::string>& outputs, const Path& path, const Path& whole);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_OUTPUTS_H_
