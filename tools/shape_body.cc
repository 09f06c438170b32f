// Writes poses of generated bodies.

#include <gflags/gflags.h>

#include <shapespace/base/internal/extension.h>
#include <shapespace/bodies/body.h>
#include <shapespace/bodies/quadruped.h>
#include <shapespace/bodies/skinned.h>
#include <shapespace/files/write.h>
#include <shapespace/output/frames.h>
#include <shapespace/statistics/pose_table.h>

#include "support/flag_group.h"
#include "support/frames.h"
#include "support/lists.h"
#include "support/tool.h"

DEFINE_int32(triangles, 0, "approximate number of triangles; 0: the body's default");
DEFINE_string(at, "", "parameter values, separated by commas; default: both ends of the range");
DEFINE_string(pose, "",
              "names of poses, separated by commas, of a body with bones; instead of --at");
DEFINE_string(proportions, "",
              "name of the proportions of a body with bones, for --pose and --random");
DEFINE_int32(random, 0, "number of quadrupeds of random proportions in random poses");
DEFINE_int32(seed, 1, "of --random; the same animals for the same seed");
DEFINE_string(table, "", "a .csv file with the proportions of the --random animals");
DEFINE_string(output, "body%d.obj",
              "one file per value, numbered from 0, or one without a number for one value: .obj, "
              ".ply, .off or .stl; or -: one shape to stdout, as PLY");
FLAG_GROUP(body, "Body", "at, output, pose, proportions, random, seed, triangles");

namespace shapespace::tools {
namespace {

std::string Join(const std::vector<std::string>& parts) {
  std::string list;
  for (const std::string& part : parts) list += (list.empty() ? "" : ", ") + part;
  return list;
}

// One shape needs no number in its name.
bool OutputIsOneFile() { return FLAGS_output.find('%') == std::string::npos; }

void CheckOutput() {
  if (!IsMeshOrStdout(FLAGS_output)) {
    throw UsageError("--output " + FLAGS_output +
                     ": must end in .obj, .ply, .off or .stl, or be -");
  }
  if (!OutputIsOneFile()) CheckFramePattern("output", FLAGS_output);
}

void CheckOutputIsFor(const std::vector<Shape>& shapes) {
  if (!OutputIsOneFile() || shapes.size() == 1) return;
  throw UsageError("--output " + FLAGS_output + ": is for one shape, and there are " +
                   std::to_string(shapes.size()) +
                   "; choose one by --at or --pose, or give a name for frames, such as "
                   "frames/%03d.obj");
}

void Write(const std::vector<Shape>& shapes, const Connectivity& connectivity) {
  const Soup soup = FrameSoup(connectivity);
  if (!OutputIsOneFile()) return WriteFramesAndTell(FLAGS_output, shapes, soup);
  WriteMeshAndTell(FLAGS_output, shapes[0], soup);
}

void List() {
  for (const BodyInfo& info : ListBodies()) {
    Out() << info.name << ": " << info.description << '\n';
  }
  for (const SkinnedBodyInfo& info : ListSkinnedBodies()) {
    Out() << "poses of " << info.name << ": " << Join(info.poses) << "\nproportions of "
          << info.name << ": " << Join(info.proportions) << '\n';
  }
}

void WritePoses(const std::string& name) {
  if (FLAGS_pose.empty()) throw UsageError("--proportions needs --pose or --random");
  if (!FLAGS_at.empty()) throw UsageError("--at and --pose exclude each other");
  const SkinnedBody body = MakeSkinnedBody(name, FLAGS_triangles, FLAGS_proportions);
  std::vector<Shape> shapes;
  for (const std::string& pose : Split(FLAGS_pose)) shapes.push_back(body.pose(pose));
  CheckOutputIsFor(shapes);
  Out() << body.name << ": " << body.connectivity->NumVertices() << " vertices, "
        << body.connectivity->NumTriangles() << " triangles; poses are " << Join(body.pose_names)
        << '\n';
  Write(shapes, *body.connectivity);
}

void WriteRandomAnimals(const std::string& name) {
  if (name != "quadruped") throw UsageError("--random is for quadruped alone");
  if (!FLAGS_pose.empty() || !FLAGS_at.empty()) {
    throw UsageError("--random excludes --at and --pose");
  }
  const QuadrupedForm form =
      FLAGS_proportions.empty() ? QuadrupedForm() : NamedQuadrupedForm(FLAGS_proportions);
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<Shape> shapes;
  Eigen::MatrixXd measures(FLAGS_random, form.Measures().size());
  for (int i = 0; i < FLAGS_random; ++i) {
    const unsigned seed = FLAGS_seed + i;
    const QuadrupedForm individual = RandomQuadrupedForm(form, seed);
    const SkinnedBody body = MakeQuadruped(FLAGS_triangles, individual);
    connectivity = body.connectivity;
    shapes.push_back(body.random_pose(seed));
    int column = 0;
    for (const auto& [measure, value] : individual.Measures()) measures(i, column++) = value;
  }
  CheckOutputIsFor(shapes);
  Write(shapes, *connectivity);
  if (FLAGS_table.empty()) return;
  std::vector<std::string> files, columns;
  for (int i = 0; i < FLAGS_random; ++i) {
    files.push_back(OutputIsOneFile() ? FLAGS_output : FrameName(FLAGS_output, i));
  }
  for (const auto& [measure, value] : form.Measures()) columns.push_back(measure);
  WritePoseTable(FLAGS_table, files, columns, measures);
  Out() << "wrote " << FLAGS_table << '\n';
}

void WriteValues(const std::string& name) {
  const ShapeFamily body = MakeBody(name, FLAGS_triangles);
  std::vector<Shape> shapes;
  std::vector<double> values = {body.begin, body.end};
  if (!FLAGS_at.empty()) values = NumbersFromFlag("at", FLAGS_at);
  for (double value : values) shapes.push_back(body.pose(value));
  CheckOutputIsFor(shapes);
  Out() << body.name << ": " << body.connectivity->NumVertices() << " vertices, "
        << body.connectivity->NumTriangles() << " triangles; " << body.parameter << " from "
        << body.begin << " to " << body.end << '\n';
  Write(shapes, *body.connectivity);
}

void Run(const std::vector<std::string>& arguments) {
  if (arguments.empty()) return List();
  if (arguments.size() > 1) throw UsageError("name one body");
  CheckOutput();
  if (FLAGS_random < 0) throw UsageError("--random must be at least 1");
  if (FLAGS_random == 0 && !FLAGS_table.empty()) throw UsageError("--table needs --random");
  if (!FLAGS_table.empty() && internal::FileExtension(FLAGS_table) != ".csv") {
    throw UsageError("--table " + FLAGS_table + ": must end in .csv");
  }
  NamingFlags({{"parameter", "at"}}, [&] {
    if (FLAGS_random > 0) {
      WriteRandomAnimals(arguments[0]);
    } else if (FLAGS_pose.empty() && FLAGS_proportions.empty()) {
      WriteValues(arguments[0]);
    } else {
      WritePoses(arguments[0]);
    }
  });
}

}  // namespace
}  // namespace shapespace::tools

int main(int argc, char** argv) {
  using namespace shapespace::tools;
  return RunTool(argc, argv,
                 {"shape-body",
                  "poses of generated bodies, for trying the other tools",
                  R"(  shape-body                                      lists the bodies
  shape-body tube --at 0,90 --output tube%d.obj   writes tube0.obj and tube1.obj
  shape-body quadruped --pose stand,sit --proportions long --output animal%d.obj
  shape-body quadruped --random 20 --output herd%02d.obj --table herd.csv)",
                  {"body"}},
                 Run);
}
