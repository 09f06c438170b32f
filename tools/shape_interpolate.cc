// A geodesic between poses of a mesh.

#include <filesystem>
#include <iostream>

#include <gflags/gflags.h>

#include <shapespace/solvers/geodesic.h>

#include "support/metric_flags.h"
#include "support/outputs.h"
#include "support/poses.h"
#include "support/tool.h"

DEFINE_int32(shapes, 15, "shapes to insert between neighbouring poses");
DEFINE_double(tolerance, 1e-4,
              "a level is finished when an iteration lowers the energy by less than this share");
DEFINE_int32(max_iterations, 500, "iterations a level may take");
DEFINE_string(solver, "automatic",
              "automatic, lbfgs (of Ceres), threaded_lbfgs (ours) or trust_region (of Ceres)");
DEFINE_string(schedule, "automatic",
              "order of resolutions: automatic, start (in space for the first shape only), paper "
              "(space and time in turn) or flat (no hierarchy)");
DEFINE_string(start, "best",
              "where the first solve starts: blend, first, last, rigid, or the best of the first "
              "three");
DEFINE_int32(coarsest, 200, "triangles of the coarsest level of the hierarchy");
DEFINE_double(memory_limit, 8, "gigabytes that the solve may take; more is refused beforehand");
DEFINE_string(report, "", "write a report: .json, or .txt for reading; - prints JSON on stdout");

namespace shapespace::tools {
namespace {

// The value that `name` stands for. \throw UsageError listing the names.
template <typename Value>
Value Choose(const char* flag, const std::string& name,
             const std::vector<std::pair<std::string, Value>>& choices) {
  std::string names;
  for (const auto& [choice, value] : choices) {
    if (choice == name) return value;
    names += (names.empty() ? "" : ", ") + choice;
  }
  throw UsageError("--" + std::string(flag) + " " + name + ": must be one of " + names);
}

GeodesicOptions OptionsFromFlags() {
  GeodesicOptions options;
  options.metric = MetricFromFlags();
  options.shapes = FLAGS_shapes;
  options.tolerance = FLAGS_tolerance;
  options.max_iterations = FLAGS_max_iterations;
  options.memory_limit = 1e9 * FLAGS_memory_limit;
  options.coarsest = FLAGS_coarsest;
  options.solver = Choose<Solver>("solver", FLAGS_solver,
                                  {{"automatic", Solver::kAutomatic},
                                   {"lbfgs", Solver::kLbfgs},
                                   {"threaded_lbfgs", Solver::kThreadedLbfgs},
                                   {"trust_region", Solver::kTrustRegion}});
  options.schedule = Choose<Schedule>("schedule", FLAGS_schedule,
                                      {{"automatic", Schedule::kAutomatic},
                                       {"start", Schedule::kStart},
                                       {"paper", Schedule::kPaper},
                                       {"flat", Schedule::kFlat}});
  options.start = Choose<Start>("start", FLAGS_start,
                                {{"best", Start::kBest},
                                 {"blend", Start::kBlend},
                                 {"first", Start::kFirst},
                                 {"last", Start::kLast},
                                 {"rigid", Start::kRigid}});
  options.Validate();
  return options;
}

void Run(const std::vector<std::string>& files) {
  if (files.size() < 2) throw UsageError("name at least two poses of one mesh");
  const GeodesicOptions options = OptionsFromFlags();
  const std::vector<std::string> outputs = OutputsFromFlags();
  const std::string report_kind = std::filesystem::path(FLAGS_report).extension().string();
  if (!FLAGS_report.empty() && FLAGS_report != "-") {
    if (report_kind != ".json" && report_kind != ".txt") {
      throw UsageError("--report " + FLAGS_report + ": must end in .json or .txt, or be -");
    }
    CheckCanBeWritten(FLAGS_report);
  }

  const Poses poses = ReadPosesFromFlags(files);
  GeodesicResult result = Interpolate(poses, options, TerminalProgress());
  result.path.provenance = "shape-interpolate " SHAPESPACE_VERSION ":";
  for (const std::string& file : files) result.path.provenance += " " + file;
  WriteOutputs(outputs, result.path, poses.appearance, result.path);

  if (!FLAGS_report.empty()) {
    WriteReport(FLAGS_report,
                report_kind == ".txt" ? result.summary.FullReport() : result.summary.ToJson());
  }
  for (const std::string& warning : result.summary.warnings) {
    std::cerr << "warning: " << warning << '\n';
  }
  (FLAGS_report == "-" ? std::cerr : std::cout) << result.summary.BriefReport() << '\n';
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  return RunTool(
      argc, argv,
      {"shape-interpolate",
       "a geodesic of shape space between poses of a mesh",
       "  shape-interpolate a.obj b.obj [c.obj ...] --shapes 15 --output "
       "walk.png,walk.path,frames/%03d.obj\n\n"
       "Poses are OBJ, PLY or OFF files with the same faces in the same order. With 15 "
       "shapes inserted\nbetween two poses 17 frames are written, numbered from 000, the "
       "poses included.",
       {"shape_interpolate.cc", "support/outputs.cc", "support/metric_flags.cc",
        "support/poses.cc"}},
      Run);
}
