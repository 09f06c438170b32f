#ifndef SHAPESPACE_TOOLS_SUPPORT_OUTPUTS_H_
#define SHAPESPACE_TOOLS_SUPPORT_OUTPUTS_H_

#include <string>
#include <vector>

#include <shapespace/path/path.h>

#include "support/files.h"

namespace shapespace::tools {

/// From now on an .obj or .ply without a number in its name is a valid output, of the last shape
/// alone, and so is "-", which writes it to stdout.
void WriteLastShapeAlone();

/// The files named by --output, separated by commas.
/// \throw UsageError if one has an unknown extension, FileError as `CheckCanBeWritten`.
std::vector<std::string> OutputsFromFlags();

/// The same for another flag with the value `list`.
std::vector<std::string> OutputsFromFlag(const std::string& flag, const std::string& list);

/// Writes each output, the `.path` files first, with messages: `.path`, pictures, `.glb`
/// animation, or frames (`frames/%03d.obj`, `.ply`). If one fails, an error is printed and the
/// others are written. After `Interrupted`, only `.path` files are. Notes on stderr tell which
/// parts of the appearance a format cannot store. `whole` is the path whose shapes `path` contains,
/// possibly at other times: deviations are relative to its first shape, and near-rigid parts are
/// computed from it. `marks` may be empty; they are those of FilmStripOptions.
void WriteOutputs(const std::vector<std::string>& outputs, const Path& path, const Path& whole,
                  const Eigen::VectorXi& marks = {});

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_OUTPUTS_H_
