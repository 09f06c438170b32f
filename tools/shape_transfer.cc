// A motion, carried over to another body of the same connectivity.

#include <algorithm>
#include <filesystem>
#include <iostream>

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/mesh/check.h>
#include <shapespace/output/frames.h>
#include <shapespace/path/path_file.h>
#include <shapespace/solvers/transfer.h>

#include "support/choose.h"
#include "support/geodesic_flags.h"
#include "support/outputs.h"
#include "support/poses.h"
#include "support/report.h"
#include "support/tool.h"

DEFINE_string(target, "", "the other body, in the pose of the first source: what is to move");
DEFINE_string(hybrids, "",
              "files for the bodies half way between source and target, named as by --output");
DEFINE_double(transfer_bending, shapespace::TransferOptions::Strains().bending,
              "in the transfer's own metric, of strains: how much dihedral angles count");
DEFINE_string(connection, "nearest",
              "what carries motion along a rung: nearest (what changes strains and angles most "
              "nearly as before), levi_civita (of second order; takes dozens of --rung_shapes) or "
              "projection (the paper's)");
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
                                          {{"nearest", Connection::kNearest},
                                           {"levi_civita", Connection::kLeviCivita},
                                           {"projection", Connection::kConstrainedProjection}});
  options.Validate();
  options.metric.bending = FLAGS_transfer_bending;
  try {
    options.metric.Validate();
  } catch (const InvalidOptions& error) {  // names the field, which is another flag here
    throw UsageError("--transfer_" + std::string(error.what()));
  }
  return options;
}

// The target, as a pose of the path's mesh.
Poses ReadTargetOf(const Path& path, const std::string& file) {
  Poses target = ReadPosesFromFlags({FLAGS_target});
  Soup reference = FrameSoup(*path.metric->connectivity), pose = target.soup;
  reference.file = file;
  reference.vertices = path.Placed(0);
  // Only graphs' segments are told from the other edges that a path holds.
  if (!path.metric->connectivity->IsGraph()) pose.segments.clear();
  for (const Finding& finding : CheckCorrespondence(reference, pose)) {
    if (finding.severity == Severity::kFatal) throw CorrespondenceError(finding.message);
    std::cerr << "warning: " << finding.message << '\n';
  }
  return target;
}

template <typename Summary>
void Tell(const Summary& summary, const std::vector<std::string>& warnings) {
  WriteReport(summary.FullReport(), summary.ToJson());
  PrintSummary(summary.BriefReport(), warnings);
}

void Run(const std::vector<std::string>& files) {
  const bool from_path = IsOnePath(files);
  if (FLAGS_target.empty()) throw UsageError("--target: name the body that is to move");
  const GeodesicOptions geodesic = GeodesicFromFlags();
  const TransferOptions options = TransferFromFlags();
  const std::vector<std::string> outputs = OutputsFromFlags();
  std::vector<std::string> hybrid_outputs;
  if (!FLAGS_hybrids.empty()) hybrid_outputs = OutputsFromFlag("hybrids", FLAGS_hybrids);
  CheckReportFlag();

  std::vector<std::string> all = files;
  all.push_back(FLAGS_target);
  const std::string provenance = Provenance("shape-transfer", all);
  const auto write = [&](Path path, Path hybrids, const Appearance& appearance) {
    path.provenance = hybrids.provenance = provenance;
    hybrids.provenance += "; hybrids";
    path.appearance = hybrids.appearance = appearance;
    WriteOutputs(outputs, path, path);
    WriteOutputs(hybrid_outputs, hybrids, hybrids);
  };
  if (from_path) {
    const Path source = ReadPath(files[0]);
    const Poses target = ReadTargetOf(source, files[0]);
    const TransferResult result = Transfer(source, target.shapes[0], options, TerminalProgress());
    write(result.path, result.hybrids, target.soup.appearance);
    Tell(result.summary, result.summary.warnings);
  } else {
    Poses poses = ReadPosesFromFlags(all);
    const Shape target = poses.shapes.back();
    poses.shapes.pop_back();
    const PoseTransferResult result = TransferPoses(poses.connectivity, poses.shapes, target,
                                                    geodesic, options, TerminalProgress());
    write(result.path, result.hybrids, ReadSoup(FLAGS_target).appearance);
    Tell(result.summary, result.summary.Warnings());
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
       "  shape-transfer stand.obj sit.obj leap.obj --target other.obj --output other%d.obj\n"
       "  shape-transfer walk.path --target other.obj --output walk.glb --hybrids half.glb\n\n"
       "All meshes have the same faces in the same order. The target is in the first pose. Each "
       "of the\nothers is reached on its own, by a geodesic in --shapes + 1 steps, and every step "
       "is carried over:\nframe 0 is the target, frame 1 the target in the second pose. Of a "
       ".path every shape is carried\nover, and there are as many frames. The flags of the metric "
       "are those of the geodesics between\nthe source's poses. In a film strip the target is "
       "blue, all that became of it purple; hybrids are\ngreen.",
       {"shape_transfer.cc", "support/geodesic_flags.cc", "support/report.cc", "support/outputs.cc",
        "support/metric_flags.cc", "support/poses.cc"}},
      Run);
}
