#include <cstdlib>
#include <regex>

#include <shapespace/files/read.h>

#include "tools/run.h"

namespace shapespace {
namespace {

using testing::Content;
using testing::ExpectContains;
using testing::Outcome;
using testing::ToolsTest;

// One mesh read from stdin, or written to stdout: "-".
class StreamsTest : public ToolsTest {
 protected:
  // Runs a line of a shell in the test's folder, with the tools on its path.
  Outcome Shell(const std::string& line) const {
    Outcome outcome;
    const std::string command = "cd '" + Path("") +
                                "' && PATH='" SHAPESPACE_TOOLS_DIR "':\"$PATH\" && { " + line +
                                "; } >.out 2>.err";
    outcome.code = WEXITSTATUS(std::system(command.c_str()));
    outcome.out = Content(Path(".out"));
    outcome.err = Content(Path(".err"));
    return outcome;
  }
};

TEST_F(StreamsTest, StdinIsReadInEveryFormat) {
  MakeTubes();
  const Outcome named = Shell("shape-inspect tube1.obj");
  ASSERT_EQ(named.code, 0) << named.err;
  const std::string expected = std::regex_replace(named.out, std::regex("tube1\\.obj"), "stdin");
  for (const std::string format : {"obj", "ply", "off"}) {
    Succeed("shape-body",
            {"tube", "--triangles", "300", "--at", "60", "--output", "b%d." + format});
    const Outcome outcome = Shell("shape-inspect - <b0." + format);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.out, expected) << format;
  }
  Succeed("shape-body", {"tube", "--triangles", "300", "--at", "60", "--output", "b%d.stl"});
  ExpectContains(Shell("shape-inspect - <b0.stl").out, "stdin\n  152 vertices, 300 polygons");
  ASSERT_EQ(Shell("shape-interpolate tube0.obj tube1.obj --output w.glb,w%02d.vtp").code, 0);
  ExpectContains(Shell("shape-inspect - <w16.vtp").out, "stdin\n  152 vertices, 300 polygons");
  File("t.vtk",
       "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n"
       "0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\n");
  ExpectContains(Shell("shape-inspect - <t.vtk").out, "stdin\n  3 vertices, 1 polygons");
  ExpectContains(Shell("shape-inspect - <w.glb").out, "morph targets not read");
}

TEST_F(StreamsTest, PipesGiveWhatFilesGive) {
  MakeTubes();
  File("handles.json", R"({"handles": [
      {"fixed": true, "select": {"vertices": [[1, 20]]}},
      {"translation": [0, 0.2, 0], "select": {"vertices": [100, 101, 102]}}]})");
  ASSERT_EQ(Shell("shape-deform tube0.obj --handles handles.json -o bent.ply").code, 0);
  const Outcome piped = Shell(
      "shape-body tube --triangles 300 --at 0 --output - | shape-deform - --handles handles.json "
      "--output - | tee piped.ply | shape-inspect -");
  EXPECT_EQ(piped.code, 0) << piped.err;
  EXPECT_EQ(ReadSoup(Path("piped.ply")).vertices, ReadSoup(Path("bent.ply")).vertices);
  ExpectContains(piped.err, "converged");  // what is usually on stdout
}

TEST_F(StreamsTest, PosesMayComeFromBoth) {
  MakeTubes();
  ASSERT_EQ(Shell("shape-interpolate tube0.obj tube1.obj -o a.path").code, 0);
  ASSERT_EQ(Shell("shape-interpolate tube0.obj - -o b.path <tube1.obj").code, 0);
  const Outcome a = Shell("shape-export a.path -o 'a%02d.ply'"),
                b = Shell("shape-export b.path -o 'b%02d.ply'");
  ASSERT_EQ(a.code + b.code, 0) << a.err << b.err;
  EXPECT_EQ(Content(Path("a07.ply")), Content(Path("b07.ply")));
}

TEST_F(StreamsTest, RefusesWhatIsNoMesh) {
  for (const auto& [line, message] :
       {std::make_pair("printf '' | shape-inspect -", "stdin: is empty"),
        {"echo nonsense | shape-inspect -", "stdin: no vertex in it"},
        {"printf 'ply\\nrubbish' | shape-inspect -", "stdin:"}}) {
    const Outcome outcome = Shell(line);
    EXPECT_EQ(outcome.code, 1) << line;
    ExpectContains(outcome.err, message);
  }
}

TEST_F(StreamsTest, StdoutIsForOneThing) {
  MakeTubes();
  for (const auto& [line, message] :
       {std::make_pair("shape-average tube0.obj tube1.obj -o - --report -",
                       "--output - and --report -: only one of them can go to stdout"),
        {"shape-body tube -o -", "--output -: is for one shape, and there are 2"},
        {"shape-interpolate tube0.obj tube1.obj -o -", "--output -: must end in"},
        {"shape-deform tube0.obj --handles h.json -o - --color parts", "--color: has no effect"}}) {
    const Outcome outcome = Shell(line);
    EXPECT_EQ(outcome.code, 2) << line << outcome.err;
    EXPECT_EQ(outcome.out, "");
    ExpectContains(outcome.err, message);
  }
}

TEST_F(StreamsTest, EachWarningIsPrintedOnce) {
  // A tube whose vertex 153 is used by no triangle, as three poses.
  MakeTubes();
  File("loose.obj", Content(Path("tube0.obj")) + "v 0 0 5\n");
  const Outcome outcome = Shell("shape-average loose.obj loose.obj loose.obj -o mean.obj");
  const size_t first = outcome.err.find("warning: ");
  ASSERT_NE(first, std::string::npos) << outcome.err;
  const std::string warning = outcome.err.substr(first, outcome.err.find('\n', first) - first);
  EXPECT_EQ(outcome.err.find(warning, first + 1), std::string::npos) << outcome.err;
}

}  // namespace
}  // namespace shapespace
