// Writes outputs of an existing path.

#include <algorithm>
#include <cmath>

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/files/write.h>

#include "support/anchor_flags.h"
#include "support/command_line.h"
#include "support/flag_group.h"
#include "support/lists.h"
#include "support/memory_flag.h"
#include "support/outputs.h"
#include "support/tool.h"

DEFINE_string(at, "",
              "times of the shapes to write, ascending and separated by commas, e.g. .25,.5: 0 is "
              "the first shape, 1 the last pose, extrapolated shapes are beyond 1; pose i of k, "
              "counted from 0, is at i / (k - 1)");
DEFINE_int32(
    frames, 0,
    "write this number of shapes at evenly spaced times instead of the path's own; 2 or more");
FLAG_GROUP(export, "Frames", "at, frames");
DECLARE_bool(ease);

namespace shapespace::tools {
namespace {

// The times specified by flags, or the path's own. If the shapes would exceed the memory limit,
// this fails before the times are computed.
std::vector<double> TimesFromFlags(const Path& path) {
  if (!FLAGS_at.empty() && FLAGS_frames != 0) throw UsageError("--at and --frames: give one");
  if (!(FLAGS_memory_limit > 0)) throw UsageError(AsTyped("memory_limit") + ": must be positive");
  if (!FLAGS_at.empty()) return NumbersFromFlag("at", FLAGS_at);
  if (FLAGS_frames == 0) return path.parameters;
  if (FLAGS_frames < 2) throw UsageError(AsTyped("frames") + ": must be 2 or more");
  // Each shape is stored twice, in the metric's unit and as placed.
  const double bytes = 2.0 * FLAGS_frames * path.shapes[0].size() * sizeof(double);
  if (bytes > 1e9 * FLAGS_memory_limit) {
    throw SolverError(AsTyped("frames") + ": needs about " +
                      std::to_string(std::llround(bytes / 1e6)) +
                      " MB, more than the memory limit; ask for fewer frames or raise "
                      "--memory_limit");
  }
  std::vector<double> times;
  for (int i = 0; i < FLAGS_frames; ++i) {
    const double t = static_cast<double>(i) / (FLAGS_frames - 1);
    times.push_back(path.parameters.back() * (FLAGS_ease ? 0.5 * (1 - std::cos(M_PI * t)) : t));
  }
  return times;
}

void Run(const std::vector<std::string>& files) {
  if (files.size() != 1) throw UsageError("name one .path file");
  // One shape needs no number in its name.
  if (!FLAGS_at.empty() && NumbersFromFlag("at", FLAGS_at).size() == 1) WriteLastShapeAlone();
  const std::vector<std::string> outputs = OutputsFromFlags();
  for (const std::string& output : outputs) {
    if (IsPathFile(output)) {
      throw UsageError("--output " + output +
                       ": a path at other times is not a geodesic; export meshes or pictures");
    }
  }
  const bool plays = std::any_of(outputs.begin(), outputs.end(), [](const auto& output) {
    const std::string extension = internal::FileExtension(output);
    return extension == ".glb" || extension == ".gif" || extension == ".apng";
  });
  if (FLAGS_ease && FLAGS_frames == 0 && !plays) {
    throw UsageError("--ease goes with --frames, or with a .gif, .apng or .glb");
  }
  AnchorFlags anchorage = AnchorFlags::FromFlags();
  if (IsWritableMesh(files[0])) {
    throw FileError(files[0] +
                    " is a mesh, not a .path; a path is made of poses by: shape-interpolate " +
                    files[0] + " OTHER --output walk.path");
  }
  const Path path = ReadPathAndTell(files[0]);
  anchorage.Select(path.Placed(0), *path.metric->connectivity, path.appearance, path.poses.size());
  const std::vector<double> times = TimesFromFlags(path);
  CheckNothingIsOverwritten(files, {{"output", outputs, static_cast<std::int64_t>(times.size())}});
  Path shown = path;
  if (times != path.parameters) {
    NamingFlags({{"times", "at"}}, [&] { shown = Resample(path, times); });
  }
  anchorage.Apply(path, &shown);
  Out() << shown.NumShapes() << (shown.NumShapes() == 1 ? " shape of " : " shapes of ") << files[0]
        << '\n';
  WriteOutputs(outputs, shown, path);
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  gflags::SetCommandLineOptionWithMode("output", "path.png", gflags::SET_FLAGS_DEFAULT);
  return RunTool(argc, argv,
                 {"shape-export",
                  "meshes and pictures of a path, without solving again",
                  R"(  shape-export walk.path --output walk.png,frames/%03d.obj --frames 40 --ease
  shape-export walk.path --output quarter%d.obj --at .25,.5,.75
  shape-export walk.path --output middle.obj --at .5)",
                  {"export", "outputs", "camera", "bones", "anchor", "memory", "outside_files"}},
                 Run);
}
