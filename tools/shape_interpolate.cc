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
DEFINE_string(solver, "automatic", "automatic, lbfgs or trust_region");
DEFINE_double(memory_limit, 8, "gigabytes that the solve may take; more is refused beforehand");
DEFINE_string(report, "", "write a report: .json, or .txt for reading; - prints JSON on stdout");

namespace shapespace::tools {
namespace {

GeodesicOptions OptionsFromFlags() {
  GeodesicOptions options;
  options.metric = MetricFromFlags();
  options.shapes = FLAGS_shapes;
  options.tolerance = FLAGS_tolerance;
  options.max_iterations = FLAGS_max_iterations;
  options.memory_limit = 1e9 * FLAGS_memory_limit;
  if (FLAGS_solver == "lbfgs") {
    options.solver = Solver::kLbfgs;
  } else if (FLAGS_solver == "trust_region") {
    options.solver = Solver::kTrustRegion;
  } else if (FLAGS_solver != "automatic") {
    throw UsageError("--solver " + FLAGS_solver + ": must be automatic, lbfgs or trust_region");
  }
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
  WriteOutputs(outputs, result.path, poses.appearance, result.path.shapes.front());

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
