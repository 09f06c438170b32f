// Computes a geodesic between poses of a mesh, or a smooth motion through them.

#include <optional>
#include <utility>

#include <shapespace/geodesic/geodesic.h>

#include "support/anchor_flags.h"
#include "support/geodesic_flags.h"
#include "support/outputs.h"
#include "support/poses.h"
#include "support/report.h"
#include "support/solve_progress.h"
#include "support/spline_flags.h"
#include "support/summary.h"
#include "support/tool.h"

namespace shapespace::tools {
namespace {

void Run(const std::vector<std::string>& files) {
  if (files.empty()) throw UsageError("name at least two poses of one mesh");
  const GeodesicOptions options = GeodesicFromFlags();
  AnchorFlags anchorage = AnchorFlags::FromFlags();
  const std::vector<std::string> outputs = OutputsFromFlags();
  const Poses poses = ReadPosesFromFlags(files);
  std::optional<SplineOptions> spline = SplineFromFlags(poses.connectivity->NumVertices());
  const bool returns = spline && spline->ends == SplineEnds::kPeriodic;
  CheckNothingIsOverwritten(
      WithStiffeners(files),
      {{"output", outputs, NumShapes(poses.shapes.size() + returns, options)}, ReportFromFlag()});
  anchorage.Select(poses.shapes[0], *poses.connectivity, poses.soup.appearance,
                   poses.shapes.size() + returns);
  const auto finish = [&](Path path, const auto& summary, bool converged) {
    path.provenance = Provenance("shape-interpolate", files);
    PrintSummary(summary.BriefReport(), summary.warnings, converged);
    anchorage.Apply(&path);
    WriteOutputs(outputs, path, path);
    WriteReport(summary.FullReport(), summary.ToJson());
  };
  if (spline) {
    spline->geodesic = options;
    SplineResult result;
    NamingFlags({{"by_length", "times"}},
                [&] { result = Spline(poses, *spline, SolveProgress(outputs).get()); });
    finish(std::move(result.path), result.summary, result.summary.Converged());
  } else {
    GeodesicResult result = Interpolate(poses, options, SolveProgress(outputs).get());
    finish(std::move(result.path), result.summary,
           result.summary.termination == Termination::kConverged);
  }
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  return RunTool(
      argc, argv,
      {"shape-interpolate",
       "a geodesic of shape space, or a smooth motion, through poses of a mesh",
       std::string(
           "  shape-interpolate a.obj b.obj [c.obj ...] --shapes 15 --output "
           "walk.png,walk.path,frames/%03d.obj\n\n"
           "Poses are OBJ, PLY, OFF, STL or glTF files with the same faces in the same order. With "
           "15 shapes\ninserted between two poses 17 frames are written, numbered from 000, the "
           "poses included. The morph\ntargets of a glTF file are poses too.\n\n"
           "Through three or more poses the path is a chain of geodesics, whose velocity jumps at "
           "each pose.\nWith --spline it is smooth there.") +
           kHowASolveEnds,
       {"geodesic", "spline", "report", "summary", "outputs", "anchor", "metric", "poses", "mesh",
        "memory", "outside_files"}},
      Run);
}
