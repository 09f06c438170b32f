#include <algorithm>
#include <numeric>
#include <random>

#include <shapespace/files/read.h>
#include <shapespace/files/write.h>

#include "mesh/bodies.h"
#include "tools/run.h"

namespace shapespace {
namespace {

using testing::ExpectContains;
using testing::Outcome;
using testing::ToolsTest;

using Strings = std::vector<std::string>;

constexpr char kTetrahedron[] =
    "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n"
    "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";

class RefusalTest : public ToolsTest {
 protected:
  /// Expects that the run fails with `code` and these words, and leaves no file behind.
  void ExpectRefusal(int code, Strings arguments, const Strings& parts) const {
    const Strings before = Files();
    const Outcome outcome = Run("shape-interpolate", arguments);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    ExpectContains("\n" + outcome.err, "\nshape-interpolate: ");
    for (const std::string& part : parts) ExpectContains(outcome.err, part);
    if (code == 2) ExpectContains(outcome.err, "--help");
    EXPECT_EQ(Files(), before) << outcome.err;
  }

  /// Expects that the mesh `content` in a file `name` is rejected as second pose, or alone.
  void ExpectBadFile(const std::string& name, const std::string& content,
                     const Strings& parts) const {
    SCOPED_TRACE(name);
    File(name, content);
    ExpectRefusal(1, {name, name, "--output", "w.path,w.png,f/%d.obj"}, parts);
  }
};

TEST_F(RefusalTest, WrongCommandLines) {
  MakeTubes();
  const struct {
    Strings arguments;
    const char* message;
  } cases[] = {
      {{"--spoon"}, "--spoon: there is no such flag"},
      {{"--spoon=3"}, "--spoon: there is no such flag"},
      {{"--noshapes"}, "--noshapes: there is no such flag"},
      {{"---shapes=3"}, "---shapes: there is no such flag"},
      {{"--helpxml"}, "--helpxml: there is no such flag"},
      {{"--flagfile=tube0.obj"}, "--flagfile: there is no such flag"},
      {{"--logtostderr"}, "--logtostderr: there is no such flag"},
      {{"--shapes", "many"}, "--shapes many: must be an integer"},
      {{"--shapes", "1.5"}, "--shapes 1.5: must be an integer"},
      {{"--tolerance=small"}, "--tolerance small: must be a number"},
      {{"--strict=perhaps"}, "--strict perhaps: must be true or false"},
      {{"--shapes", "0"}, "--shapes 0: must be 1 or more"},
      {{"--shapes"}, "--shapes: its value is missing"},
      {{"--spline", "-o", "p.path"}, "--spline: its value is missing before -o"},
      {{"--metric", "--shapes", "3"}, "--metric: its value is missing before --shapes"},
      {{"--tolerance", "2"}, "--tolerance 2: must be between 0 and 1"},
      {{"--lambda=-1"}, "--lambda -1: must be a number, zero or more"},
      {{"--lambda", "nan"}, "--lambda nan: must be a number, zero or more"},
      {{"--metric", "taxicab"}, "--metric taxicab: must be strain, isometric, rigid or paper"},
      {{"--weighting", "heavy"}, "--weighting heavy: must be one of area, uniform"},
      {{"--discretization", "fine"}, "--discretization fine: must be one of midpoint, trapezoid"},
      {{"--discretization", "trapezoid"},
       "--discretization trapezoid: is a form of the cost of edge lengths, which this metric has "
       "not; add --metric isometric"},
      {{"--solver", "magic"},
       "--solver magic: must be one of automatic, lbfgs, threaded_lbfgs, trust_region"},
      {{"--color", "pink"}, "--color pink: must be one of plain, deviation, parts"},
      {{"--threads=-1"}, "--threads -1: must be 0 (all cores) to 256"},
      {{"--memory_limit", "0"}, "--memory_limit 0: must be positive"},
      {{"--strain", "0", "--lambda", "0"},
       "--isometric, --strain 0, --rigid, --lambda 0: all zero"},
      {{"--output", "walk.gif"},
       "walk.gif: must end in .path, .png, .glb, .usda, .html, .pc2, .mdd, .obj, .ply, .off, .stl "
       "or "
       ".vtp"},
      {{"--output", ","}, "--output: names no file"},
      {{"--output", "frame.obj"}, "frame.obj: a name for frames needs one number"},
      {{"--output", "%d%d.obj"}, "needs one number"},
      {{"--output", "w.path,%s.ply"}, "%s.ply: a name for frames needs one number"},
      {{"--report", "r.html"}, "--report r.html: must end in .json or .txt, or be -"},
      {{"--output", "w.path,z%d.png"}, "--output z%d.png: only meshes and .vtp are numbered"},
      {{"--output", "z%03d.GLB"}, "--output z%03d.GLB: only meshes"},
      {{"--output", "%d/w.path"}, "--output %d/w.path: only meshes"},
      {{"--seconds", "0"}, "--seconds 0: must be from 0.1 to 3600"},
      {{"--seconds", "1e-9"}, "--seconds 1e-9: must be"},
      {{"--unit", "nan"}, "--unit nan: must be from 1e-12 to 1e+12"},
      {{"--unit", "1", "--unit=0"}, "--unit 0: must be"},
      {{"--fps", "0"}, "--fps 0: must be positive"},
      {{"--fps=-24"}, "--fps -24: must be from 0.01 to 1000"},
      {{"--fps", "24", "--seconds", "3"}, "--seconds and --fps exclude each other"},
      {{"--loop", "--once"}, "--loop and --once exclude each other"},
      {{"--title", std::string(200, 'x')}, "--title xxx"},
      {{"--coarsest", "3"}, "--coarsest 3: must be 4 triangles or more"},
      {{"--max_iterations", "0"}, "--max_iterations 0: must be 1 or more"},
  };
  for (const auto& [flags, message] : cases) {
    SCOPED_TRACE(message);
    Strings arguments = {"tube0.obj", "tube1.obj"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    ExpectRefusal(2, arguments, {message});
  }
  ExpectRefusal(2, {"tube0.obj", "tube1.obj", "--times", "0,1"}, {"--times: goes with --spline"});
  ExpectRefusal(2, {"tube0.obj", "tube1.obj", "--via", "tube0.obj"},
                {"--via goes with --avoid_contact"});
  ExpectRefusal(2, {"tube0.obj", "tube1.obj", "tube0.obj", "--avoid_contact", "--via", "tube0.obj"},
                {"--via goes with two poses"});
  ExpectRefusal(2, {"tube0.obj", "tube1.obj", "--obstacle", "tube0.obj"},
                {"--obstacle goes with --avoid_contact"});
  ExpectRefusal(
      2,
      {"tube0.obj", "tube1.obj", "--avoid_contact", "--obstacle", "tube0.obj", "--ground", "y=0"},
      {"--ground moves the path, which --obstacle needs where the poses are"});
  ExpectRefusal(2, {"tube0.obj", "tube1.obj", "--hold_limit", "2"},
                {"--hold_limit: goes with --spline"});
  const auto refuse_spline = [&](Strings flags, const char* message) {
    flags.insert(flags.begin(), {"tube0.obj", "tube1.obj", "tube0.obj"});
    ExpectRefusal(2, flags, {message});
  };
  refuse_spline({"--spline", "wavy"},
                "--spline wavy: must be one of natural, clamped, not_a_knot, periodic");
  refuse_spline({"--spline", "natural", "--times", "0,2,1"}, "--times 0,2,1: must be finite");
  refuse_spline({"--spline", "natural", "--times", "0,2"},
                "--times 0,2: must be 3, one for each pose, not 2");
  refuse_spline({"--spline", "natural", "--times", "0,soon"}, "'soon' is not a number");
  refuse_spline({"--spline", "natural", "--hold_limit=-1"}, "--hold_limit -1: must be");
  refuse_spline({"--anchor", R"([{"select": {"vertices": [1]}, "poses": [1, 4]}])"},
                "part 1: its intervals of poses must ascend, and there are 3 poses");
  ExpectRefusal(2, {"tube0.obj"}, {"name at least two poses"});
  ExpectRefusal(2, {}, {"name at least two poses"});
}

TEST_F(RefusalTest, StiffnessThatDoesNotFit) {
  MakeTubes();
  const auto refuse = [&](const std::string& content, const std::string& message) {
    File("stiff.txt", content);
    ExpectRefusal(1, {"tube0.obj", "tube1.obj", "--stiffness", "stiff.txt", "--output", "w.path"},
                  {message});
  };
  refuse("1\n2\n", "stiff.txt: has 2 numbers, the mesh has ");
  refuse("1\n0\n", "stiff.txt: the stiffness of vertex 2 is not positive");
  refuse("1\nhard\n", "stiff.txt:2: vertex 2");
  ExpectRefusal(1, {"tube0.obj", "tube1.obj", "--stiffness", "none.txt"}, {"none.txt"});
}

TEST_F(RefusalTest, FilesThatCannotBeRead) {
  ExpectRefusal(1, {"none.obj", "none.obj"}, {"none.obj: cannot be opened"});
  ExpectRefusal(1, {".", "."}, {"not one of .obj, .ply, .off"});
  ExpectBadFile("empty.obj", "", {"empty.obj: is empty"});
  ExpectBadFile("mesh.dae", "<xml>\n", {"mesh.dae: the extension '.dae' is not one of .obj"});
  ExpectBadFile("cut.obj", "v 0 0 0\nv 1 0 0\nv 0 1\n",
                {"cut.obj:3: vertex 3: coordinate z is missing"});
  ExpectBadFile("cut.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n", {"cut.off:4: the file ends before"});
  ExpectBadFile("cut.ply",
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n",
                {"cut.ply:13: polygon 1", "missing"});
  const Soup cube = testing::Cube();
  WriteMesh(Path("whole.ply"), cube.vertices, cube);
  const std::string whole = testing::Content(Path("whole.ply"));
  ExpectBadFile("half.ply", whole.substr(0, whole.size() / 2), {"half.ply: ", "vertex"});
  ExpectBadFile("nan.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n",
                {"nan.obj:2: vertex 2: coordinate y 'nan' is not a finite number"});
  ExpectBadFile("letters.obj", "v 0 0 0\nv 1 0 0\nv 0 1 zero\nf 1 2 3\n",
                {"letters.obj:3: vertex 3: coordinate z 'zero' is not a number"});
  ExpectBadFile("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 9\n",
                {"index.obj:5: polygon 2: vertex 9 does not exist, the file has 3"});
  ExpectBadFile("index.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
                {"index.off:6: polygon 1: "});
}

TEST_F(RefusalTest, MeshesThatCannotServe) {
  ExpectBadFile("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n",
                {"points.obj: holds no polygons and no segments"});
  ExpectBadFile("loop.obj", "v 0 0 0\nv 1 0 0\nl 1 2\nl 2 2\n",
                {"loop.obj: segments that join a vertex to itself (1): segment 2 (line 4)"});
  ExpectBadFile("flat.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", {"the mesh has no extent"});
  const struct {
    const char *name, *more, *message;
  } non_manifold[] = {
      {"repeated.obj", "f 2 1 3\n", "polygon 5 (line 9) repeats polygon 1 (line 5)"},
      {"degenerate.obj", "f 1 1 2\n", "polygon 5 (line 9)"},
      {"fan.obj", "v 2 2 2\nf 1 2 5\n", "edge 1-2 of polygon 1 (line 5), polygon 2 (line 6) and"},
      {"touching.obj", "v 5 5 5\nv 6 5 5\nf 1 5 6\n", "vertex 1 (line 1)"},
  };
  for (const auto& [name, more, message] : non_manifold) {
    ExpectBadFile(name, std::string(kTetrahedron) + more,
                  {std::string(name) + ": ", message, "--allow_nonmanifold"});
  }
  ExpectBadFile("wound.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nf 1 2 3\nf 2 3 4\n",
                {"wound.obj: ", "edge 2-3 of polygon 1 (line 5) and polygon 2 (line 6)",
                 "--allow_nonmanifold"});
}

TEST_F(RefusalTest, NonManifoldMeshesServeIfAllowed) {
  File("a.obj", std::string(kTetrahedron) + "v 2 2 2\nf 1 2 5\n");
  std::string other = testing::Content(Path("a.obj"));
  other.replace(other.find("v 2 2 2"), 7, "v 2 2 3");
  File("b.obj", other);
  const Outcome outcome = Run("shape-interpolate", {"a.obj", "b.obj", "--allow_nonmanifold",
                                                    "--shapes", "3", "--output", "w.path,%d.obj"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(outcome.err, "warning: a.obj: edges with more than two polygons");
  EXPECT_EQ(ReadSoup(Path("4.obj")).corners, ReadSoup(Path("a.obj")).corners);
}

TEST_F(RefusalTest, PosesOfDifferentMeshes) {
  File("a.obj", kTetrahedron);
  const struct {
    const char* content;
    Strings parts;
  } cases[] = {
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 3 2\n",
       {"b.obj against a.obj: 3 vertices instead of 4", "1 polygons instead of 4"}},
      {"v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 2 3 4\n",
       {"polygon 4 (line 8) with vertices 2 3 4", "the reference has polygon 4 (line 8) with 3 1 4",
        "different meshes"}},
  };
  for (const auto& [content, parts] : cases) {
    File("b.obj", content);
    ExpectRefusal(1, {"a.obj", "b.obj", "--output", "w.path"}, parts);
  }
}

TEST_F(RefusalTest, PosesWhoseVerticesWereReordered) {
  // A strip of three triangles, and the same with its first two vertices exchanged.
  File("a.obj", "v 0 0 0\nv 0 1 0\nv 1 0 0\nv 1 1 0\nv 2 0 0\nf 1 3 2\nf 2 3 4\nf 3 5 4\n");
  File("b.obj", "v 0 1 0\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 2 0 0\nf 2 3 1\nf 1 3 4\nf 3 5 4\n");
  ExpectRefusal(1, {"a.obj", "b.obj", "--output", "w.path"},
                {"but the vertices are not (the reference's vertex 1 is number 2 here)",
                 "'keep vertex order'"});
}

TEST_F(RefusalTest, SuspiciousPosesAreUsedWithAWarning) {
  // Vertices at one end in a wrong order: all counts and faces agree.
  MakeTubes(4000);
  const Soup soup = ReadSoup(Path("tube1.obj"));
  std::vector<int> order(soup.NumVertices());
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin(), order.begin() + 500, std::mt19937(1));
  Shape shuffled = soup.vertices;
  for (int v = 0; v < soup.NumVertices(); ++v) shuffled.col(v) = soup.vertices.col(order[v]);
  WriteMesh(Path("shuffled.obj"), shuffled, soup);
  const Outcome outcome = Run("shape-interpolate",
                              {"tube0.obj", "shuffled.obj", "--shapes", "1", "--output", "w.path"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(outcome.err, "warning: shuffled.obj against tube0.obj: vertices whose edges");
}

TEST_F(RefusalTest, StiffenerFiles) {
  MakeTubes();
  const struct {
    const char *content, *message;
  } cases[] = {
      {"1 2\n1 999\n", "stiff.txt:2: stiffener 2: '999' is not a vertex number from 1 to 152"},
      {"1 2 3\n", "stiff.txt:1: stiffener 1: '3' is too much"},
      {"7 7\n", "stiff.txt:1: stiffener 1: joins vertex 7 to itself"},
  };
  for (const auto& [content, message] : cases) {
    File("stiff.txt", content);
    ExpectRefusal(1, {"tube0.obj", "tube1.obj", "--stiffeners", "stiff.txt", "--output", "w.path"},
                  {message});
  }
  ExpectRefusal(1, {"tube0.obj", "tube1.obj", "--stiffeners", "none.txt", "--output", "w.path"},
                {"none.txt: cannot be opened"});
}

TEST_F(RefusalTest, MetricsThatTheMeshCannotHave) {
  Succeed("shape-body", {"sheet", "--triangles", "100", "--output", "sheet%d.obj"});
  ExpectRefusal(2, {"sheet0.obj", "sheet1.obj", "--volume", "1", "--output", "w.path"},
                {"--volume 1: the mesh is not closed"});
}

TEST_F(RefusalTest, BendingOfWhatCannotBend) {
  File("a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 1 0\nl 1 2\nl 3 4\n");
  File("b.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 1 2 0\nl 1 2\nl 3 4\n");
  ExpectRefusal(2, {"a.obj", "b.obj", "--bending", "1e-3", "--output", "w.path"},
                {"--bending 1e-3: no two triangles of this mesh share an edge"});
  Succeed("shape-interpolate", {"a.obj", "b.obj", "--output", "w.path"});
  // Two segments that follow each other can bend.
  File("c.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nl 1 2 3\n");
  File("d.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nl 1 2 3\n");
  Succeed("shape-interpolate", {"c.obj", "d.obj", "--bending", "1e-3", "--output", "w.path"});
}

TEST_F(RefusalTest, MirrorImagesAreToldAndTurnedBackIfAsked) {
  MakeTubes();
  const Soup tube = ReadSoup(Path("tube1.obj"));
  Shape flipped = tube.vertices;
  flipped.row(2) *= -1;
  WriteMesh(Path("flipped.obj"), flipped, tube);
  ExpectRefusal(1, {"tube0.obj", "flipped.obj", "--output", "w.path"},
                {"flipped.obj against tube0.obj: the body is a mirror image", "(--mirror)"});
  ExpectRefusal(2, {"tube0.obj", "flipped.obj", "--mirror", "up", "--output", "w.path"},
                {"--mirror up: must be x, y or z"});
  const Outcome inspected = Run("shape-inspect", {"tube0.obj", "flipped.obj"});
  EXPECT_EQ(inspected.code, 1);
  ExpectContains(inspected.out, "mirror image");
  const Outcome turned = Run("shape-inspect", {"tube0.obj", "flipped.obj", "--mirror", "z"});
  EXPECT_EQ(turned.code, 0) << turned.err;
  ExpectContains(turned.out, "its z has changed sign");

  const Strings more = {"--shapes", "1", "--output"};
  const auto interpolate = [&](Strings arguments, const std::string& output) {
    arguments.insert(arguments.end(), more.begin(), more.end());
    arguments.push_back(output);
    return Run("shape-interpolate", arguments);
  };
  const Outcome mended =
      interpolate({"tube0.obj", "flipped.obj", "--mirror", "z"}, "mended.path,m%d.ply");
  EXPECT_EQ(mended.code, 0) << mended.err;
  ExpectContains(mended.err, "warning: flipped.obj: is a mirror image of tube0.obj");
  ASSERT_EQ(interpolate({"tube0.obj", "tube1.obj"}, "%d.ply").code, 0);
  for (int i = 0; i < 3; ++i) {
    const std::string frame = std::to_string(i) + ".ply";
    EXPECT_TRUE(ReadSoup(Path("m" + frame)).vertices == ReadSoup(Path(frame)).vertices) << i;
  }
  // The target of a transfer is checked in the same way.
  Strings transfer = {"mended.path", "--target", "flipped.obj", "--output", "t%d.ply"};
  EXPECT_EQ(Run("shape-transfer", transfer).code, 1);
  // What was turned over on purpose is taken as it is.
  const Outcome allowed =
      interpolate({"tube0.obj", "flipped.obj", "--allow_mirrored"}, "allowed.path");
  EXPECT_EQ(allowed.code, 0) << allowed.err;
  ExpectContains(allowed.err, "mirror image");
  EXPECT_EQ(Run("shape-inspect", {"tube0.obj", "flipped.obj", "--allow_mirrored"}).code, 0);
}

TEST_F(RefusalTest, SolvesBeyondTheMemoryLimit) {
  MakeTubes();
  ExpectRefusal(1, {"tube0.obj", "tube1.obj", "--memory_limit", "0.001", "--output", "w.path"},
                {"MB, more than the memory limit", "fewer shapes"});
  Succeed("shape-interpolate", {"tube0.obj", "tube1.obj", "--output", "w.path"});
  for (const char* method : {"features", "ladder"}) {
    const Strings transfer = {"w.path",   "--target", "tube0.obj",      "--output", "t.path",
                              "--method", method,     "--memory_limit", "0.001"};
    const Outcome outcome = Run("shape-transfer", transfer);
    EXPECT_EQ(outcome.code, 1);
    ExpectContains(outcome.err, "this transfer needs about ");
  }
  File("markers.txt", "1 1\n70 70\n150 150\n");
  const Outcome fit = Run("shape-correspond", {"tube0.obj", "tube0.obj", "--markers", "markers.txt",
                                               "--memory_limit", "0.001", "--output", "m.txt"});
  EXPECT_EQ(fit.code, 1);
  ExpectContains(fit.err, "this fit needs about ");
}

TEST_F(RefusalTest, OutputsThatCannotBeWrittenAreFoundBeforeAnythingIs) {
  MakeTubes();
  ExpectRefusal(1, {"tube0.obj", "tube1.obj", "--output", "w.path,tube0.obj/frames/%d.obj"},
                {"tube0.obj/frames/%d.obj: cannot be written: ", "tube0.obj is not a folder"});
  ExpectRefusal(1, {"tube0.obj", "tube1.obj", "--output", "w.path", "--report", "tube0.obj/r.txt"},
                {"tube0.obj/r.txt: cannot be written"});
}

}  // namespace
}  // namespace shapespace
