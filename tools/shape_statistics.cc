// Finds the mean and the modes of poses of a mesh, and what depends on them.

#include <optional>
#include <utility>

#include <gflags/gflags.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/extension.h>
#include <shapespace/files/display_names.h>
#include <shapespace/files/point_cache.h>
#include <shapespace/files/write.h>
#include <shapespace/output/frames.h>
#include <shapespace/output/page.h>
#include <shapespace/output/path_output.h>
#include <shapespace/statistics/assess.h>
#include <shapespace/statistics/internal/option_fields.h>
#include <shapespace/statistics/modes_file.h>
#include <shapespace/statistics/modes_page.h>
#include <shapespace/statistics/modes_picture.h>
#include <shapespace/statistics/pose_table.h>
#include <shapespace/statistics/regression.h>

#include "support/command_line.h"
#include "support/files.h"
#include "support/flag_group.h"
#include "support/frames.h"
#include "support/lists.h"
#include "support/memory_flag.h"
#include "support/mesh_flags.h"
#include "support/metric_flags.h"
#include "support/option_flags.h"
#include "support/outside_files_flag.h"
#include "support/poses.h"
#include "support/report.h"
#include "support/solve_progress.h"
#include "support/summary.h"
#include "support/tool.h"
#include "viewer/page.h"

DEFINE_string(
    output, "",
    "files to write, separated by commas. Of the modes: .modes (all, for this program), .png "
    "(their shapes and variances), mode%d.glb (an animation of each), .html (a page with sliders), "
    ".csv (coordinates of the poses), .pc2 or .mdd (a point cache: the mean, then each mode at 1, "
    "for shape keys). Of shapes at coordinates: .obj, .ply, .off or .stl, for --sample with a "
    "number, such as s%02d.obj");
static const shapespace::tools::OptionFlags<shapespace::ShapeModelOptions> model_flags(
    __FILE__, {{"modes", "modes"}, {"size", "size"}, {"certify", "certify"}, {"refine", "refine"}});
DEFINE_string(coordinates, "",
              "poses, separated by commas, whose coordinates are printed and written to a .csv");
DEFINE_bool(
    fit, false,
    "with --coordinates and --assess: coordinates whose shape is nearest, vertex by vertex");
DEFINE_string(at, "", "coordinates, separated by commas: writes the shape");
DEFINE_int32(sample, 0, "writes this number of random shapes");
DEFINE_int32(seed, 1, "of --sample, --assess and p-values");
DEFINE_string(scalars, "", ".csv with one or more numbers per pose: how the shapes depend on them");
DEFINE_string(predict, "", "with --scalars: writes the shape at these values");
DEFINE_string(groups, "", ".csv with a word per pose: how the groups differ");
DEFINE_int32(permutations, 9999, "with --scalars and --groups: for p-values");
DEFINE_bool(assess, false,
            "how well models with 1, 2, ... modes describe poses that they do not know");
FLAG_GROUP(model, "Modes",
           "modes, output, coordinates, at, sample, scalars, predict, groups, assess");

namespace shapespace::tools {
namespace {

constexpr double kFarOut = 3;  // standard deviations

// What is asked for besides the modes themselves: the flag, or none.
std::string Question() {
  std::string question;
  for (const char* flag : {"coordinates", "at", "sample", "scalars", "groups", "assess"}) {
    if (!IsGiven(flag)) continue;
    if (!question.empty()) {
      throw UsageError("--" + question + " and --" + flag + ": ask one question at a time");
    }
    question = flag;
  }
  const auto goes_with = [&](const char* flag, std::initializer_list<const char*> questions) {
    if (!IsGiven(flag)) return;
    std::string list;
    for (const char* each : questions) {
      if (question == each) return;
      list += (list.empty() ? "--" : " or --") + std::string(each);
    }
    throw UsageError(AsTyped(flag) + ": goes with " + list);
  };
  goes_with("fit", {"coordinates", "assess"});
  goes_with("seed", {"sample", "scalars", "groups", "assess"});
  goes_with("predict", {"scalars"});
  goes_with("permutations", {"scalars", "groups"});
  if (IsGiven("sample") && FLAGS_sample < 1) {
    throw UsageError(AsTyped("sample") + ": must be 1 or more");
  }
  if (FLAGS_seed < 0) throw UsageError(AsTyped("seed") + ": must be 0 or more");
  return question;
}

bool IsPage(const std::string& file) {
  const std::string extension = internal::FileExtension(file);
  return extension == ".html" || extension == ".htm";
}

// The files of --output, all of kinds that fit the question.
std::vector<std::string> Outputs(const std::string& question) {
  const bool is_shape = question == "at" || (question == "scalars" && IsGiven("predict"));
  std::vector<std::string> outputs;
  for (const std::string& output : Split(FLAGS_output)) {
    if (output.empty()) continue;
    const std::string extension = internal::FileExtension(output);
    const auto check = [&](bool fits, const char* kinds) {
      if (!fits) throw UsageError("--output " + output + ": must end in " + kinds);
    };
    if (is_shape) {
      check(IsWritableMesh(output), ".obj, .ply, .off or .stl");
    } else if (question == "sample") {
      check(IsWritableMesh(output) || extension == ".csv", ".obj, .ply, .off, .stl or .csv");
      if (extension != ".csv") CheckFramePattern("output", output);
    } else if (question == "coordinates") {
      check(extension == ".csv", ".csv");
    } else if (question == "scalars") {
      check(IsPage(output), ".html; with --predict, in .obj, .ply, .off or .stl");
    } else if (!question.empty()) {
      throw UsageError("--output: --" + question + " writes no file but --report");
    } else if (extension == ".glb") {
      CheckFramePattern("output", output);
    } else {
      check(extension == ".modes" || extension == ".png" || extension == ".csv" || IsPage(output) ||
                IsPointCache(output),
            ".modes, .png, .glb, .html, .csv, .pc2 or .mdd");
    }
    if (IsPage(output)) CheckHasViewer();
    CheckCanBeWritten(output);
    outputs.push_back(output);
  }
  if (outputs.empty() && (is_shape || question == "sample")) {
    throw UsageError("--output: name a mesh to write, such as shape.obj");
  }
  return outputs;
}

ShapeModelOptions OptionsFromFlags() {
  ShapeModelOptions options;
  options.average.geodesic.metric = MetricFromFlags();
  options.average.geodesic.memory_limit = 1e9 * FLAGS_memory_limit;
  model_flags.Set(&options);
  return options;
}

PoseModes ModesOf(const std::vector<std::string>& files) {
  if (files.size() == 1 && internal::FileExtension(files[0]) == ".modes") {
    RefuseFlags({"metric"},
                {"size", "certify", "refine", "stiffeners", "loose_components", "strict", "mirror",
                 "allow_mirrored", "allow_mismatch"},
                "goes with poses; " + files[0] + " contains its own metric and modes");
    PoseModes modes = ReadModes(files[0]);
    if (IsGiven("modes")) {
      ShapeModelOptions options;
      model_flags.Set(&options);
      NamingFlags({}, [&] { modes = FirstModes(std::move(modes), options.modes); });
    }
    return modes;
  }
  const ShapeModelOptions options = OptionsFromFlags();
  const Poses poses = ReadPosesFromFlags(files, 1, /*any_order=*/true);
  ShapeModelResult result;
  NamingFlags({}, [&] {
    result = MakeShapeModel(poses.connectivity, poses.shapes, DisplayNames(poses.names), options,
                            SolveProgress({}).get());
  });
  PrintSummary(result.summary.BriefReport(), result.summary.warnings, result.summary.Converged());
  if (Question().empty()) WriteReport(result.summary.FullReport(), result.summary.ToJson());
  result.modes.provenance = Provenance("shape-statistics", files);
  result.modes.appearance = poses.soup.appearance;
  return std::move(result.modes);
}

std::vector<std::string> Columns(int modes) {
  std::vector<std::string> columns;
  for (int k = 0; k < modes; ++k) columns.push_back("mode " + std::to_string(k + 1));
  return columns;
}

void PrintRow(const std::string& name, const Eigen::VectorXd& coordinates) {
  Out() << name << ':';
  for (const double coordinate : coordinates) Out() << ' ' << coordinate;
}

void WarnIfFarOut(const Eigen::VectorXd& coordinates) {
  const double most = coordinates.size() > 0 ? coordinates.cwiseAbs().maxCoeff() : 0;
  if (most > kFarOut) {
    Warn("a coordinate is ", most,
         " standard deviations from the mean; the poses say little about shapes that far");
  }
}

void WriteShapeAt(const ShapeModel& model, const Eigen::VectorXd& coordinates,
                  const std::vector<std::string>& outputs) {
  WarnIfFarOut(coordinates);
  const ModelShape found = model.At(coordinates, SolveProgress({}).get());
  if (!found.Converged()) {
    PrintSummary("the shape was not found to the tolerance", {}, false);
  }
  const PoseModes& modes = model.Modes();
  for (const std::string& output : outputs) {
    WriteMeshAndTell(output, found.shape, FrameSoup(*modes.metric->connectivity, modes.appearance));
  }
}

void PrintCoordinates(const ShapeModel& model, const std::vector<std::string>& outputs) {
  const std::vector<std::string> files = Split(FLAGS_coordinates);
  CheckNothingIsOverwritten(files, {{"output", outputs}});
  std::vector<Soup> soups;
  for (const std::string& file : files) soups.push_back(ReadSoup(file, FLAGS_allow_outside_files));
  // The model's mean comes first, so that a mesh with other faces is refused and named.
  const PoseModes& modes = model.Modes();
  Soup mean = FrameSoup(*modes.metric->connectivity, modes.appearance);
  mean.file = "the model";
  mean.vertices = modes.place(modes.metric->unit * modes.mean);
  soups.insert(soups.begin(), std::move(mean));
  const Poses poses = MakePosesFromFlags(std::move(soups), /*tie=*/false);
  const std::vector<std::string> names = DisplayNames({poses.names.begin() + 1, poses.names.end()});
  Eigen::MatrixXd table(names.size(), modes.NumModes() + 1);
  for (size_t i = 0; i < names.size(); ++i) {
    const ModelCoordinates found =
        model.Coordinates(poses.shapes[i + 1], FLAGS_fit, 0, SolveProgress({}).get());
    table.row(i) << found.coordinates.transpose(), found.distance;
    PrintRow(names[i], found.coordinates);
    Out() << "; the shape there is " << found.distance << " away (rms)\n";
    WarnIfFarOut(found.coordinates);
  }
  std::vector<std::string> columns = Columns(modes.NumModes());
  columns.push_back("distance");
  for (const std::string& output : outputs) {
    WritePoseTable(output, names, columns, table);
    Out() << "wrote " << output << '\n';
  }
}

void WriteSamples(const ShapeModel& model, const std::vector<std::string>& outputs) {
  const PoseModes& modes = model.Modes();
  Eigen::MatrixXd table(FLAGS_sample, modes.NumModes());
  std::vector<std::string> names;
  std::vector<Shape> shapes;
  SolveProgress progress({});
  for (int i = 0; i < FLAGS_sample; ++i) {
    const Eigen::VectorXd coordinates = model.Sample(FLAGS_seed + i);
    const ModelShape found = model.At(coordinates, progress.get());
    if (!found.Converged()) {
      PrintSummary("random shape " + std::to_string(i) + " was not found to the tolerance", {},
                   false);
    }
    shapes.push_back(found.shape);
    table.row(i) = coordinates.transpose();
    names.push_back(std::to_string(i));
  }
  for (const std::string& output : outputs) {
    if (internal::FileExtension(output) == ".csv") {
      WritePoseTable(output, names, Columns(modes.NumModes()), table);
      Out() << "wrote " << output << '\n';
    } else {
      WriteFramesAndTell(output, shapes, FrameSoup(*modes.metric->connectivity, modes.appearance));
    }
  }
}

void WriteModesPage(const std::string& file, const ShapeModel& model, const std::string& source,
                    const Regression* regression) {
  WritePage(file, std::string(ViewerPage()),
            {PageOf(model, source, regression, SolveProgress({}).get())});
  Out() << "wrote " << file << '\n';
}

// `source` is the name of the .modes file, if there is one, for the command lines on the page.
void RegressScalars(const ShapeModel& model, const std::string& source,
                    const std::vector<std::string>& outputs) {
  CheckNothingIsOverwritten({FLAGS_scalars}, {{"output", outputs}});
  const PoseTable table = ReadPoseTable(FLAGS_scalars);
  const PoseModes& modes = model.Modes();
  PermutationOptions options;
  options.permutations = FLAGS_permutations;
  options.seed = FLAGS_seed;
  Regression regression;
  NamingFlags({}, [&] {
    regression = Regress(modes, table.columns, table.NumbersOf(modes.names), options);
  });
  Out() << regression.FullReport();
  WriteReport(regression.FullReport(), regression.ToJson());
  if (!IsGiven("predict")) {
    for (const std::string& output : outputs) WriteModesPage(output, model, source, &regression);
    return;
  }
  const std::vector<double> values = NumbersFromFlag("predict", FLAGS_predict);
  Eigen::VectorXd coordinates;
  NamingFlags({{"values", "predict"}}, [&] {
    coordinates =
        regression.CoordinatesAt(Eigen::Map<const Eigen::VectorXd>(values.data(), values.size()));
  });
  for (size_t s = 0; s < values.size(); ++s) {
    if (values[s] >= regression.least(s) && values[s] <= regression.most(s)) continue;
    Warn(regression.scalars[s], " = ", values[s], " is outside of the poses' range, ",
         regression.least(s), " to ", regression.most(s));
  }
  WriteShapeAt(model, coordinates, outputs);
}

void CompareLabels(const PoseModes& modes) {
  const PoseTable table = ReadPoseTable(FLAGS_groups);
  GroupOptions options;
  options.permutation.permutations = FLAGS_permutations;
  options.permutation.seed = FLAGS_seed;
  std::vector<GroupDifference> differences;
  NamingFlags({{"labels", "groups"}},
              [&] { differences = CompareGroups(modes, table.LabelsOf(modes.names), options); });
  Out() << ReportOf(differences);
  WriteReport(ReportOf(differences), JsonTextOf(differences));
}

void AssessModel(const PoseModes& modes) {
  AssessmentOptions options;
  options.model.average.geodesic.metric = modes.metric->options;
  options.model.average.weights.assign(modes.weights.begin(), modes.weights.end());
  options.model.modes = modes.NumModes();
  options.fit = FLAGS_fit;
  options.seed = FLAGS_seed;
  std::vector<Shape> poses;
  for (const Shape& pose : modes.poses) poses.push_back(modes.metric->unit * pose);
  const Assessment assessment =
      AssessShapeModel(modes.metric->connectivity, poses, options, SolveProgress({}).get());
  if (assessment.unconverged > 0) {
    PrintSummary(std::to_string(assessment.unconverged) + " shapes were not found to the tolerance",
                 {}, false);
  }
  Out() << assessment.FullReport();
  WriteReport(assessment.FullReport(), assessment.ToJson());
}

// The motion along a mode, from -2 to 2 standard deviations.
Path AlongMode(const ShapeModel& model, int mode, Progress* progress) {
  constexpr int kSteps = 16;
  const PoseModes& modes = model.Modes();
  Path path;
  path.metric = modes.metric;
  path.appearance = modes.appearance;
  path.provenance = modes.provenance;
  for (int i = 0; i <= kSteps; ++i) {
    Eigen::VectorXd coordinates = Eigen::VectorXd::Zero(mode + 1);
    coordinates(mode) = -2 + 4.0 * i / kSteps;
    const Shape own = model.At(coordinates, progress).shape / modes.metric->unit;
    path.shapes.push_back(FitRigidMotion(own, modes.mean, modes.metric->vertex_area)(own));
    path.parameters.push_back(static_cast<double>(i) / kSteps);
    path.motions.push_back(modes.place);
  }
  path.poses = {0, kSteps};
  return path;
}

// The mean, and the shape of each mode one standard deviation from it.
std::vector<Shape> MeanAndModes(const ShapeModel& model) {
  SolveProgress progress({});
  std::vector<Shape> shapes = {model.At(Eigen::VectorXd(), progress.get()).shape};
  for (int k = 0; k < model.Modes().NumModes(); ++k) {
    shapes.push_back(model.At(Eigen::VectorXd::Unit(k + 1, k), progress.get()).shape);
  }
  return shapes;
}

void WriteModesOutputs(const ShapeModel& model, const std::string& source,
                       const std::vector<std::string>& outputs) {
  const PoseModes& modes = model.Modes();
  for (const std::string& output : outputs) {
    const std::string extension = internal::FileExtension(output);
    if (extension == ".modes") {
      WriteModes(output, modes);
    } else if (extension == ".csv") {
      WritePoseTable(output, modes.names, Columns(modes.NumModes()), modes.Coordinates());
    } else if (IsPointCache(output)) {
      WritePointCache(output, MeanAndModes(model));
    } else if (modes.NumModes() == 0) {
      Complain(output + ": there are no modes to show");
      continue;
    } else if (extension == ".png") {
      WritePng(output, RenderModes(model, modes.NumModes(), {}, SolveProgress({}).get()));
    } else if (extension == ".glb") {
      for (int k = 0; k < modes.NumModes(); ++k) {
        WritePathOutput(PathOutput::Of(FrameName(output, k + 1)),
                        AlongMode(model, k, SolveProgress({}).get()));
        Out() << "wrote " << FrameName(output, k + 1) << '\n';
      }
      continue;
    } else {
      WriteModesPage(output, model, source, nullptr);
      continue;
    }
    Out() << "wrote " << output << '\n';
  }
}

// The name of the .modes file, of the arguments or the outputs.
std::string SourceOf(const std::vector<std::string>& files,
                     const std::vector<std::string>& outputs) {
  for (const std::vector<std::string>* names : {&outputs, &files}) {
    for (const std::string& name : *names) {
      if (internal::FileExtension(name) == ".modes") return name;
    }
  }
  return "";
}

void Run(const std::vector<std::string>& files) {
  if (files.empty()) throw UsageError("name poses of one mesh, or a .modes file");
  const std::string question = Question();
  const std::vector<std::string> outputs = Outputs(question);
  CheckNothingIsOverwritten(WithStiffeners(files),
                            {{"output", outputs, std::max(FLAGS_sample, 1)}, ReportFromFlag()});
  const ShapeModel model(ModesOf(files));
  const std::string source = SourceOf(files, outputs);
  if (question == "coordinates") {
    PrintCoordinates(model, outputs);
  } else if (question == "at") {
    const std::vector<double> values = NumbersFromFlag("at", FLAGS_at);
    NamingFlags({{"coordinates", "at"}}, [&] {
      WriteShapeAt(model, Eigen::Map<const Eigen::VectorXd>(values.data(), values.size()), outputs);
    });
  } else if (question == "sample") {
    WriteSamples(model, outputs);
  } else if (question == "scalars") {
    RegressScalars(model, source, outputs);
  } else if (question == "groups") {
    CompareLabels(model.Modes());
  } else if (question == "assess") {
    AssessModel(model.Modes());
  } else {
    WriteModesOutputs(model, source, outputs);
  }
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  return RunTool(
      argc, argv,
      {"shape-statistics",
       "the mean and the modes of poses, and how shapes depend on scalars and groups",
       R"(  shape-statistics *.obj --modes 6 --output herd.modes,modes.png,mode%d.glb,herd.html
  shape-statistics herd.modes --coordinates new.obj --fit --output new.csv
  shape-statistics herd.modes --at 1.5,-.5 --output shape.obj
  shape-statistics herd.modes --sample 20 --seed 1 --output 's%02d.obj'
  shape-statistics herd.modes --scalars ages.csv --predict 40 --output forty.obj
  shape-statistics herd.modes --groups groups.csv
  shape-statistics herd.modes --assess

Coordinates are in standard deviations of the modes. A .csv has the names of the poses' files in its
first column and the names of the columns in its first line, as R and pandas write it. With several
scalars, each is controlled for the others. A .modes file contains the poses.)",
       {"model", "report", "summary", "metric", "poses", "mesh", "memory", "outside_files"}},
      Run);
}
