// Writes outputs of an existing path, or of meshes that are the frames of a motion.

#include <algorithm>
#include <cmath>

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/files/write.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/path.h>

#include "support/anchor_flags.h"
#include "support/command_line.h"
#include "support/flag_group.h"
#include "support/lists.h"
#include "support/memory_flag.h"
#include "support/outputs.h"
#include "support/poses.h"
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

// Meshes as they are, one after the other, evenly in time.
Path ReadFrames(const std::vector<std::string>& files) {
  if (files.size() == 1 && IsWritableMesh(files[0])) {
    throw FileError(files[0] +
                    " is one mesh; name all frames of a motion, or a path, which is made of poses "
                    "by: shape-interpolate " +
                    files[0] + " OTHER --output walk.path");
  }
  const Poses frames = ReadPosesFromFlags(files);
  Path path =
      MakePath(FreezeMetric(MetricOptions(), frames.connectivity, frames.shapes), frames.shapes);
  path.provenance = Provenance("shape-export", files);
  path.appearance = frames.soup.appearance;
  return path;
}

Path ReadMotion(const std::vector<std::string>& files, bool is_path) {
  if (!is_path) return ReadFrames(files);
  RefuseFlags({"poses", "mesh"}, {}, "goes with meshes; " + files[0] + " is a path");
  return ReadPathAndTell(files[0]);
}

void Run(const std::vector<std::string>& files) {
  const bool is_path = IsPathAlone(files);
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
  const Path path = ReadMotion(files, is_path);
  anchorage.Select(path.Placed(0), *path.metric->connectivity, path.appearance, path.poses.size());
  const std::vector<double> times = TimesFromFlags(path);
  CheckNothingIsOverwritten(WithStiffeners(files),
                            {{"output", outputs, static_cast<std::int64_t>(times.size())}});
  Path shown = path;
  if (times != path.parameters) {
    NamingFlags({{"times", "at"}}, [&] { shown = Resample(path, times); });
  }
  anchorage.Apply(path, &shown);
  Out() << shown.NumShapes() << (shown.NumShapes() == 1 ? " shape of " : " shapes of ") << files[0]
        << (files.size() > 1 ? ", ...\n" : "\n");
  WriteOutputs(outputs, shown, path);
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  gflags::SetCommandLineOptionWithMode("output", "path.png", gflags::SET_FLAGS_DEFAULT);
  return RunTool(argc, argv,
                 {"shape-export",
                  "meshes and pictures of a path, or of the frames of a motion, without solving",
                  R"(  shape-export walk.path --output walk.png,frames/%03d.obj --frames 40 --ease
  shape-export walk.path --output quarter%d.obj --at .25,.5,.75
  shape-export walk.path --output middle.obj --at .5
  shape-export frames/*.ply --output walk.glb --bones 20
  shape-export cloth.obj cloth.pc2 --output cloth.glb --bones 20)",
                  {"export", "outputs", "camera", "bones", "anchor", "poses", "mesh", "memory",
                   "outside_files"}},
                 Run);
}
