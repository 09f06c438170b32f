// A motion, carried over to another body of the same connectivity.

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/mesh/check.h>
#include <shapespace/output/frames.h>
#include <shapespace/solvers/transfer.h>

#include "support/choose.h"
#include "support/geodesic_flags.h"
#include "support/mesh_flags.h"
#include "support/outputs.h"
#include "support/poses.h"
#include "support/report.h"
#include "support/solve_progress.h"
#include "support/tool.h"

DEFINE_string(target, "", "the other body, in the pose of the first source: what is to move");
DEFINE_string(hybrids, "",
              "files for the bodies half way between source and target, named as by --output");
DEFINE_double(transfer_bending, shapespace::TransferOptions::Strains().bending,
              "in the transfer's own metric, of strains: how much dihedral angles count");
DEFINE_string(connection, "levi_civita",
              "what carries motion along a rung: levi_civita (the metric's own) or projection (the "
              "paper's)");
DEFINE_int32(rung_shapes, shapespace::TransferOptions().rung_shapes,
             "shapes between one of the source and the target's; odd, for the middle one is the "
             "hybrid");
DEFINE_bool(scale, true, "compare in one size; --noscale takes bodies as large as they are");
DEFINE_bool(align, true, "compare in one orientation; --noalign takes bodies as they stand");

namespace shapespace::tools {
namespace {

// Every shape of a geodesic is a rung to climb, and each takes as long as a small geodesic.
constexpr char kShapes[] = "7";

TransferOptions TransferFromFlags() {
  TransferOptions options;
  options.rung_shapes = FLAGS_rung_shapes;
  options.scale = FLAGS_scale;
  options.align = FLAGS_align;
  options.connection = Choose<Connection>("connection", FLAGS_connection,
                                          {{"levi_civita", Connection::kLeviCivita},
                                           {"projection", Connection::kConstrainedProjection}});
  options.metric.bending = FLAGS_transfer_bending;
  NamingFlags({{"bending", "transfer_bending"}}, [&] { options.Validate(); });
  return options;
}

// The target, as a pose of the path's mesh.
Poses ReadTargetOf(const Path& path, const std::string& file) {
  Poses target = ReadPosesFromFlags({FLAGS_target});
  Soup reference = FrameSoup(*path.metric->connectivity), pose = target.soup;
  reference.file = file;
  reference.vertices = path.Placed(0);
  const char axis = MirrorFromFlags();
  if (axis != 0 && MirrorBack(reference, axis, &pose)) {
    Err() << "warning: " << FLAGS_target << ": is a mirror image of the path's first shape; its "
          << axis << " has changed sign\n";
    target.shapes[0] = pose.vertices;
  }
  for (const Finding& finding : CheckCorrespondence(reference, pose)) {
    if (finding.severity == Severity::kFatal) throw CorrespondenceError(finding.message);
    Err() << "warning: " << finding.message << '\n';
  }
  return target;
}

void Run(const std::vector<std::string>& files) {
  const bool from_path = IsOnePath(files);
  if (FLAGS_target.empty()) throw UsageError("--target: name the body that is to move");
  const GeodesicOptions geodesic = GeodesicFromFlags();
  const TransferOptions options = TransferFromFlags();
  const std::vector<std::string> outputs = OutputsFromFlags();
  std::vector<std::string> hybrid_outputs;
  if (!FLAGS_hybrids.empty()) hybrid_outputs = OutputsFromFlag("hybrids", FLAGS_hybrids);
  std::vector<std::string> all = files;
  all.push_back(FLAGS_target);
  const auto check = [&](std::int64_t frames) {
    CheckNothingIsOverwritten(
        WithStiffeners(all),
        {{"output", outputs, frames}, {"hybrids", hybrid_outputs, frames}, ReportFromFlag()});
  };
  std::vector<std::string> all_outputs = outputs;
  all_outputs.insert(all_outputs.end(), hybrid_outputs.begin(), hybrid_outputs.end());
  const auto finish = [&](auto result, const std::vector<std::string>& warnings,
                          const Appearance& appearance) {
    PrintSummary(result.summary.BriefReport(), warnings, result.summary.Converged());
    result.path.provenance = Provenance("shape-transfer", all);
    result.hybrids.provenance = result.path.provenance + "; hybrids";
    result.path.appearance = result.hybrids.appearance = appearance;
    WriteOutputs(outputs, result.path, result.path);
    WriteOutputs(hybrid_outputs, result.hybrids, result.hybrids);
    WriteReport(result.summary.FullReport(), result.summary.ToJson());
  };
  if (from_path) {
    const Path source = ReadPathAndTell(files[0]);
    check(source.NumShapes());
    const Poses target = ReadTargetOf(source, files[0]);
    TransferResult result =
        Transfer(source, target.shapes[0], options, SolveProgress(all_outputs).get());
    const std::vector<std::string> warnings = result.summary.warnings;
    finish(std::move(result), warnings, target.soup.appearance);
  } else {
    check(static_cast<std::int64_t>(files.size()));
    Poses poses = ReadPosesFromFlags(all);
    const Shape target = poses.shapes.back();
    poses.shapes.pop_back();
    PoseTransferResult result = TransferPoses(poses.connectivity, poses.shapes, target, geodesic,
                                              options, SolveProgress(all_outputs).get());
    const std::vector<std::string> warnings = result.summary.Warnings();
    finish(std::move(result), warnings, ReadSoup(FLAGS_target).appearance);
  }
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  gflags::SetCommandLineOptionWithMode("shapes", kShapes, gflags::SET_FLAGS_DEFAULT);
  return RunTool(
      argc, argv,
      {"shape-transfer",
       "a motion, carried over to another body",
       std::string(
           "  shape-transfer stand.obj sit.obj leap.obj --target other.obj --output moved%d.obj\n"
           "  shape-transfer walk.path --target other.obj --output walk.glb --hybrids half.glb\n\n"
           "All meshes have the same faces in the same order. The target is in the first pose. "
           "Each "
           "of the\nothers is reached on its own, by a geodesic in --shapes + 1 steps, and every "
           "step "
           "is carried over:\nframe 0 is the target, frame 1 the target in the second pose. Of a "
           ".path every shape is carried\nover, and there are as many frames. The flags of the "
           "metric "
           "are those of the geodesics between\nthe source's poses. In a film strip the target is "
           "blue, all that became of it purple; hybrids are\ngreen.") +
           kHowASolveEnds,
       {"shape_transfer.cc", "support/geodesic_flags.cc", "support/report.cc", "support/outputs.cc",
        "support/metric_flags.cc", "support/poses.cc", "support/mesh_flags.cc",
        "support/memory_flag.cc"}},
      Run);
}
