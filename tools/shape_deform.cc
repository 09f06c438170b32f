// Deforms a mesh by handles, or repairs a distorted one.

#include <algorithm>

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/deformation/handle_file.h>
#include <shapespace/deformation/internal/option_fields.h>
#include <shapespace/deformation/repair.h>
#include <shapespace/mesh/selection.h>

#include "support/flag_group.h"
#include "support/memory_flag.h"
#include "support/metric_flags.h"
#include "support/obstacle_flag.h"
#include "support/option_flags.h"
#include "support/outputs.h"
#include "support/poses.h"
#include "support/report.h"
#include "support/solve_progress.h"
#include "support/summary.h"
#include "support/tool.h"

DEFINE_string(handles, "",
              "JSON file of handles: vertices and their targets (docs/file-formats.md)");
DEFINE_string(repair, "",
              "instead of --handles: an undistorted pose of the same mesh, whose lengths, angles "
              "and volume are restored");
DEFINE_string(sound, "",
              "with --repair: the vertices whose positions are kept, as a selection (as in "
              "handles); default: all");
static const shapespace::tools::OptionFlags<shapespace::DeformationOptions> flags(
    __FILE__, {{"shapes", "shapes"},
               {"balance", "balance"},
               {"tolerance", "tolerance"},
               {"max_iterations", "max_iterations"},
               {"solver", "solver"},
               {"coarsest", "coarsest"},
               {"avoid_contact", "avoid_contact"}});
FLAG_GROUP(deform, "Handles", "handles, repair, shapes");

namespace shapespace::tools {
namespace {

// The default depends on the mesh.
constexpr char kMetric[] = "deformation";

void CheckFlags(const std::vector<std::string>& files) {
  if (files.size() != 1) throw UsageError("name one mesh");
  for (const char* flag : {"handles", "repair", "sound"}) {
    if (IsGiven(flag) && gflags::GetCommandLineFlagInfoOrDie(flag).current_value.empty()) {
      throw UsageError("--" + std::string(flag) + ": is empty");
    }
  }
  if (FLAGS_handles.empty() == FLAGS_repair.empty()) {
    throw UsageError(
        "give --handles, or --repair; handles are picked on the page that this writes: "
        "shape-view " +
        files[0]);
  }
  if (FLAGS_repair.empty() && IsGiven("sound")) throw UsageError("--sound: goes with --repair");
}

// But for the metric.
DeformationOptions DeformationFromFlags() {
  DeformationOptions options =
      FLAGS_repair.empty() ? DeformationOptions() : RepairOptions::Defaults();
  options.memory_limit = 1e9 * FLAGS_memory_limit;
  flags.Set(&options);
  return options;
}

void SetMetric(const Poses& mesh, DeformationOptions* options) {
  options->metric = MetricFromFlags(&mesh);
  const auto flag_of = [](const char* field) { return IsGiven(field) ? field : "metric"; };
  NamingFlags({{"rigid", flag_of("rigid")}, {"discretization", flag_of("discretization")}},
              [&] { options->Validate(); });
}

// The vertices selected by --sound.
std::vector<int> SoundVertices(const Poses& poses) {
  if (FLAGS_sound.empty()) return {};
  try {
    return SelectVertices(ReadSelection(FLAGS_sound), poses.shapes[1], *poses.connectivity,
                          poses.soup.appearance);
  } catch (const InvalidOptions& error) {
    throw UsageError("--sound: " + std::string(error.what()));
  }
}

// 1 for vertices that stay, 2 for those that move.
Eigen::VectorXi Marks(const std::vector<DeformationHandle>& handles, int num_vertices) {
  Eigen::VectorXi marks = Eigen::VectorXi::Zero(num_vertices);
  for (const DeformationHandle& handle : handles) {
    const bool stays =
        !handle.positions && handle.motion.angle == 0 && handle.motion.translation.isZero(0);
    for (int v : handle.vertices) marks(v) = std::max(marks(v), stays ? 1 : 2);
  }
  return marks;
}

void Run(const std::vector<std::string>& files) {
  CheckFlags(files);
  WriteLastShapeAlone();
  const std::vector<std::string> outputs = OutputsFromFlags();
  std::vector<std::string> inputs = files;
  inputs.push_back(FLAGS_handles.empty() ? FLAGS_repair : FLAGS_handles);
  if (!FLAGS_obstacle.empty()) inputs.push_back(FLAGS_obstacle);
  DeformationOptions options = DeformationFromFlags();
  CheckNothingIsOverwritten(
      WithStiffeners(inputs),
      {{"output", outputs, options.shapes + std::int64_t{1}}, ReportFromFlag()});
  const auto finish = [&](Path path, const auto& summary, const DeformationSummary& deformation,
                          const Appearance& appearance, const Eigen::VectorXi& marks) {
    path.provenance = Provenance("shape-deform", inputs);
    path.appearance = appearance;
    PrintSummary(summary.BriefReport(), deformation.warnings, summary.Converged());
    WriteOutputs(outputs, path, path, marks);
    WriteReport(summary.FullReport(), summary.ToJson());
  };
  options.obstacle = ObstacleFromFlag(options.avoid_contact);
  if (FLAGS_repair.empty()) {
    const Poses poses = ReadMeshesFromFlags(files);
    SetMetric(poses, &options);
    const std::vector<DeformationHandle> handles =
        ReadHandles(FLAGS_handles, poses.shapes[0], *poses.connectivity, poses.soup.appearance);
    DeformationResult result =
        Deform(poses.connectivity, poses.shapes[0], handles, options, SolveProgress(outputs).get());
    finish(std::move(result.path), result.summary, result.summary, poses.soup.appearance,
           Marks(handles, poses.connectivity->NumVertices()));
  } else {
    const Poses poses = ReadMeshesFromFlags({FLAGS_repair, files[0]});
    SetMetric(poses, &options);
    RepairResult result = Repair(poses.connectivity, poses.shapes[0], poses.shapes[1],
                                 {options, SoundVertices(poses)}, SolveProgress(outputs).get());
    finish(std::move(result.path), result.summary, result.summary.deformation,
           poses.soup.appearance, {});
  }
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  gflags::SetCommandLineOptionWithMode("metric", kMetric, gflags::SET_FLAGS_DEFAULT);
  return RunTool(
      argc, argv,
      {"shape-deform",
       "a mesh deformed by handles, or a distorted one repaired",
       std::string(
           R"(  shape-deform mesh.obj --handles handles.json --output bent.obj,steps.png,bend.glb
  shape-deform dented.obj --repair sound.obj --output mended.obj

Handles are vertices that stay, move or turn; the motion of the others has the least cost. The
output is a path: an .obj or .ply without a number in its name contains its last shape, the
deformed mesh, and - writes that to stdout, as PLY. In a film strip, vertices of handles are drawn
dark if they stay, and red if they move. The default metric depends on whether the mesh is closed
(stiffer, with a cost of volume) or open; --metric selects another; --volume 30 keeps the volume
within .3 %.)") +
           kHowASolveEnds,
       {"deform", "obstacle", "report", "summary", "outputs", "camera", "bones", "metric", "poses",
        "mesh", "memory", "outside_files"}},
      Run);
}
