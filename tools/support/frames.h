#ifndef SHAPESPACE_TOOLS_SUPPORT_FRAMES_H_
#define SHAPESPACE_TOOLS_SUPPORT_FRAMES_H_

#include <string>
#include <vector>

#include <shapespace/mesh/shape.h>
#include <shapespace/mesh/soup.h>

namespace shapespace::tools {

/// `WriteFrames`, with messages: which files are written, what of `soup` the format cannot store,
/// and which frames of an earlier run follow after them, which could be mistaken for a part of the
/// same motion.
void WriteFramesAndTell(const std::string& pattern, const std::vector<Shape>& shapes,
                        const Soup& soup);

/// Prints the messages about numbered files that were written.
void TellFrames(const std::string& pattern, int count);

/// Whether an output is a mesh by its name, or "-": stdout, for which all else that is printed
/// there goes to stderr from now on. \throw UsageError if another flag's output goes to stdout
/// already.
bool IsMeshOrStdout(const std::string& output);

/// `WriteMesh`, with messages; to stdout, as PLY, if `file` is "-".
void WriteMeshAndTell(const std::string& file, const Shape& shape, const Soup& soup);

/// Checks that `file`, a value of --`flag`, is a pattern for frames.
/// \throw UsageError.
void CheckFramePattern(const std::string& flag, const std::string& file);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_FRAMES_H_
