#ifndef SHAPESPACE_TOOLS_SUPPORT_OUTPUTS_H_
#define SHAPESPACE_TOOLS_SUPPORT_OUTPUTS_H_

#include <cstdint>
#include <string>
#include <vector>

#include <shapespace/path/path.h>

namespace shapespace::tools {

/// From now on an .obj or .ply whose name has no number is an output too: of the last shape alone.
void WriteLastShapeAlone();

/// The files that --output names, separated by commas.
/// \throw UsageError if one is of no kind that can be written, FileError as `CheckCanBeWritten`.
std::vector<std::string> OutputsFromFlags();

/// The same of another flag, whose value is `list`.
std::vector<std::string> OutputsFromFlag(const std::string& flag, const std::string& list);

/// Whether a file is a .path, by its name.
bool IsPathFile(const std::string& file);

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

/// Reads a .path file, and tells stderr if the solve that made it did not converge. \throw
/// FileError.
Path ReadPathAndTell(const std::string& file);

/// Who made a path from which files, with the version: for `Path::provenance`.
std::string Provenance(const char* program, const std::vector<std::string>& files);

/// Writes each, the `.path` files first: `.path`, `.png` film strip, `.glb` animation, or frames
/// (`frames/%03d.obj`, `.ply`); tells the user which. One that cannot be written is complained of,
/// and the others are written. Once `Interrupted`, only `.path` files are. Where a format drops
/// something of the path's appearance, stderr is told. `whole` is the path that `path` shows,
/// perhaps at other times: colours of deviation compare with its first shape, those of parts are of
/// its near-rigid parts. `marks`, if there are any, are those of FilmStripOptions.
void WriteOutputs(const std::vector<std::string>& outputs, const Path& path, const Path& whole,
                  const Eigen::VectorXi& marks = {});

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_OUTPUTS_H_
