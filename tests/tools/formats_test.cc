#include <regex>
#include <sstream>

#include <shapespace/files/read.h>
#include <shapespace/path/path_file.h>

#include "tools/run.h"

namespace shapespace {
namespace {

using testing::Content;
using testing::ExpectContains;
using testing::Outcome;
using testing::ToolsTest;

using Strings = std::vector<std::string>;

class FormatsTest : public ToolsTest {
 protected:
  /// tube0.obj, tube1.obj, and walk.path of five shapes between them.
  void MakeWalk(const std::string& more = "") const {
    MakeTubes();
    Succeed("shape-interpolate",
            {"tube0.obj", "tube1.obj", "--shapes", "3", "--output", "walk.path" + more});
  }

  std::vector<Shape> Shapes(const std::string& file) const { return ReadPath(Path(file)).Placed(); }
};

TEST_F(FormatsTest, MorphTargetsArePoses) {
  MakeWalk(",walk.glb");
  const Outcome outcome =
      Run("shape-interpolate", {"walk.glb", "--shapes", "1", "--output", "finer.path"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(outcome.out, "5 poses, 1 shape inserted");
  const std::vector<Shape> walk = Shapes("walk.path"), finer = Shapes("finer.path");
  ASSERT_EQ(finer.size(), 9u);
  const double size = walk[0].cwiseAbs().maxCoeff();
  for (int i = 0; i < 5; ++i) {
    EXPECT_LT((finer[2 * i] - walk[i]).cwiseAbs().maxCoeff(), 1e-6 * size) << i;
  }
  const Outcome inspected = Run("shape-inspect", {"walk.glb"});
  EXPECT_EQ(inspected.code, 0);
  ExpectContains(inspected.out, "walk.glb:target 4 against walk.glb\n");
}

// Where one mesh is wanted, a file of several poses gives its first.
TEST_F(FormatsTest, OneMeshIsTheFirstOfSeveralPoses) {
  MakeWalk(",walk.glb");
  Succeed("shape-body", {"tube", "--triangles", "300", "--at", "0,30", "--output", "other%d.obj"});
  const Outcome outcome = Run("shape-transfer", {"other0.obj", "other1.obj", "--target", "walk.glb",
                                                 "--output", "moved.path"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const std::vector<Shape> moved = Shapes("moved.path"), walk = Shapes("walk.path");
  ASSERT_EQ(moved.size(), 2u);
  EXPECT_LT((moved[0] - walk[0]).cwiseAbs().maxCoeff(), 1e-5);

  const Outcome repaired =
      Run("shape-deform", {"tube1.obj", "--repair", "walk.glb", "--output", "repaired.stl"});
  ExpectContains(repaired.err, "4 morph targets not read");
  EXPECT_EQ(ReadSoup(Path("repaired.stl")).NumVertices(), walk[0].cols());
}

TEST_F(FormatsTest, NamesOfMorphTargetsNamePosesOfASpace) {
  MakeWalk(",walk.glb");
  Succeed("shape-explore", {"walk.glb", "--depth", "0", "--shapes", "1", "--output", "walk.space"});
  const Outcome outcome = Run("shape-inspect", {"walk.space"});
  ExpectContains(outcome.out, "  walk\n");
  ExpectContains(outcome.out, "  target 3\n");
}

TEST_F(FormatsTest, FramesAreTheSameInAllFormats) {
  MakeWalk();
  const Outcome outcome =
      Run("shape-export", {"walk.path", "--output", "%d.off,%d.stl,%d.vtp,%d.ply,w.pc2,w.mdd"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* wrote :
       {"0.off .. 4.off", "0.stl .. 4.stl", "0.vtp .. 4.vtp", "w.pc2", "w.mdd"}) {
    ExpectContains(outcome.out, "wrote " + std::string(wrote) + "\n");
  }
  const std::vector<Shape> shapes = Shapes("walk.path");
  const auto bytes = 12 * 5 * shapes[0].cols();
  EXPECT_EQ(Content(Path("w.pc2")).size(), 32u + bytes);
  EXPECT_EQ(Content(Path("w.mdd")).size(), 8u + 4 * 5 + bytes);
  const std::string last = Content(Path("w.pc2")).substr(32 + bytes - 12);
  const Eigen::Vector3f vertex = shapes[4].rightCols<1>().cast<float>();
  EXPECT_EQ(last, std::string(reinterpret_cast<const char*>(vertex.data()), 12));
  EXPECT_EQ(ReadSoup(Path("3.off")).vertices, ReadSoup(Path("3.ply")).vertices);
  EXPECT_EQ(ReadSoup(Path("3.vtp")).vertices, ReadSoup(Path("3.ply")).vertices);
  EXPECT_NO_THROW(ReadPoses({Path("0.stl"), Path("4.stl")}));
  const Outcome numbered = Run("shape-export", {"walk.path", "--output", "w%d.pc2"});
  EXPECT_EQ(numbered.code, 2);
  ExpectContains(numbered.err, "one .pc2 contains the whole path");
}

// A series for ParaView can be worked on there, and its files taken as poses again.
TEST_F(FormatsTest, FilesForParaViewArePosesAgain) {
  MakeWalk(",%d.vtp");
  const Outcome outcome = Run("shape-interpolate", {"0.vtp", "4.vtp", "--stiffness", "4.vtp:t",
                                                    "--shapes", "1", "--output", "w.path"});
  EXPECT_EQ(outcome.code, 1);
  ExpectContains(outcome.err, "4.vtp: no point data has the name 't'");
  const Outcome inspected = Run("shape-inspect", {"0.vtp", "4.vtp"});
  EXPECT_EQ(inspected.code, 0);
  ExpectContains(inspected.out, "point data not kept: deviation, energy");
  Succeed("shape-interpolate", {"0.vtp", "4.vtp", "--shapes", "1", "--output", "w.path"});
  EXPECT_LT((Shapes("w.path")[0] - Shapes("walk.path")[0]).cwiseAbs().maxCoeff(), 1e-12);
}

TEST_F(FormatsTest, UsdTakesTheFlagsOfAnimations) {
  MakeWalk();
  const Outcome outcome = Run("shape-export", {"walk.path", "--up", "z", "--unit", "0.01", "--fps",
                                               "25", "--color", "parts", "--output", "w.usda"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(outcome.out, "wrote w.usda\n");
  const std::string text = Content(Path("w.usda"));
  for (const char* words : {"upAxis = \"Z\"", "metersPerUnit = 0.01\n", "timeCodesPerSecond = 25\n",
                            "endTimeCode = 4\n", "primvars:displayColor = ["}) {
    ExpectContains(text, words);
  }
  const Outcome numbered = Run("shape-export", {"walk.path", "--output", "w%d.usda"});
  EXPECT_EQ(numbered.code, 2);
  ExpectContains(numbered.err, "one .usda contains the whole path");
}

TEST_F(FormatsTest, FpsIsTheRateOfAnMdd) {
  MakeWalk();
  Succeed("shape-export", {"walk.path", "--output", "w.mdd"});
  Succeed("shape-export", {"walk.path", "--fps", "50", "--output", "fast.mdd"});
  // The second time, big-endian: 1 / 24 and 1 / 50 in single precision.
  EXPECT_EQ(Content(Path("w.mdd")).substr(12, 4), "\x3d\x2a\xaa\xab");
  EXPECT_EQ(Content(Path("fast.mdd")).substr(12, 4), "\x3c\xa3\xd7\x0a");
}

TEST_F(FormatsTest, ColoursOfFrames) {
  MakeWalk();
  const auto colours = [&](const std::string& file) {
    return ReadSoup(Path(file)).appearance.vertex_colours;
  };
  const Outcome outcome =
      Run("shape-export", {"walk.path", "--color", "deviation", "--output", "%d.ply,%d.obj"});
  ExpectContains(outcome.err, "note: %d.ply: the last colour stands for a deviation of ");
  EXPECT_EQ(colours("0.ply").cols(), Shapes("walk.path")[0].cols());
  EXPECT_NE(colours("0.ply"), colours("4.ply"));
  EXPECT_EQ(colours("4.obj"), colours("4.ply"));
  Succeed("shape-export", {"walk.path", "--color", "parts", "--output", "%d.ply"});
  EXPECT_EQ(colours("0.ply"), colours("4.ply"));
  Succeed("shape-export", {"walk.path", "--output", "%d.ply"});
  EXPECT_EQ(colours("0.ply").size(), 0);
}

TEST_F(FormatsTest, ProgressForPrograms) {
  MakeTubes(4000);
  const Outcome outcome = Run("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "31",
                                                    "--output", "walk.pc2", "--progress", "lines"});
  EXPECT_EQ(outcome.code, 0);
  std::istringstream text(outcome.err);
  const std::regex progress("progress (-|[01]\\.[0-9]+) (.+)");
  int lines = 0;
  for (std::string line; std::getline(text, line); ++lines) {
    std::smatch match;
    ASSERT_TRUE(std::regex_match(line, match, progress)) << line;
    if (match[1] == "-") continue;
    EXPECT_LE(std::stod(match[1]), 1);
  }
  EXPECT_GT(lines, 1);
  EXPECT_EQ(Run("shape-interpolate", {"--progress", "bar"}).code, 2);
}

}  // namespace
}  // namespace shapespace
