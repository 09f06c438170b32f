// Outputs of a path that was solved before.

#include <cmath>
#include <filesystem>
#include <iostream>

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/path/path_file.h>

#include "support/lists.h"
#include "support/outputs.h"
#include "support/tool.h"

DEFINE_string(at, "",
              "times to show, rising and separated by commas, e.g. .25,.5: 0 is the first shape, 1 "
              "the last pose, and what was extrapolated goes on beyond 1");
DEFINE_int32(frames, 0, "so many shapes at even times instead of the path's own; 2 or more");
DEFINE_bool(ease, false, "with --frames: slow at both ends, as an animator would have it");

namespace shapespace::tools {
namespace {

// The path at the times that the flags ask for; as it is if they ask for none.
Path ResampledByFlags(Path path) {
  if (!FLAGS_at.empty() && FLAGS_frames != 0) throw UsageError("--at and --frames: give one");
  if (FLAGS_ease && FLAGS_frames == 0) throw UsageError("--ease goes with --frames");
  std::vector<double> times;
  if (!FLAGS_at.empty()) {
    times = NumbersFromFlag("at", FLAGS_at);
  } else if (FLAGS_frames != 0) {
    if (FLAGS_frames < 2) throw UsageError("--frames must be 2 or more");
    for (int i = 0; i < FLAGS_frames; ++i) {
      const double t = static_cast<double>(i) / (FLAGS_frames - 1);
      times.push_back(path.parameters.back() * (FLAGS_ease ? 0.5 * (1 - std::cos(M_PI * t)) : t));
    }
  } else {
    return path;
  }
  try {
    return Resample(path, times);
  } catch (const InvalidOptions& error) {
    throw UsageError("--at: " + std::string(error.what()));
  }
}

void Run(const std::vector<std::string>& files) {
  if (files.size() != 1) throw UsageError("name one .path file");
  const std::vector<std::string> outputs = OutputsFromFlags();
  for (const std::string& output : outputs) {
    if (std::filesystem::path(output).extension() == ".path") {
      throw UsageError("--output " + output +
                       ": a path seen at other times is no geodesic any more; export meshes or "
                       "pictures");
    }
  }
  const Path path = ReadPath(files[0]);
  const Path shown = ResampledByFlags(path);
  WriteOutputs(outputs, shown, path);
  std::cout << shown.NumShapes() << " shapes of " << files[0] << '\n';
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  return RunTool(argc, argv,
                 {"shape-export",
                  "meshes and pictures of a path, without solving again",
                  "  shape-export walk.path --output walk.png,frames/%03d.obj --frames 40 --ease\n"
                  "  shape-export walk.path --output quarter%d.obj --at .25,.5,.75",
                  {"shape_export.cc", "support/outputs.cc"}},
                 Run);
}
