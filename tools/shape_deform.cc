// Deforms a mesh by handles, or repairs a distorted one.

#include <algorithm>

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/deformation/deformation.h>
#include <shapespace/deformation/handle_file.h>
#include <shapespace/deformation/repair.h>
#include <shapespace/mesh/selection.h>

#include "support/choose.h"
#include "support/flag_group.h"
#include "support/memory_flag.h"
#include "support/metric_flags.h"
#include "support/outputs.h"
#include "support/poses.h"
#include "support/report.h"
#include "support/solve_progress.h"
#include "support/tool.h"

DEFINE_string(handles, "",
              "JSON file of handles: vertices and their targets (docs/file-formats.md)");
DEFINE_string(repair, "",
              "instead of --handles: an undistorted pose of the same mesh, whose lengths, angles "
              "and volume are restored");
DEFINE_string(sound, "",
              "with --repair: the vertices whose positions are kept, as a selection (as in "
              "handles); default: all");
DEFINE_int32(shapes, shapespace::DeformationOptions().shapes,
             "shapes after the first, including the deformed one: at least one per 90 degrees of a "
             "turn; default for repairs: 1");
DEFINE_double(balance, shapespace::DeformationOptions().balance,
              "weight of the metric relative to soft handles: towards 0 they are met exactly, at 1 "
              "they have no effect; default for repairs: 0.5");
DEFINE_double(
    tolerance, shapespace::DeformationOptions().tolerance,
    "a level has converged when an iteration lowers the objective by less than this share");
DEFINE_int32(max_iterations, shapespace::DeformationOptions().max_iterations,
             "maximum number of iterations per level");
DEFINE_string(solver, "threaded_lbfgs",
              "threaded_lbfgs, or trust_region (Ceres, for small meshes)");
DEFINE_int32(coarsest, shapespace::DeformationOptions().coarsest,
             "triangles of the coarsest level of the hierarchy");
FLAG_GROUP(deform, "Handles");

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
    throw UsageError("give --handles, or --repair");
  }
  if (FLAGS_repair.empty() && IsGiven("sound")) throw UsageError("--sound: goes with --repair");
}

DeformationOptions DeformationFromFlags(const DeformationOptions& defaults, const Poses& mesh) {
  DeformationOptions options = defaults;
  options.metric = MetricFromFlags(&mesh);
  if (IsGiven("shapes")) options.shapes = FLAGS_shapes;
  if (IsGiven("balance")) options.balance = FLAGS_balance;
  options.tolerance = FLAGS_tolerance;
  options.max_iterations = FLAGS_max_iterations;
  options.coarsest = FLAGS_coarsest;
  options.memory_limit = 1e9 * FLAGS_memory_limit;
  options.solver = Choose<DeformationOptions::Solver>(
      "solver", FLAGS_solver,
      {{"threaded_lbfgs", DeformationOptions::Solver::kThreadedLbfgs},
       {"trust_region", DeformationOptions::Solver::kTrustRegion}});
  const auto flag_of = [](const char* field) { return IsGiven(field) ? field : "metric"; };
  NamingFlags({{"rigid", flag_of("rigid")}, {"discretization", flag_of("discretization")}},
              [&] { options.Validate(); });
  return options;
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
  const int shapes =
      IsGiven("shapes") || FLAGS_repair.empty() ? FLAGS_shapes : RepairOptions::Defaults().shapes;
  CheckNothingIsOverwritten(WithStiffeners(inputs),
                            {{"output", outputs, shapes + std::int64_t{1}}, ReportFromFlag()});
  const auto finish = [&](Path path, const auto& summary, const DeformationSummary& deformation,
                          const Appearance& appearance, const Eigen::VectorXi& marks) {
    path.provenance = Provenance("shape-deform", inputs);
    path.appearance = appearance;
    PrintSummary(summary.BriefReport(), deformation.warnings, summary.Converged());
    WriteOutputs(outputs, path, path, marks);
    WriteReport(summary.FullReport(), summary.ToJson());
  };
  if (FLAGS_repair.empty()) {
    const Poses poses = ReadMeshesFromFlags(files);
    const DeformationOptions options = DeformationFromFlags({}, poses);
    const std::vector<DeformationHandle> handles =
        ReadHandles(FLAGS_handles, poses.shapes[0], *poses.connectivity, poses.soup.appearance);
    DeformationResult result =
        Deform(poses.connectivity, poses.shapes[0], handles, options, SolveProgress(outputs).get());
    finish(std::move(result.path), result.summary, result.summary, poses.soup.appearance,
           Marks(handles, poses.connectivity->NumVertices()));
  } else {
    const Poses poses = ReadMeshesFromFlags({FLAGS_repair, files[0]});
    RepairOptions options;
    options.deformation = DeformationFromFlags(RepairOptions::Defaults(), poses);
    options.vertices = SoundVertices(poses);
    RepairResult result = Repair(poses.connectivity, poses.shapes[0], poses.shapes[1], options,
                                 SolveProgress(outputs).get());
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
           "  shape-deform mesh.obj --handles handles.json --output bent.obj,steps.png,bend.glb\n"
           "  shape-deform dented.obj --repair sound.obj --output mended.obj\n\n"
           "Handles are vertices that stay, move or turn; the motion of the others has the least "
           "cost. The\noutput is a path: an .obj or .ply without a number in its name contains its "
           "last shape, the\ndeformed mesh. In a film strip, vertices of handles are drawn dark if "
           "they stay, and red if they\nmove. The default metric depends on whether the mesh is "
           "closed (stiffer, with a cost of volume) or\nopen; --metric selects another; --volume "
           "30 keeps the volume within .3 %.") +
           kHowASolveEnds,
       {"deform", "report", "outputs", "metric", "poses", "mesh", "memory", "outside_files"}},
      Run);
}
