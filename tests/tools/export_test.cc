#include <filesystem>

#include <shapespace/files/read.h>
#include <shapespace/path/path_file.h>

#include "tools/run.h"

namespace shapespace {
namespace {

using testing::Content;
using testing::ExpectContains;
using testing::ExpectLacks;
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

TEST_F(ExportTest, TakesMeshesAsTheFramesOfAMotion) {
  MakePath();
  const std::vector<std::string> frames = {"solved0.ply", "solved1.ply", "solved2.ply",
                                           "solved3.ply", "solved4.ply"};
  std::vector<std::string> arguments = frames;
  arguments.insert(arguments.end(), {"--output", "again%d.ply,again.pc2"});
  Succeed("shape-export", arguments);
  for (int i = 0; i < 5; ++i) {
    const Shape frame = Vertices(frames[i]);
    const Shape again = Vertices("again" + std::to_string(i) + ".ply");
    EXPECT_LT((again - frame).norm(), 1e-12 * frame.norm());
  }
  // The point cache holds the same frames, and the mesh before it is none of them.
  Succeed("shape-export", {"solved2.ply", "again.pc2", "--output", "cached%d.ply"});
  for (int i = 0; i < 5; ++i) {
    const Shape frame = Vertices(frames[i]);
    const Shape cached = Vertices("cached" + std::to_string(i) + ".ply");
    EXPECT_LT((cached - frame).norm(), 1e-6 * frame.norm());
  }
  arguments = frames;
  arguments.insert(arguments.end(), {"--at", "0.25", "--output", "second.ply"});
  Succeed("shape-export", arguments);
  EXPECT_LT((Vertices("second.ply") - Vertices("solved1.ply")).norm(), 1e-9);
  // A path among meshes, flags of meshes that a path does not need, and overwriting are refused.
  EXPECT_EQ(Run("shape-export", {"walk.path", "tube0.obj"}).code, 2);
  EXPECT_EQ(Run("shape-export", {"walk.path", "--open_seams"}).code, 2);
  EXPECT_EQ(Run("shape-export", {"tube0.obj", "tube1.obj", "--output", "tube1.obj"}).code, 2);
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

TEST_F(ExportTest, WritesBonesInsteadOfMorphTargets) {
  MakePath();
  const Outcome exported =
      Run("shape-export", {"walk.path", "--bones", "6", "--output", "bones.glb,walk.usda"});
  EXPECT_EQ(exported.code, 0) << exported.err;
  ExpectContains(exported.out, "6 bones");
  const std::string glb = Content(Path("bones.glb"));
  ExpectContains(glb, "\"skins\"");
  ExpectContains(glb, "bone_06");
  ExpectLacks(glb, "bone_07");
  ExpectLacks(glb, "\"targets\"");

  // As many as are needed: more for less error, and the error is as asked for.
  int bytes = 0;
  for (const char* error : {"5%", ".005"}) {
    Succeed("shape-export", {"walk.path", "--bones", "auto", "--bone_error", error, "--seconds",
                             "2", "--output", "auto.glb"});
    const int now = static_cast<int>(std::filesystem::file_size(Path("auto.glb")));
    EXPECT_GT(now, bytes);
    bytes = now;
  }
  // Colours show weights or errors; parts take the place of neither.
  Succeed("shape-export", {"walk.path", "--bones", "4", "--output", "plain.glb"});
  ExpectLacks(Content(Path("plain.glb")), "COLOR_0");
  for (const char* shown : {"weights", "error"}) {
    Succeed("shape-export",
            {"walk.path", "--bones", "4", "--bone_color", shown, "--output", "shown.glb"});
    ExpectContains(Content(Path("shown.glb")), "COLOR_0");
  }
  // Any shape may be the rest pose.
  Succeed("shape-export",
          {"walk.path", "--bones", "4", "--bone_rest", "4", "--output", "last.glb"});
  EXPECT_NE(Content(Path("last.glb")), Content(Path("plain.glb")));
  ExpectContains(
      Run("shape-export", {"walk.path", "--bones", "4", "--bone_rest", "5", "--output", "none.glb"})
          .err,
      "--bone_rest");
  // A solve writes bones too.
  Succeed("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "3", "--bones", "4",
                                "--bone_scale", "--output", "solved.glb"});
  ExpectContains(Content(Path("solved.glb")), "bone_04_scale");
}

TEST_F(ExportTest, RefusesBonesThatItCannotMake) {
  MakePath();
  const auto refuses = [&](std::vector<std::string> flags, const std::string& named) {
    flags.insert(flags.begin(), "walk.path");
    const Outcome outcome = Run("shape-export", flags);
    EXPECT_EQ(outcome.code, 2) << named;
    ExpectContains(outcome.err, named);
  };
  refuses({"--bones", "0", "--output", "a.glb"}, "--bones 0");
  refuses({"--bones", "2.5", "--output", "a.glb"}, "--bones 2.5");
  refuses({"--bones", "many", "--output", "a.glb"}, "--bones");
  refuses({"--bones", "501", "--output", "a.glb"}, "--bones 501");
  refuses({"--bones", "5", "--output", "a.usda"}, ".glb");
  refuses({"--bones", "5", "--bone_error", "1%", "--output", "a.glb"}, "--bone_error");
  refuses({"--bones", "auto", "--bone_error", "100%", "--output", "a.glb"}, "--bone_error 100%");
  refuses({"--bones", "auto", "--bone_error", "1,2", "--output", "a.glb"}, "--bone_error");
  refuses({"--bone_scale", "--output", "a.glb"}, "--bones");
  refuses({"--bone_color", "error", "--output", "a.glb"}, "--bones");
  refuses({"--bones", "5", "--bone_color", "red", "--output", "a.glb"}, "--bone_color");
  refuses({"--bones", "5", "--bone_color", "error", "--color", "parts", "--output", "a.glb"},
          "--color");
  refuses({"--bones", "5", "--bone_weights", "9", "--output", "a.glb"}, "--bone_weights 9");
  refuses({"--bones", "5", "--color", "deviation", "--output", "a.glb"}, "--color");
}

TEST_F(ExportTest, WritesPicturesAndAnimations) {
  MakePath();
  Succeed("shape-export", {"walk.path", "--output", "a.glb,a.png", "--up", "z", "--unit", "0.001",
                           "--color", "deviation", "--title", "walk"});
  EXPECT_EQ(Content(Path("a.glb")).substr(0, 4), "glTF");
  EXPECT_EQ(Content(Path("a.png")).substr(1, 3), "PNG");
}

TEST_F(ExportTest, PicturesHaveTextsInUtf8AndLabelsOfShapesOrPoses) {
  MakePath();
  const auto picture = [&](const std::vector<std::string>& flags) {
    std::vector<std::string> arguments = {"walk.path", "--output", "a.png"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    Succeed("shape-export", arguments);
    return Content(Path("a.png"));
  };
  const std::string plain = picture({});
  EXPECT_NE(picture({"--title", "B\xC3\xA4r"}), picture({"--title", "Bar"}));
  // What is no UTF-8 is the replacement character.
  EXPECT_EQ(picture({"--title", "B\xE4r"}), picture({"--title", "B\xEF\xBF\xBDr"}));
  EXPECT_NE(picture({"--labels", "none"}), plain);
  EXPECT_EQ(picture({"--labels", "a,,,,b"}), picture({"--labels", "a, b"}));
  EXPECT_EQ(picture({"--labels", "0: t = 0,1: t = 0.25,2: t = 0.5,3: t = 0.75,4: t = 1"}), plain);
  const Outcome outcome =
      Run("shape-export", {"walk.path", "--labels", "a,b,c", "--output", "b.png,b.glb"});
  EXPECT_EQ(outcome.code, 1);
  ExpectContains(outcome.err, "--labels has 3 texts for 5 shapes, of which 2 are poses");
  EXPECT_FALSE(std::filesystem::exists(Path("b.png")));
  EXPECT_TRUE(std::filesystem::exists(Path("b.glb")));
}

TEST_F(ExportTest, DrawsAGroundLine) {
  MakePath();
  Succeed("shape-export", {"walk.path", "--output", "a.png"});
  Succeed("shape-export", {"walk.path", "--ground_line", "-0.5", "--output", "b.png,same%d.ply"});
  EXPECT_NE(Content(Path("a.png")), Content(Path("b.png")));
  // It moves no shape.
  EXPECT_EQ(Content(Path("same1.ply")), Content(Path("solved1.ply")));
  for (const char* height : {"y=0", "", "0,1", "inf"}) {
    const Outcome outcome =
        Run("shape-export", {"walk.path", "--ground_line", height, "--output", "c.png"});
    EXPECT_EQ(outcome.code, 2);
    ExpectContains(outcome.err, "--ground_line ");
  }
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
      {"walk.path", "--up", "w"},
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
