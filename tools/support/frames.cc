#include "support/frames.h"

#include <filesystem>
#include <iostream>

#include <shapespace/base/error.h>
#include <shapespace/files/write.h>
#include <shapespace/output/frames.h>

#include "support/tool.h"

namespace shapespace::tools {
namespace {

std::string FirstToLast(const std::string& pattern, int first, int last) {
  const std::string name = FrameName(pattern, first);
  return first == last ? name : name + " .. " + FrameName(pattern, last);
}

void TellWhatIsNotKept(const std::string& file, const Soup& soup) {
  for (const std::string& sentence : NotKept(file, soup)) {
    Note(file, ": ", sentence);
  }
}

}  // namespace

bool IsMeshOrStdout(const std::string& output) {
  if (output == "-") ClaimStdout("output");
  return output == "-" || IsWritableMesh(output);
}

void WriteMeshAndTell(const std::string& file, const Shape& shape, const Soup& soup) {
  if (file == "-") {
    TellWhatIsNotKept("stdout.ply", soup);
    return WritePly(std::cout, "stdout", shape, soup);
  }
  TellWhatIsNotKept(file, soup);
  WriteMesh(file, shape, soup);
  Out() << "wrote " << file << '\n';
}

void WriteFramesAndTell(const std::string& pattern, const std::vector<Shape>& shapes,
                        const Soup& soup) {
  TellWhatIsNotKept(pattern, soup);
  WriteFrames(pattern, shapes, soup);
  TellFrames(pattern, static_cast<int>(shapes.size()));
}

void TellFrames(const std::string& pattern, int count) {
  Out() << "wrote " << FirstToLast(pattern, 0, count - 1) << '\n';
  int end = count;
  while (std::filesystem::exists(std::filesystem::u8path(FrameName(pattern, end)))) ++end;
  if (end == count) return;
  Note(
      FirstToLast(pattern, count, end - 1),
      (end - count == 1 ? " is of an earlier run, and stays" : " are of an earlier run, and stay"));
}

void CheckFramePattern(const std::string& flag, const std::string& file) {
  try {
    FrameName(file, 0);
  } catch (const FileError& error) {
    throw UsageError("--" + flag + " " + error.what());
  }
}

}  // namespace shapespace::tools
