#ifndef SHAPESPACE_TOOLS_SUPPORT_OUTPUTS_H_
#define SHAPESPACE_TOOLS_SUPPORT_OUTPUTS_H_

#include <string>
#include <vector>

#include <shapespace/path/path.h>

#include "support/files.h"

namespace shapespace::tools {

/// From now on an .obj or .ply whose name has no number is an output too: of the last shape alone.
void WriteLastShapeAlone();

/// The files that --output names, separated by commas.
/// \throw UsageError if one is of no kind that can be written, FileError as `CheckCanBeWritten`.
std::vector<std::string> OutputsFromFlags();

/// The same of another flag, whose value is `list`.
std::vector<std::string> OutputsFromFlag(const std::string& flag, const std::string& list);

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
