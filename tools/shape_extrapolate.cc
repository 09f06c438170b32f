// Continues a path beyond its poses by shooting a geodesic from its last shapes.

#include <gflags/gflags.h>
#include <nlohmann/json.hpp>

#include <shapespace/base/error.h>
#include <shapespace/exponential/correction.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/exponential/internal/option_fields.h>
#include <shapespace/geodesic/geodesic.h>

#include "support/anchor_flags.h"
#include "support/flag_group.h"
#include "support/geodesic_flags.h"
#include "support/interrupt.h"
#include "support/option_flags.h"
#include "support/outputs.h"
#include "support/poses.h"
#include "support/report.h"
#include "support/solve_progress.h"
#include "support/summary.h"
#include "support/tool.h"

DEFINE_int32(steps, 8,
             "shapes to add, with the spacing in time of the last two shapes that are kept");
DEFINE_int32(keep, 0,
             "continue from the first shapes of the path, this many; 2 or more, or 0 for all");
DEFINE_double(
    correct, 0,
    "afterwards correct all shapes but the first towards its edge lengths: weight of the distance "
    "from the uncorrected shapes; start from 1, less for more accurate lengths; 0: off");
static const shapespace::tools::OptionFlags<shapespace::ExponentialOptions> flags(
    __FILE__, {{"integrator", "integrator"},
               {"solver", "step_solver"},
               {"max_iterations", "step_iterations"},
               {"stop_at_contact", "stop_at_contact"},
               {"slide_at_contact", "slide_at_contact"}});
FLAG_GROUP(extrapolate, "Extrapolation", "steps, stop_at_contact, slide_at_contact, correct");

namespace shapespace::tools {
namespace {

// The tolerance of the interpolation of poses is stricter than is needed for viewing, because
// errors in the two shapes from which a geodesic is shot grow with every step.
constexpr char kTolerance[] = "1e-6";

CorrectionOptions CorrectionFromFlags() {
  CorrectionOptions options;
  options.mu = FLAGS_correct;
  NamingFlags({{"mu", "correct"}}, [&] { options.Validate(); });
  return options;
}

// Checks the flags for a path of `shapes` shapes, before it is continued.
void CheckFlags(const std::vector<std::string>& files, std::int64_t shapes,
                const std::vector<std::string>& outputs) {
  if (FLAGS_keep > shapes) {
    throw UsageError("--keep " + std::to_string(FLAGS_keep) + ": the path has " +
                     std::to_string(shapes) + " shapes");
  }
  const std::int64_t frames = (FLAGS_keep != 0 ? FLAGS_keep : shapes) + FLAGS_steps;
  CheckNothingIsOverwritten(WithStiffeners(files), {{"output", outputs, frames}, ReportFromFlag()});
}

Path OriginFromPath(const std::string& file, const std::vector<std::string>& outputs,
                    AnchorFlags* anchorage) {
  Path path = ReadPathAndTell(file);
  if (path.metric->rigid.Active()) {
    throw SolverError(file +
                      ": was computed under the rigid metric, which has no exponential map; "
                      "interpolate its poses under another one");
  }
  CheckFlags({file}, path.NumShapes(), outputs);
  anchorage->Select(path.Placed(0), *path.metric->connectivity, path.appearance, path.poses.size());
  return path;
}

Path OriginFromPoses(const std::vector<std::string>& files, const GeodesicOptions& options,
                     const std::vector<std::string>& outputs, AnchorFlags* anchorage) {
  const Poses poses = ReadPosesFromFlags(files);
  CheckFlags(files, NumShapes(poses.shapes.size(), options), outputs);
  anchorage->Select(poses.shapes[0], *poses.connectivity, poses.soup.appearance,
                    poses.shapes.size());
  GeodesicResult result = Interpolate(
      poses, options, SolveProgress(outputs, std::to_string(FLAGS_steps) + " steps").get());
  PrintSummary(result.summary.BriefReport(), result.summary.warnings,
               result.summary.termination == Termination::kConverged);
  return std::move(result.path);
}

void Run(const std::vector<std::string>& files) {
  const bool from_path = IsOnePath(files);
  if (from_path) RefuseFlags({}, {"memory_limit"}, "goes with poses");
  for (const char* flag :
       {"allow_mirrored", "allow_mismatch", "allow_nonmanifold", "mirror", "open_seams"}) {
    if (from_path && IsGiven(flag)) {
      throw UsageError("--" + std::string(flag) +
                       ": goes with poses; a .path was already checked when it was made");
    }
  }
  if (FLAGS_steps < 1) throw UsageError("--steps must be 1 or more");
  if (FLAGS_keep != 0 && FLAGS_keep < 2) throw UsageError("--keep must be 2 or more, or 0 for all");
  const GeodesicOptions geodesic = GeodesicFromFlags();
  if (geodesic.metric.rigid > 0) {  // before the interpolation, not after it
    throw UsageError("--rigid: the rigid metric has no exponential map; use --metric strain");
  }
  ExponentialOptions exponential;
  flags.Set(&exponential);
  const CorrectionOptions correction = CorrectionFromFlags();
  const std::vector<std::string> outputs = OutputsFromFlags();
  AnchorFlags anchorage = AnchorFlags::FromFlags();

  Path origin = from_path ? OriginFromPath(files[0], outputs, &anchorage)
                          : OriginFromPoses(files, geodesic, outputs, &anchorage);
  const std::string provenance =
      (from_path ? origin.provenance + "; " : "") + Provenance("shape-extrapolate", files);
  if (Interrupted()) {  // the interpolated part so far is written
    origin.provenance = provenance;
    anchorage.Apply(&origin);
    return WriteOutputs(outputs, origin, origin);
  }
  if (FLAGS_keep != 0) origin = FirstShapes(origin, FLAGS_keep);
  ExponentialResult result =
      Extrapolate(origin, FLAGS_steps, exponential, SolveProgress(outputs).get());
  const ExponentialSummary& summary = result.summary;
  PrintSummary(summary.BriefReport(), summary.warnings, summary.Converged());
  result.path.provenance = provenance;
  std::string text = summary.FullReport();
  auto json = nlohmann::ordered_json::parse(summary.ToJson());
  if (FLAGS_correct != 0 && !summary.steps.empty() && !Interrupted()) {
    CorrectionResult corrected = CorrectPath(result.path, correction, SolveProgress(outputs).get());
    PrintSummary(corrected.summary.BriefReport(), corrected.summary.warnings,
                 corrected.summary.converged);
    result.path = std::move(corrected.path);
    text += "Corrected         " + corrected.summary.BriefReport() + '\n';
    json["correction"] = nlohmann::ordered_json::parse(corrected.summary.ToJson());
  }
  anchorage.Apply(&result.path);
  WriteOutputs(outputs, result.path, result.path);
  WriteReport(text, json.dump(2) + '\n');
  if (summary.steps.empty()) {
    throw SolverError("no shape could be added: " + summary.stopped);
  }
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  gflags::SetCommandLineOptionWithMode("tolerance", kTolerance, gflags::SET_FLAGS_DEFAULT);
  return RunTool(
      argc, argv,
      {"shape-extrapolate",
       "a path that continues beyond its poses",
       std::string(
           R"(  shape-extrapolate a.obj b.obj [c.obj ...] --shapes 15 --steps 8 --output on.glb
  shape-extrapolate walk.path --keep 2 --steps 7 --output on/%03d.obj

Poses are interpolated first, as by shape-interpolate but more accurately (--tolerance), because
errors grow from step to step. A .path may be given instead of poses; it contains the metric with
which it was made. Outputs contain the shapes kept and the new ones; in a film strip poses are
blue, shapes between them green, extrapolated ones purple.

If the shape degenerates, the outputs contain the shapes before that, and stderr says so: exit code
0 if there are new shapes, 1 if there are none.)") +
           kHowASolveEnds,
       {"extrapolate", "geodesic", "report", "summary", "outputs", "camera", "bones", "metric",
        "poses", "mesh", "memory", "anchor", "outside_files"}},
      Run);
}
