#ifndef SHAPESPACE_TOOLS_SUPPORT_FRAMES_H_
#define SHAPESPACE_TOOLS_SUPPORT_FRAMES_H_

#include <string>
#include <vector>

#include <shapespace/mesh/shape.h>
#include <shapespace/mesh/soup.h>

namespace shapespace::tools {

/// `WriteFrames`, and tells the user which files they are and what of `soup` their format drops;
/// also which frames of an earlier run go on behind them, as nobody shall take those for a part of
/// the same motion.
void WriteFramesAndTell(const std::string& pattern, const std::vector<Shape>& shapes,
                        const Soup& soup);

/// `WriteMesh`, and tells the user likewise.
void WriteMeshAndTell(const std::string& file, const Shape& shape, const Soup& soup);

/// `file`, a value of --`flag`, is a pattern for frames. \throw UsageError.
void CheckFramePattern(const std::string& flag, const std::string& file);

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_FRAMES_H_
