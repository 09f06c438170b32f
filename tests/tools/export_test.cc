#include <shapespace/files/read.h>
#include <shapespace/path/path_file.h>

#include "tools/run.h"

namespace shapespace {
namespace {

using testing::Content;
using testing::ExpectContains;
using testing::Outcome;
using testing::ToolsTest;

class ExportTest : public ToolsTest {
 protected:
  void MakePath() const {
    MakeTubes();
    Succeed("shape-interpolate",
            {"tube0.obj", "tube1.obj", "--shapes", "3", "--output", "walk.path,solved%d.ply"});
  }
  Shape Vertices(const std::string& file) const { return ReadSoup(Path(file)).vertices; }
};

TEST_F(ExportTest, GivesTheVeryFramesOfTheSolve) {
  MakePath();
  Succeed("shape-export", {"walk.path", "--output", "again%d.ply"});
  for (const char* i : {"0", "1", "2", "3", "4"}) {
    EXPECT_EQ(Content(Path("again" + std::string(i) + ".ply")),
              Content(Path("solved" + std::string(i) + ".ply")));
  }
}

TEST_F(ExportTest, ShowsOtherTimes) {
  MakePath();
  Succeed("shape-export", {"walk.path", "--at", ".25,.4,1", "--output", "at%d.ply"});
  EXPECT_TRUE(Vertices("at0.ply") == Vertices("solved1.ply"));
  EXPECT_TRUE(Vertices("at2.ply") == Vertices("solved4.ply"));
  // Between the second and the third shape, nearer to the third.
  const double before = (Vertices("at1.ply") - Vertices("solved1.ply")).norm();
  const double after = (Vertices("at1.ply") - Vertices("solved2.ply")).norm();
  EXPECT_GT(before, after);
  EXPECT_LT(before, (Vertices("solved2.ply") - Vertices("solved1.ply")).norm());
}

TEST_F(ExportTest, EasedFramesMoveLessAtTheEnds) {
  MakePath();
  Succeed("shape-export", {"walk.path", "--frames", "9", "--ease", "--output", "eased%d.ply"});
  const auto step = [&](int i) {
    return (Vertices("eased" + std::to_string(i + 1) + ".ply") -
            Vertices("eased" + std::to_string(i) + ".ply"))
        .norm();
  };
  EXPECT_LT(3 * step(0), step(3));
  EXPECT_LT(3 * step(7), step(4));
}

TEST_F(ExportTest, WritesPicturesAndAnimations) {
  MakePath();
  Succeed("shape-export", {"walk.path", "--output", "a.glb,a.png", "--up", "z", "--unit", "0.001",
                           "--color", "deviation", "--title", "walk"});
  EXPECT_EQ(Content(Path("a.glb")).substr(0, 4), "glTF");
  EXPECT_EQ(Content(Path("a.png")).substr(1, 3), "PNG");
}

TEST_F(ExportTest, ColoursNearRigidParts) {
  MakePath();
  Succeed("shape-export", {"walk.path", "--output", "parts.glb,parts.png", "--color", "parts"});
  Succeed("shape-export", {"walk.path", "--output", "plain.glb,plain.png"});
  EXPECT_EQ(Content(Path("parts.glb")).substr(0, 4), "glTF");
  ExpectContains(Content(Path("parts.glb")), "COLOR_0");
  EXPECT_EQ(Content(Path("parts.png")).substr(1, 3), "PNG");
  EXPECT_NE(Content(Path("parts.png")), Content(Path("plain.png")));
}

TEST_F(ExportTest, RefusesWhatMakesNoSense) {
  MakePath();
  const std::vector<std::vector<std::string>> wrong = {
      {"walk.path", "--output", "b.path"},
      {"walk.path", "--at", ".5,.25"},
      {"walk.path", "--at", "0,2"},
      {"walk.path", "--at", "x"},
      {"walk.path", "--frames", "1"},
      {"walk.path", "--ease"},
      {"walk.path", "--at", "0", "--frames", "3"},
      {"walk.path", "--up", "x"},
      {"walk.path", "--color", "blue"},
      {"walk.path", "--unit", "0"},
      {},
  };
  for (const std::vector<std::string>& arguments : wrong) {
    const Outcome outcome = Run("shape-export", arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    ExpectContains(outcome.err, "shape-export: ");
  }
  EXPECT_EQ(Run("shape-export", {"nowhere.path"}).code, 1);
  EXPECT_EQ(Run("shape-export", {"tube0.obj"}).code, 1);
}

}  // namespace
}  // namespace shapespace
