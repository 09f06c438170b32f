// Computes a geodesic between poses of a mesh, or a smooth motion through them.

#include <optional>
#include <utility>

#include <gflags/gflags.h>

#include <shapespace/geodesic/geodesic.h>

#include "support/anchor_flags.h"
#include "support/flag_group.h"
#include "support/geodesic_flags.h"
#include "support/lists.h"
#include "support/obstacle_flag.h"
#include "support/outputs.h"
#include "support/poses.h"
#include "support/report.h"
#include "support/solve_progress.h"
#include "support/spline_flags.h"
#include "support/summary.h"
#include "support/tool.h"

DEFINE_string(
    via, "",
    "with --avoid_contact, between two poses: files of shapes near which the way round leads, "
    "separated by commas, for bodies that do not find it");
FLAG_GROUP(contact, "Path", "");

namespace shapespace::tools {
namespace {

// Reads the shapes of --via, which have the faces of the file `pose`.
std::vector<Shape> ReadVia(const std::string& pose, const std::vector<std::string>& files) {
  std::vector<std::string> all = {pose};
  all.insert(all.end(), files.begin(), files.end());
  std::vector<Shape> shapes = ReadMeshesFromFlags(all, /*tie=*/false).shapes;
  shapes.erase(shapes.begin());
  return shapes;
}

void Run(const std::vector<std::string>& files) {
  if (files.empty()) throw UsageError("name at least two poses of one mesh");
  GeodesicOptions options = GeodesicFromFlags();
  const std::vector<std::string> via = Split(FLAGS_via);
  if (!via.empty() && !options.avoid_contact) throw UsageError("--via goes with --avoid_contact");
  for (const char* mover : {"anchor", "ground"}) {
    if (!FLAGS_obstacle.empty() && IsGiven(mover)) {
      throw UsageError(std::string("--") + mover +
                       " moves the path, which --obstacle needs where the poses are");
    }
  }
  AnchorFlags anchorage = AnchorFlags::FromFlags();
  const std::vector<std::string> outputs = OutputsFromFlags();
  options.obstacle = ObstacleFromFlag(options.avoid_contact);
  const Poses poses = ReadPosesFromFlags(files);
  if (!via.empty()) {
    if (poses.shapes.size() != 2) throw UsageError("--via goes with two poses");
    options.via = ReadVia(files[0], via);
  }
  std::optional<SplineOptions> spline = SplineFromFlags(poses.connectivity->NumVertices());
  std::vector<std::string> inputs = files;
  inputs.insert(inputs.end(), via.begin(), via.end());
  if (!FLAGS_obstacle.empty()) inputs.push_back(FLAGS_obstacle);
  const bool returns = spline && spline->ends == SplineEnds::kPeriodic;
  CheckNothingIsOverwritten(
      WithStiffeners(inputs),
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
           R"(  shape-interpolate a.obj b.obj [c.obj ...] --shapes 15 --output walk.png,walk.path,frames/%03d.obj

Poses are OBJ, PLY, OFF, STL or glTF files with the same faces in the same order. With 15 shapes
inserted between two poses 17 frames are written, numbered from 000, the poses included. The morph
targets of a glTF file are poses too.

Through three or more poses the path is a chain of geodesics, whose velocity jumps at each pose.
With --spline it is smooth there.)") +
           kHowASolveEnds,
       {"geodesic", "contact", "obstacle", "spline", "report", "summary", "outputs", "camera",
        "bones", "anchor", "metric", "poses", "mesh", "memory", "outside_files"}},
      Run);
}
