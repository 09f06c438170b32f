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

  /// Expects that these arguments after two poses are refused.
  void ExpectWrongCommandLine(const Strings& more, const Strings& parts) const {
    Strings arguments = {"tube0.obj", "tube1.obj"};
    arguments.insert(arguments.end(), more.begin(), more.end());
    SCOPED_TRACE(::testing::PrintToString(more));
    ExpectRefusal(2, arguments, parts);
  }

  /// Expects that the mesh `content` in a file `name` is rejected as second pose, or alone.
  void ExpectBadFile(const std::string& name, const std::string& content,
                     const Strings& parts) const {
    SCOPED_TRACE(name);
    File(name, content);
    ExpectRefusal(1, {name, name, "--output", "w.path,w.png,f/%d.obj"}, parts);
  }
};

// Flags with values that they cannot have: the message names both.
TEST_F(RefusalTest, WrongValues) {
  MakeTubes();
  const Strings cases[] = {
      {"--shapes", "many"},
      {"--shapes", "1.5"},
      {"--shapes", "0"},
      {"--tolerance=small"},
      {"--tolerance", "2"},
      {"--strict=perhaps"},
      {"--lambda=-1"},
      {"--lambda", "nan"},
      {"--metric", "taxicab"},
      {"--weighting", "heavy"},
      {"--discretization", "fine"},
      {"--discretization", "trapezoid"},
      {"--solver", "magic"},
      {"--color", "pink"},
      {"--threads=-1"},
      {"--memory_limit", "0"},
      {"--report", "r.html"},
      {"--output", "w.path,z%d.glb"},
      {"--output", "z%03d.GLB"},
      {"--output", "%d/w.path"},
      {"--seconds", "0"},
      {"--seconds", "1e-9"},
      {"--unit", "nan"},
      {"--unit", "1", "--unit=0"},
      {"--fps", "0"},
      {"--fps=-24"},
      {"--title", std::string(200, 'x')},
      {"--coarsest", "3"},
      {"--max_iterations", "0"},
      {"tube0.obj", "--spline", "wavy"},
      {"tube0.obj", "--spline", "natural", "--times", "0,2,1"},
      {"tube0.obj", "--spline", "natural", "--times", "0,2"},
      {"tube0.obj", "--spline", "natural", "--hold_limit=-1"},
  };
  for (const Strings& flags : cases) {
    const std::string& last = flags.back();
    const size_t equals = last.find('=');
    std::string flag = equals == last.npos ? flags[flags.size() - 2] : last.substr(0, equals);
    std::string value = equals == last.npos ? last : last.substr(equals + 1);
    // Of several outputs the wrong one is named, and of a long value the beginning.
    value = value.substr(value.rfind(flag == "--output" ? ',' : '\0') + 1).substr(0, 10);
    ExpectWrongCommandLine(flags, {flag + " " + value});
  }
}

TEST_F(RefusalTest, FlagsThatDoNotExist) {
  MakeTubes();
  for (const char* flag : {"--spoon", "--spoon=3", "--noshapes", "---shapes=3", "--helpxml",
                           "--flagfile=tube0.obj", "--logtostderr"}) {
    const std::string name = flag;
    ExpectWrongCommandLine({flag}, {name.substr(0, name.find('=')) + ": "});
  }
}

// What is missing, or cannot be together, is named.
TEST_F(RefusalTest, WrongCommandLines) {
  MakeTubes();
  const struct {
    Strings arguments, parts;
  } cases[] = {
      {{"--shapes"}, {"--shapes: "}},
      {{"--spline", "-o", "p.path"}, {"--spline: ", " -o"}},
      {{"--metric", "--shapes", "3"}, {"--metric: ", " --shapes"}},
      {{"--discretization", "trapezoid"}, {"--metric isometric"}},
      {{"--strain", "0", "--lambda", "0"}, {"--isometric, --strain 0, --rigid, --lambda 0"}},
      {{"--output", "walk.tif"}, {"walk.tif: ", ".path", ".vtp"}},
      {{"--output", ","}, {"--output: "}},
      {{"--output", "frame.obj"}, {"frame.obj: "}},
      {{"--output", "%d%d.obj"}, {"%d%d.obj: "}},
      {{"--output", "w.path,%s.ply"}, {"%s.ply: "}},
      {{"--fps", "24", "--seconds", "3"}, {"--seconds and --fps"}},
      {{"--loop", "--once"}, {"--loop and --once"}},
      {{"--times", "0,1"}, {"--times: ", "--spline"}},
      {{"--hold_limit", "2"}, {"--hold_limit: ", "--spline"}},
      {{"--via", "tube0.obj"}, {"--via ", "--avoid_contact"}},
      {{"tube0.obj", "--avoid_contact", "--via", "tube0.obj"}, {"--via ", "two poses"}},
      {{"--obstacle", "tube0.obj"}, {"--obstacle ", "--avoid_contact"}},
      {{"--avoid_contact", "--obstacle", "tube0.obj", "--ground", "y=0"},
       {"--ground ", "--obstacle"}},
      {{"tube0.obj", "--spline", "natural", "--times", "0,2"}, {"must be 3", "not 2"}},
      {{"tube0.obj", "--spline", "natural", "--times", "0,soon"}, {"'soon'"}},
      {{"tube0.obj", "--anchor", R"([{"select": {"vertices": [1]}, "poses": [1, 4]}])"},
       {"part 1: ", "3 poses"}},
  };
  for (const auto& [arguments, parts] : cases) ExpectWrongCommandLine(arguments, parts);
  ExpectRefusal(2, {"tube0.obj"}, {"two poses"});
  ExpectRefusal(2, {}, {"two poses"});
}

TEST_F(RefusalTest, StiffnessThatDoesNotFit) {
  MakeTubes();
  const auto refuse = [&](const std::string& content, const std::string& message) {
    File("stiff.txt", content);
    ExpectRefusal(1, {"tube0.obj", "tube1.obj", "--stiffness", "stiff.txt", "--output", "w.path"},
                  {message});
  };
  refuse("1\n2\n", "stiff.txt: has 2 ");
  refuse("1\n0\n", "stiff.txt: the stiffness of vertex 2 ");
  refuse("1\nhard\n", "stiff.txt:2: vertex 2");
  ExpectRefusal(1, {"tube0.obj", "tube1.obj", "--stiffness", "none.txt"}, {"none.txt"});
}

TEST_F(RefusalTest, FilesThatCannotBeRead) {
  ExpectRefusal(1, {"none.obj", "none.obj"}, {"none.obj: "});
  ExpectRefusal(1, {".", "."}, {".: ", ".obj, .ply, .off"});
  ExpectBadFile("empty.obj", "", {"empty.obj: "});
  ExpectBadFile("mesh.dae", "<xml>\n", {"mesh.dae: ", "'.dae'", ".obj"});
  ExpectBadFile("cut.obj", "v 0 0 0\nv 1 0 0\nv 0 1\n", {"cut.obj:3: vertex 3: coordinate z "});
  ExpectBadFile("cut.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n", {"cut.off:4: "});
  ExpectBadFile("cut.ply",
                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
                "property float z\nelement face 1\nproperty list uchar int vertex_indices\n"
                "end_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n",
                {"cut.ply:13: polygon 1"});
  const Soup cube = testing::Cube();
  WriteMesh(Path("whole.ply"), cube.vertices, cube);
  const std::string whole = testing::Content(Path("whole.ply"));
  ExpectBadFile("half.ply", whole.substr(0, whole.size() / 2), {"half.ply: ", "vertex"});
  ExpectBadFile("nan.obj", "v 0 0 0\nv 1 nan 0\nv 0 1 0\nf 1 2 3\n",
                {"nan.obj:2: vertex 2: coordinate y 'nan'"});
  ExpectBadFile("letters.obj", "v 0 0 0\nv 1 0 0\nv 0 1 zero\nf 1 2 3\n",
                {"letters.obj:3: vertex 3: coordinate z 'zero'"});
  ExpectBadFile("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 1 2 9\n",
                {"index.obj:5: polygon 2: vertex 9 ", " 3"});
  ExpectBadFile("index.off", "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3\n",
                {"index.off:6: polygon 1: "});
}

TEST_F(RefusalTest, MeshesThatCannotServe) {
  ExpectBadFile("points.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\n",
                {"points.obj: ", "polygons", "segments"});
  ExpectBadFile("loop.obj", "v 0 0 0\nv 1 0 0\nl 1 2\nl 2 2\n",
                {"loop.obj: ", "(1): segment 2 (line 4)"});
  ExpectBadFile("flat.obj", "v 1 1 1\nv 1 1 1\nv 1 1 1\nf 1 2 3\n", {"extent"});
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
  ExpectContains(outcome.err, "warning: a.obj: ");
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
       {"polygon 4 (line 8) with vertices 2 3 4", "polygon 4 (line 8) with 3 1 4"}},
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
                {"vertex 1 is number 2 here", "'keep vertex order'"});
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
  ExpectContains(outcome.err, "warning: shuffled.obj against tube0.obj: ");
}

TEST_F(RefusalTest, StiffenerFiles) {
  MakeTubes();
  const struct {
    const char *content, *message;
  } cases[] = {
      {"1 2\n1 999\n", "stiff.txt:2: stiffener 2: '999'"},
      {"1 2 3\n", "stiff.txt:1: stiffener 1: '3'"},
      {"7 7\n", "stiff.txt:1: stiffener 1: joins vertex 7 "},
  };
  for (const auto& [content, message] : cases) {
    File("stiff.txt", content);
    ExpectRefusal(1, {"tube0.obj", "tube1.obj", "--stiffeners", "stiff.txt", "--output", "w.path"},
                  {message});
  }
  ExpectRefusal(1, {"tube0.obj", "tube1.obj", "--stiffeners", "none.txt", "--output", "w.path"},
                {"none.txt: "});
}

TEST_F(RefusalTest, MetricsThatTheMeshCannotHave) {
  Succeed("shape-body", {"sheet", "--triangles", "100", "--output", "sheet%d.obj"});
  ExpectRefusal(2, {"sheet0.obj", "sheet1.obj", "--volume", "1", "--output", "w.path"},
                {"--volume 1: "});
}

TEST_F(RefusalTest, BendingOfWhatCannotBend) {
  File("a.obj", "v 0 0 0\nv 1 0 0\nv 2 0 0\nv 2 1 0\nl 1 2\nl 3 4\n");
  File("b.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 1 2 0\nl 1 2\nl 3 4\n");
  ExpectRefusal(2, {"a.obj", "b.obj", "--bending", "1e-3", "--output", "w.path"},
                {"--bending 1e-3: "});
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
                {"flipped.obj against tube0.obj: ", "(--mirror)"});
  ExpectRefusal(2, {"tube0.obj", "flipped.obj", "--mirror", "up", "--output", "w.path"},
                {"--mirror up: "});
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

TEST_F(RefusalTest, PosesInOtherUnits) {
  MakeTubes();
  const Soup soup = ReadSoup(Path("tube1.obj"));
  WriteMesh(Path("inches.obj"), 39.37 * soup.vertices, soup);
  const Strings pair = {"tube0.obj", "inches.obj"},
                allowed = {"tube0.obj", "inches.obj", "--allow_mismatch"};
  const Outcome refused = Run("shape-interpolate", pair);
  EXPECT_EQ(refused.code, 1);
  ExpectContains(refused.err, "--allow_mismatch");
  EXPECT_EQ(Run("shape-inspect", pair).code, 1);
  EXPECT_EQ(Run("shape-inspect", allowed).code, 0);
  Strings solve = allowed;
  solve.insert(solve.end(), {"--shapes", "1", "--output", "grown.path"});
  EXPECT_EQ(Run("shape-interpolate", solve).code, 0);
}

TEST_F(RefusalTest, SolvesBeyondTheMemoryLimit) {
  MakeTubes();
  ExpectRefusal(1, {"tube0.obj", "tube1.obj", "--memory_limit", "0.001", "--output", "w.path"},
                {" MB", "memory limit"});
  Succeed("shape-interpolate", {"tube0.obj", "tube1.obj", "--output", "w.path"});
  for (const char* method : {"features", "ladder"}) {
    const Strings transfer = {"w.path",   "--target", "tube0.obj",      "--output", "t.path",
                              "--method", method,     "--memory_limit", "0.001"};
    const Outcome outcome = Run("shape-transfer", transfer);
    EXPECT_EQ(outcome.code, 1);
    ExpectContains(outcome.err, "this transfer ");
  }
  File("markers.txt", "1 1\n70 70\n150 150\n");
  const Outcome fit = Run("shape-correspond", {"tube0.obj", "tube0.obj", "--markers", "markers.txt",
                                               "--memory_limit", "0.001", "--output", "m.txt"});
  EXPECT_EQ(fit.code, 1);
  ExpectContains(fit.err, "this fit ");
}

TEST_F(RefusalTest, OutputsThatCannotBeWrittenAreFoundBeforeAnythingIs) {
  MakeTubes();
  ExpectRefusal(1, {"tube0.obj", "tube1.obj", "--output", "w.path,tube0.obj/frames/%d.obj"},
                {"tube0.obj/frames/%d.obj: ", "tube0.obj is not a folder"});
  ExpectRefusal(1, {"tube0.obj", "tube1.obj", "--output", "w.path", "--report", "tube0.obj/r.txt"},
                {"tube0.obj/r.txt: "});
}

}  // namespace
}  // namespace shapespace
