// Computes the average of poses of a mesh.

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/files/display_names.h>
#include <shapespace/files/point_cache.h>
#include <shapespace/files/write.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/output/frames.h>
#include <shapespace/output/picture.h>
#include <shapespace/statistics/average.h>
#include <shapespace/statistics/internal/option_fields.h>

#include "support/files.h"
#include "support/flag_group.h"
#include "support/frames.h"
#include "support/lists.h"
#include "support/memory_flag.h"
#include "support/metric_flags.h"
#include "support/option_flags.h"
#include "support/poses.h"
#include "support/report.h"
#include "support/solve_progress.h"
#include "support/summary.h"
#include "support/tool.h"

DEFINE_string(
    output, "mean.obj,mean.png",
    "files to write, separated by commas: .obj, .ply, .off or .stl (the average), .pc2 or "
    ".mdd (the same as a point cache), .png (the poses and their average, which is green), - (the "
    "average on stdout, as PLY)");
static const shapespace::tools::OptionFlags<shapespace::AverageOptions> flags(
    __FILE__, {{"certify", "certify"}, {"refine", "refine"}, {"shapes", "shapes"}});
DEFINE_string(weights, "", "one number per pose, separated by commas; default: all equal");
FLAG_GROUP(average, "Average", "output, certify, refine, weights, shapes");

namespace shapespace::tools {
namespace {

std::vector<std::string> Outputs() {
  std::vector<std::string> outputs;
  for (const std::string& output : Split(FLAGS_output)) {
    if (output.empty()) continue;
    if (!IsMeshOrStdout(output) && !IsPointCache(output) &&
        internal::FileExtension(output) != ".png") {
      throw UsageError("--output " + output +
                       ": must end in .obj, .ply, .off, .stl, .png, .pc2 or .mdd, or be -");
    }
    CheckCanBeWritten(output);
    outputs.push_back(output);
  }
  if (outputs.empty()) throw UsageError("--output: names no file");
  return outputs;
}

AverageOptions OptionsFromFlags() {
  AverageOptions options;
  options.geodesic.metric = MetricFromFlags();
  options.geodesic.memory_limit = 1e9 * FLAGS_memory_limit;
  options.weights = NumbersFromFlag("weights", FLAGS_weights);
  flags.Set(&options);
  return options;
}

// The poses, turned to the average, and the average.
RgbImage Picture(const Poses& poses, const Shape& average) {
  FilmStripOptions options;
  options.labels = DisplayNames(poses.names);
  options.labels.push_back("average");
  options.roles.assign(poses.shapes.size(), ShapeRole::kPose);
  options.roles.push_back(ShapeRole::kInserted);
  options.max_frames = 1000;
  std::vector<Shape> shapes;
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(average.cols());
  for (const Shape& pose : poses.shapes)
    shapes.push_back(FitRigidMotion(pose, average, ones)(pose));
  shapes.push_back(average);
  return RenderFilmStrip(*poses.connectivity, shapes, options);
}

void Run(const std::vector<std::string>& files) {
  if (files.empty()) throw UsageError("name poses of one mesh");
  const AverageOptions options = OptionsFromFlags();
  const std::vector<std::string> outputs = Outputs();
  CheckNothingIsOverwritten(WithStiffeners(files), {{"output", outputs}, ReportFromFlag()});
  const Poses poses = ReadPosesFromFlags(files, 1, /*any_order=*/true);
  AverageResult result;
  NamingFlags({}, [&] { result = Average(poses, options, SolveProgress({}).get()); });
  const AverageSummary& summary = result.summary;
  PrintSummary(summary.BriefReport(), summary.warnings, summary.Converged());
  for (const std::string& output : outputs) {
    if (internal::FileExtension(output) == ".png") {
      WritePng(output, Picture(poses, result.shape));
      Out() << "wrote " << output << '\n';
    } else if (IsPointCache(output)) {
      WritePointCache(output, {result.shape});
      Out() << "wrote " << output << '\n';
    } else {
      WriteMeshAndTell(output, result.shape, FrameSoup(*poses.connectivity, poses.soup.appearance));
    }
  }
  WriteReport(summary.FullReport(), summary.ToJson());
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  return RunTool(
      argc, argv,
      {"shape-average",
       "the average of poses of a mesh",
       R"(  shape-average a.obj b.obj c.obj [...] --output mean.obj,mean.png
  shape-average a.obj b.obj --weights 1,3 --output quarter.obj

The average has the mean lengths and angles of the poses, as nearly as a shape can; it does not
shrink where parts turn. It is compared with a lower bound (--nocertify saves that time): above 1.1
there is a warning that the poses are too different for an average to say much. --refine lowers the
sum of squared lengths of the geodesics to the poses.)",
       {"average", "report", "summary", "metric", "poses", "mesh", "memory", "outside_files"}},
      Run);
}
