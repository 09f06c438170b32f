// Computes a geodesic between poses of a mesh.

#include <shapespace/geodesic/geodesic.h>

#include "support/anchor_flags.h"
#include "support/geodesic_flags.h"
#include "support/outputs.h"
#include "support/poses.h"
#include "support/report.h"
#include "support/solve_progress.h"
#include "support/tool.h"

namespace shapespace::tools {
namespace {

void Run(const std::vector<std::string>& files) {
  if (files.empty()) throw UsageError("name at least two poses of one mesh");
  const GeodesicOptions options = GeodesicFromFlags();
  AnchorFlags anchorage = AnchorFlags::FromFlags();
  const std::vector<std::string> outputs = OutputsFromFlags();
  const Poses poses = ReadPosesFromFlags(files);
  CheckNothingIsOverwritten(
      WithStiffeners(files),
      {{"output", outputs, NumShapes(poses.shapes.size(), options)}, ReportFromFlag()});
  anchorage.Select(poses.shapes[0], *poses.connectivity, poses.soup.appearance);
  GeodesicResult result = Interpolate(poses, options, SolveProgress(outputs).get());
  const GeodesicSummary& summary = result.summary;
  result.path.provenance = Provenance("shape-interpolate", files);
  anchorage.Apply(&result.path);
  PrintSummary(summary.BriefReport(), summary.warnings,
               summary.termination == Termination::kConverged);
  WriteOutputs(outputs, result.path, result.path);
  WriteReport(summary.FullReport(), summary.ToJson());
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  return RunTool(
      argc, argv,
      {"shape-interpolate",
       "a geodesic of shape space between poses of a mesh",
       std::string(
           "  shape-interpolate a.obj b.obj [c.obj ...] --shapes 15 --output "
           "walk.png,walk.path,frames/%03d.obj\n\n"
           "Poses are OBJ, PLY, OFF, STL or glTF files with the same faces in the same order. With "
           "15 shapes\ninserted between two poses 17 frames are written, numbered from 000, the "
           "poses included. The morph\ntargets of a glTF file are poses too.") +
           kHowASolveEnds,
       {"geodesic", "report", "outputs", "anchor", "metric", "poses", "mesh", "memory",
        "outside_files"}},
      Run);
}
