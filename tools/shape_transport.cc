// Carries a change of one pose along a path to another: logarithm, parallel transport, exponential.

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/exponential/internal/option_fields.h>
#include <shapespace/exponential/internal/summary_fields.h>
#include <shapespace/exponential/transport.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/statistics/pose_table.h>
#include <shapespace/summary/internal/json_of.h>

#include "support/flag_group.h"
#include "support/geodesic_flags.h"
#include "support/interrupt.h"
#include "support/memory_flag.h"
#include "support/option_flags.h"
#include "support/outputs.h"
#include "support/poses.h"
#include "support/report.h"
#include "support/solve_progress.h"
#include "support/summary.h"
#include "support/tool.h"

DEFINE_int32(steps, 16,
             "of the geodesics from the first pose to the changed one, and from the last pose on");
DEFINE_string(tangents, "",
              "table of the change as tangents, a row per vertex: .csv, with the logarithm at the "
              "first pose and, transported, at the last one");
static const shapespace::tools::OptionFlags<shapespace::TransportOptions> flags(
    __FILE__, {{"connection", "connection"}, {"align", "align"}});
FLAG_GROUP(transport, "Transport", "steps, tangents");

namespace shapespace::tools {
namespace {

// A path, and a pose that differs from its first one.
struct Problem {
  Path path;
  Shape changed;
};

Path InterpolateFrom(const Poses& poses, const GeodesicOptions& options) {
  GeodesicResult result = Interpolate(poses, options, SolveProgress({}, "transport").get());
  PrintSummary(result.summary.BriefReport(), result.summary.warnings,
               result.summary.termination == Termination::kConverged);
  return std::move(result.path);
}

// Of a .path and a changed pose, or the poses at both ends of a path and the changed one.
Problem ReadProblem(const std::vector<std::string>& files) {
  if (files.size() == 2 && IsPathFile(files[0])) {
    RefuseFlags({"geodesic", "metric"}, {}, "goes with poses; a .path has its metric");
    Path path = ReadPathAndTell(files[0]);
    const Poses changed = ReadPoseOf(path, files[0], files[1]);
    return {std::move(path), changed.shapes[0]};
  }
  if (files.size() != 3) {
    throw UsageError(
        "name a .path and a changed pose, or the first, the last and the changed pose");
  }
  const GeodesicOptions options = GeodesicFromFlags();
  Poses poses = ReadPosesFromFlags(files, 3);
  if (poses.shapes.size() != 3) throw UsageError("name files of one pose each");
  const Shape changed = poses.shapes[2];
  poses.shapes.pop_back();
  poses.names.pop_back();
  return {InterpolateFrom(poses, options), changed};
}

// Tangents side by side, a row per vertex, numbered from 1.
void WriteTangents(const std::string& file, const std::vector<Tangent>& tangents) {
  const Eigen::Index num_vertices = tangents[0].cols();
  std::vector<std::string> vertices;
  for (Eigen::Index v = 1; v <= num_vertices; ++v) vertices.push_back(std::to_string(v));
  Eigen::MatrixXd rows(num_vertices, 3 * tangents.size());
  for (size_t i = 0; i < tangents.size(); ++i) {
    rows.middleCols(3 * i, 3) = tangents[i].transpose();
  }
  WritePoseTable(file, vertices, {"first_x", "first_y", "first_z", "last_x", "last_y", "last_z"},
                 rows);
  Out() << "wrote " << file << '\n';
}

void Run(const std::vector<std::string>& files) {
  if (FLAGS_steps < 2) throw UsageError("--steps must be 2 or more");
  WriteLastShapeAlone();
  const std::vector<std::string> outputs = OutputsFromFlags();
  FlagOutputs tangents_file{"tangents", {}};
  if (!FLAGS_tangents.empty()) {
    if (internal::FileExtension(FLAGS_tangents) != ".csv") {
      throw UsageError("--tangents " + FLAGS_tangents + ": must end in .csv");
    }
    CheckCanBeWritten(FLAGS_tangents);
    tangents_file.files = {FLAGS_tangents};
  }
  TransportOptions options;
  options.memory_limit = 1e9 * FLAGS_memory_limit;
  flags.Set(&options);
  CheckNothingIsOverwritten(
      WithStiffeners(files),
      {{"output", outputs, FLAGS_steps + std::int64_t{1}}, tangents_file, ReportFromFlag()});
  const Problem problem = ReadProblem(files);
  const Path& path = problem.path;
  if (path.metric->rigid.Active()) {
    throw SolverError("the rigid metric has no exponential map; use --metric strain");
  }

  LogarithmOptions logarithm;
  logarithm.shapes = FLAGS_steps - 1;
  logarithm.memory_limit = options.memory_limit;
  std::vector<Tangent> tangents = {Logarithm(path.metric, path.Placed(0), problem.changed,
                                             logarithm, SolveProgress({}, "transport").get())};
  TransportResult carried = Transport(path, tangents, options, SolveProgress({}).get());
  tangents.push_back(std::move(carried.tangents[0]));
  PrintSummary(carried.summary.BriefReport(), {}, carried.summary.converged);
  ExponentialResult result =
      Extrapolate(path.metric, path.Placed(path.NumShapes() - 1), tangents[1], FLAGS_steps, {},
                  SolveProgress(outputs).get());
  const ExponentialSummary& summary = result.summary;
  PrintSummary(summary.BriefReport(), summary.warnings, summary.Converged());
  result.path.provenance = Provenance("shape-transport", files);
  result.path.appearance = path.appearance;
  WriteOutputs(outputs, result.path, result.path);
  if (!FLAGS_tangents.empty() && !Interrupted()) WriteTangents(FLAGS_tangents, tangents);
  auto json = nlohmann::ordered_json::parse(summary.ToJson());
  json["transport"] = internal::JsonOf(carried.summary);
  WriteReport(carried.summary.BriefReport() + "\n\n" + summary.FullReport(),
              internal::TextOf(json));
  if (summary.ending == ExponentialSummary::Ending::kDegenerate) {
    throw SolverError("the changed shape could not be reached: " + summary.stopped);
  }
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  gflags::SetCommandLineOptionWithMode("output", "carried.ply", gflags::SET_FLAGS_DEFAULT);
  return RunTool(argc, argv,
                 {"shape-transport",
                  "a change of one pose, carried along a path to another pose",
                  std::string(
                      R"(  shape-transport a.obj b.obj changed_a.obj --output changed_b.obj
  shape-transport walk.path changed.obj --tangents change.csv --output there.glb

The change from the first shape of a path to a changed pose is a tangent vector (the logarithm).
It is transported in parallel along the path to its last shape, which then moves along a geodesic
with that velocity (the exponential): an .obj or .ply without a number in its name is its end, and
- writes that to stdout, as PLY. --tangents writes the tangents themselves, in the poses' unit.)") +
                      kHowASolveEnds,
                  {"transport", "geodesic", "report", "summary", "outputs", "camera", "bones",
                   "metric", "poses", "mesh", "memory", "outside_files"}},
                 Run);
}
