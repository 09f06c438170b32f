// Makes a space of poses, samples it along a curve, or measures it.

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/exploration/explore.h>
#include <shapespace/exploration/internal/option_fields.h>
#include <shapespace/exploration/space_file.h>
#include <shapespace/files/display_names.h>
#include <shapespace/statistics/pose_table.h>

#include "support/command_line.h"
#include "support/flag_group.h"
#include "support/geodesic_flags.h"
#include "support/lists.h"
#include "support/mpi_crew.h"
#include "support/option_flags.h"
#include "support/outputs.h"
#include "support/poses.h"
#include "support/report.h"
#include "support/solve_progress.h"
#include "support/summary.h"
#include "support/tool.h"

static const shapespace::tools::OptionFlags<shapespace::ExploreOptions> flags(
    __FILE__, {{"resolution", "resolution"}, {"depth", "depth"}});
DEFINE_string(threshold, "5%",
              "by how much straight lines between shapes may be longer than geodesics, as a share "
              "or in per cent");
DEFINE_int32(
    measure, 0,
    "compares blends of the space with blends along geodesics at this number of random points");
DEFINE_string(
    sample, "",
    "JSON file of a curve on the plane (docs/file-formats.md): writes the shapes along it");
DEFINE_int32(frames, 32, "with --sample: number of shapes, evenly spaced along the curve");
FLAG_GROUP(explore, "Space", "depth, threshold, sample, frames, resolution");
DECLARE_string(output);

namespace shapespace::tools {
namespace {

bool IsSpaceFile(const std::string& file) { return internal::FileExtension(file) == ".space"; }

// `records` is the folder for finished geodesics.
ExploreOptions ExploreFromFlags(const std::string& records) {
  ExploreOptions options;
  options.geodesic = GeodesicFromFlags();
  options.threshold = ShareFromFlag("threshold", FLAGS_threshold);
  options.records = records;
  flags.Set(&options);
  if (FLAGS_measure < 0) throw UsageError(AsTyped("measure") + ": must be 0 or more");
  return options;
}

void Measure(const PoseSpace& space, const ExploreOptions& options, ProcessPool* crew) {
  const BlendErrors errors =
      MeasureBlends(space, FLAGS_measure, options, SolveProgress({}).get(), crew);
  Out() << "at " << errors.samples << " points, on " << errors.vertices
        << " vertices, blends deviate by " << 100 * errors.mean << "% on the mean, "
        << 100 * errors.max << "% at most, of the greatest distance between poses; "
        << 100 * errors.within << "% of them by at most " << 100 * options.threshold << "%\n";
}

// Writes the distances between every two poses as a table.
void WriteDistances(const Poses& poses, const ExploreOptions& options, ProcessPool* crew) {
  const Eigen::MatrixXd distances =
      DistanceMatrix(poses.connectivity, poses.shapes, options, SolveProgress({}).get(), crew);
  if (crew->Rank() != 0) return;
  const std::vector<std::string> names = DisplayNames(poses.names);
  WritePoseTable(FLAGS_output, names, names, distances);
  Out() << "wrote " << FLAGS_output << '\n';
  RemoveRecords(options.records);
}

void MakeSpace(const std::vector<std::string>& files, ProcessPool* crew) {
  if (files.empty()) throw UsageError("name at least two poses of one mesh, or a .space file");
  const bool is_table = internal::FileExtension(FLAGS_output) == ".csv";
  if (!is_table && !IsSpaceFile(FLAGS_output)) {
    throw UsageError("--output " + FLAGS_output + ": must end in .space or .csv");
  }
  if (is_table) {
    RefuseFlags({}, {"depth", "measure", "threshold", "report", "strict"},
                "goes with a .space, not with distances alone");
  }
  const ExploreOptions options = ExploreFromFlags(FLAGS_output + ".records");
  CheckNothingIsOverwritten(WithStiffeners(files), {{"output", {FLAGS_output}}, ReportFromFlag()});
  CheckCanBeWritten(FLAGS_output);
  const Poses poses = ReadPosesFromFlags(files, 2, /*any_order=*/true);
  if (is_table) return WriteDistances(poses, options, crew);
  ExploreResult result = Explore(poses.connectivity, poses.shapes, DisplayNames(poses.names),
                                 options, SolveProgress({}).get(), crew);
  const ExploreSummary& summary = result.summary;
  result.space.provenance = Provenance("shape-explore", files);
  result.space.appearance = poses.soup.appearance;
  if (summary.found + summary.damaged > 0) {
    Note("of ", summary.found + summary.solved, " geodesics, ", summary.found, " were taken from ",
         options.records, ", the records of an earlier run");
  }
  if (summary.damaged > 0) {
    Note(summary.damaged, " of its records were damaged and had to be solved again");
  }
  PrintSummary(summary.BriefReport(), summary.warnings, summary.Converged());
  if (crew->Rank() == 0) {
    WriteSpace(FLAGS_output, result.space);
    Out() << "wrote " << FLAGS_output << '\n';
    WriteReport(summary.FullReport(), summary.ToJson());
  }
  if (FLAGS_measure > 0) Measure(result.space, options, crew);
  if (crew->Rank() == 0) RemoveRecords(options.records);
}

void Sample(const std::string& file) {
  const std::vector<std::string> outputs = OutputsFromFlags();
  for (const std::string& output : outputs) {
    if (IsPathFile(output)) {
      throw UsageError("--output " + output +
                       ": a curve through a space is not a geodesic; export meshes or pictures");
    }
  }
  if (FLAGS_frames < 1) throw UsageError(AsTyped("frames") + ": must be 1 or more");
  CheckNothingIsOverwritten({file, FLAGS_sample}, {{"output", outputs, FLAGS_frames}});
  const PoseSpace space = ReadSpace(file);
  PlaneWalk walk = WalkAlong(space, ReadCurve(FLAGS_sample, space), FLAGS_frames);
  if (walk.outside > 0) {
    Warn(walk.outside, " of the ", FLAGS_frames,
         " points lie outside the poses' hull and were replaced by the nearest points of the "
         "hull");
  }
  walk.path.provenance = Provenance("shape-explore", {FLAGS_sample, file});
  WriteOutputs(outputs, walk.path, walk.path);
}

void MeasureSpace(const std::string& file, ProcessPool* crew) {
  RefuseFlags({"metric"}, {"depth", "output", "report", "strict", "stiffeners", "loose_components"},
              "goes with poses; " + file + " contains its own metric");
  const ExploreOptions options = ExploreFromFlags(file + ".measure.records");
  const PoseSpace space = ReadSpace(file);
  Measure(space, options, crew);
  if (crew->Rank() == 0) RemoveRecords(options.records);
}

void Run(const std::vector<std::string>& files) {
  const bool is_space = files.size() == 1 && IsSpaceFile(files[0]);
  if (!FLAGS_sample.empty()) {
    if (!is_space) throw UsageError("--sample: goes with one .space file");
    if (!IsGiven("output")) throw UsageError("--sample: needs --output, a .glb for example");
    RefuseFlags({"metric", "geodesic"},
                {"depth", "measure", "resolution", "threshold", "report", "strict"},
                "has no effect with --sample");
    Sample(files[0]);
    return;
  }
  RefuseFlags({}, {"frames"}, "goes with --sample");
  if (is_space && FLAGS_measure == 0) {
    throw UsageError(files[0] + ": give --sample or --measure; shape-view shows it");
  }
  WithCrew([&](ProcessPool* crew) {
    NamingFlags({}, [&] {
      if (is_space) {
        MeasureSpace(files[0], crew);
      } else {
        MakeSpace(files, crew);
      }
    });
  });
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  gflags::SetCommandLineOptionWithMode("output", "poses.space", gflags::SET_FLAGS_DEFAULT);
  gflags::SetCommandLineOptionWithMode("shapes", "7", gflags::SET_FLAGS_DEFAULT);
  return RunTool(
      argc, argv,
      {"shape-explore",
       "a space of poses on a plane, and the shapes along a curve through it",
       R"(  shape-explore a.obj b.obj c.obj [...] --output poses.space --threshold 5% --depth 2
  shape-explore a.obj b.obj c.obj [...] --output distances.csv
  shape-explore --sample curve.json poses.space --output walk.glb --frames 32
  shape-explore --measure 200 poses.space

Similar poses are close to each other on the plane. shape-view shows it in a browser. A .csv
has the lengths of the geodesics between every two poses, and no more. An
interrupted run can be continued: finished geodesics are stored in poses.space.records until the
space is complete. With mpirun -n 4 in front, four processes share the geodesics (--threads is the
number of threads of each process).)",
       {"explore", "geodesic", "report", "summary", "outputs", "camera", "bones", "metric", "poses",
        "mesh", "memory", "outside_files"}},
      Run);
}
