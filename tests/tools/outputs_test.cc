#include <algorithm>
#include <filesystem>

#include <nlohmann/json.hpp>

#include <shapespace/path/path_file.h>

#include "output/read_glb.h"
#include "tools/run.h"

namespace shapespace {
namespace {

using testing::Content;
using testing::ExpectContains;
using testing::ExpectLacks;
using testing::Outcome;
using testing::ToolsTest;

using Strings = std::vector<std::string>;

class OutputsTest : public ToolsTest {
 protected:
  /// tube0.obj, tube1.obj and walk.path between them, of five shapes.
  void MakeWalk() const {
    MakeTubes();
    Succeed("shape-interpolate",
            {"tube0.obj", "tube1.obj", "--shapes", "3", "--output", "walk.path"});
  }

  /// Sorted contents of all files, to detect any change.
  Strings Contents() const {
    Strings contents;
    for (const std::string& file : Files()) {
      if (std::filesystem::is_regular_file(Path(file))) {
        contents.push_back(file + ": " + Content(Path(file)));
      }
    }
    return contents;
  }

  std::vector<double> Times(const std::string& file) const {
    const Glb glb(Path(file));
    const int input = glb.json["animations"][0]["samplers"][0]["input"];
    const Eigen::MatrixXd times = glb.Read(input);
    return {times.data(), times.data() + times.size()};
  }

  /// The shape of the path, counted from 0 with fractions, that is shown after this share of the
  /// time.
  double ShapeAt(const std::string& file, double share) const {
    const Glb glb(Path(file));
    const std::vector<double> times = Times(file);
    const int output = glb.json["animations"][0]["samplers"][0]["output"];
    Eigen::MatrixXd weights = glb.Read(output);
    weights.resize(weights.size() / times.size(), times.size());
    const auto at_key = [&](size_t key) {
      double shape = 0;
      for (int k = 0; k < weights.rows(); ++k) shape += (k + 1) * weights(k, key);
      return shape;
    };
    const double time = share * times.back();
    size_t key = 1;
    while (key + 1 < times.size() && times[key] < time) ++key;
    const double part = (time - times[key - 1]) / (times[key] - times[key - 1]);
    return (1 - part) * at_key(key - 1) + part * at_key(key);
  }
};

TEST_F(OutputsTest, NoRunOverwritesWhatItReadsOrWrites) {
  MakeWalk();
  Succeed("shape-body", {"tube", "--triangles", "300", "--at", "20", "--output", "other%d.obj"});
  File("stiff.txt", "1 2\n");
  File("tube0100.obj", Content(Path("tube0.obj")));
  std::filesystem::create_directory(Path("sub"));
  std::filesystem::create_directory_symlink(Path(""), Path("sub/link"));
  std::filesystem::create_symlink(Path("tube1.obj"), Path("alias1.obj"));
  const Strings poses = {"shape-interpolate", "tube0.obj", "tube1.obj", "--shapes", "3"};
  const Strings transfer = {"shape-transfer", "tube0.obj", "tube1.obj", "--target", "other0.obj"};
  const Strings handles = {"shape-deform", "tube0.obj", "--handles", "handles.json"};
  const Strings repair = {"shape-deform", "tube0.obj", "--repair", "other0.obj"};
  File("handles.json", R"({"handles": [{"fixed": true, "select": {"vertices": [1]}}]})");
  const struct {
    Strings run, more;
    Strings parts;
  } cases[] = {
      {poses,
       {"--output", "tube%d.obj"},
       {"--output tube%d.obj: tube0.obj", "overwrite tube0.obj"}},
      {poses, {"--output", "./sub/../tube%d.obj"}, {"overwrite tube0.obj"}},
      {poses, {"--output", "sub/link/tube%d.obj"}, {"overwrite tube0.obj"}},
      {poses, {"--output", Path("tube%1d.obj")}, {"overwrite tube0.obj"}},
      {{"shape-interpolate", "alias1.obj", "other0.obj"},
       {"--output", "tube%d.obj"},
       {"tube1.obj would overwrite alias1.obj"}},
      {{"shape-interpolate", "tube0100.obj", "tube1.obj", "--shapes", "99"},
       {"--output", "tube0%d.obj"},
       {"tube0100.obj would overwrite tube0100.obj"}},
      {poses, {"--output", "w.path,w.png,./w.png"}, {"--output ./w.png", "--output w.png"}},
      {poses, {"--output", "w.path,w.path"}, {"--output w.path would overwrite"}},
      {{"shape-interpolate", "tube0.obj", "tube1.obj", "--shapes", "150"},
       {"--output", "f/%d.obj,f/%03d.obj"},
       {"f/100.obj would overwrite what --output f/%d.obj writes"}},
      {poses,
       {"--stiffeners", "stiff.txt", "--report", "stiff.txt", "--output", "w.path"},
       {"--report stiff.txt would overwrite stiff.txt"}},
      {{"shape-extrapolate", "walk.path"},
       {"--output", "walk.path"},
       {"--output walk.path would overwrite walk.path"}},
      {{"shape-extrapolate", "tube0.obj", "tube1.obj", "--shapes", "1", "--steps", "8"},
       {"--output", "tube%d.obj"},
       {"overwrite tube0.obj"}},
      {transfer, {"--output", "other%d.obj"}, {"other0.obj would overwrite other0.obj"}},
      {transfer,
       {"--output", "w.path", "--hybrids", "tube%d.obj"},
       {"--hybrids tube%d.obj: tube0"}},
      {transfer,
       {"--output", "w.path", "--hybrids", "./w.path"},
       {"--hybrids ./w.path would overwrite what --output w.path writes"}},
      {{"shape-transfer", "walk.path", "--target", "other0.obj"},
       {"--output", "w.png", "--hybrids", "w.glb,walk.path"},
       {"--hybrids walk.path would overwrite walk.path"}},
      {handles, {"--output", "w.path,./tube0.obj"}, {"overwrite tube0.obj"}},
      {handles, {"--output", "tube%d.obj"}, {"--output tube%d.obj: tube0.obj"}},
      {handles, {"--output", "alias1.obj,tube1.obj"}, {"overwrite what --output alias1.obj"}},
      {handles,
       {"--output", "w.path", "--report", "sub/../handles.json"},
       {"--report sub/../handles.json would overwrite handles.json"}},
      {handles,
       {"--stiffeners", "stiff.txt", "--report", "stiff.txt", "--output", "w.path"},
       {"--report stiff.txt would overwrite stiff.txt"}},
      {repair, {"--output", "other0.obj"}, {"--output other0.obj would overwrite other0.obj"}},
      {repair, {"--output", "other%d.obj"}, {"--output other%d.obj: other0.obj"}},
  };
  const Strings before = Contents();
  for (const auto& [run, more, parts] : cases) {
    SCOPED_TRACE(run[0] + " " + parts[0]);
    Strings arguments(run.begin() + 1, run.end());
    arguments.insert(arguments.end(), more.begin(), more.end());
    const Outcome outcome = Run(run[0], arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    for (const std::string& part : parts) ExpectContains(outcome.err, part);
    EXPECT_EQ(Contents(), before);
  }
}

TEST_F(OutputsTest, WhatAnEarlierRunWroteIsOverwritten) {
  MakeWalk();
  File("w.png", "old");
  File("f1.obj", "old");
  // Five frames do not include number 5; and too many shapes are refused before names are
  // generated.
  std::filesystem::rename(Path("tube0.obj"), Path("f5.obj"));
  Succeed("shape-interpolate",
          {"f5.obj", "tube1.obj", "--shapes", "3", "--output", "w.png,f%d.obj"});
  EXPECT_NE(Content(Path("w.png")), "old");
  EXPECT_NE(Content(Path("f1.obj")), "old");
  const Outcome many = Run("shape-interpolate", {"f5.obj", "tube1.obj", "--shapes", "2000000000",
                                                 "--output", "g%d.obj"});
  EXPECT_EQ(many.code, 1);
  ExpectContains(many.err, "more than the memory limit");
}

TEST_F(OutputsTest, AWriteThatFailsLosesNothingElse) {
  MakeTubes();
  std::filesystem::create_directories(Path("f/2.obj"));  // at the name of a frame
  const Outcome outcome =
      Run("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "3", "--output",
                                "f/%d.obj,w.png,w.path", "--report", "r.json"});
  EXPECT_EQ(outcome.code, 1);
  ExpectContains(outcome.err, "shape-interpolate: f/2.obj: cannot be replaced");
  ExpectContains(outcome.out, "converged: 152 vertices");
  ExpectContains(outcome.out, "wrote w.path\nwrote w.png\nwrote r.json\n");
  ExpectLacks(outcome.out, "f/");
  EXPECT_EQ(ReadPath(Path("w.path")).NumShapes(), 5);
  EXPECT_TRUE(std::filesystem::exists(Path("w.png")));
  EXPECT_EQ(nlohmann::json::parse(Content(Path("r.json")))["converged"], true);
}

TEST_F(OutputsTest, EachFileWrittenIsNamed) {
  MakeTubes();
  const Strings arguments = {"tube0.obj", "tube1.obj", "--shapes",
                             "3",         "--output",  "w.png,f/%03d.obj,w.path"};
  const std::string wrote = "wrote w.path\nwrote w.png\nwrote f/000.obj .. f/004.obj\n";
  const Outcome plain = Run("shape-interpolate", arguments);
  ASSERT_EQ(plain.code, 0) << plain.err;
  EXPECT_EQ(plain.out.substr(plain.out.find('\n') + 1), wrote);
  ExpectQuiet(plain);
  Strings with_report = arguments;
  with_report.insert(with_report.end(), {"--report", "-"});
  const Outcome report = Run("shape-interpolate", with_report);
  ASSERT_EQ(report.code, 0) << report.err;
  EXPECT_TRUE(nlohmann::json::parse(report.out, nullptr, false).is_object()) << report.out;
  ExpectContains(report.err, wrote);

  const Outcome body = Run("shape-body", {"bar", "--output", "b%d.ply"});
  ExpectContains(body.out, "wrote b0.ply .. b1.ply\n");
  ExpectContains(Run("shape-body", {"bar", "--at", "0", "--output", "c%d.ply"}).out,
                 "wrote c0.ply\n");
  ExpectContains(Run("shape-export", {"w.path", "--output", "e.glb", "--frames", "3"}).out,
                 "wrote e.glb\n");
  const Outcome transfer =
      Run("shape-transfer", {"w.path", "--target", "tube0.obj", "--output", "t%d.obj", "--hybrids",
                             "h.path", "--report", "t.txt"});
  ExpectContains(transfer.out, "wrote t0.obj .. t4.obj\nwrote h.path\nwrote t.txt\n");
  const Outcome repair = Run("shape-deform", {"tube1.obj", "--repair", "tube0.obj", "--output",
                                              "m.obj,m%d.obj,m.glb", "--report", "m.json"});
  ExpectContains(repair.out, "wrote m.obj\nwrote m0.obj .. m1.obj\nwrote m.glb\nwrote m.json\n");
}

TEST_F(OutputsTest, FramesOfAnEarlierRunAreTold) {
  MakeTubes();
  const auto err = [&](const char* shapes) {
    return Run("shape-interpolate",
               {"tube0.obj", "tube1.obj", "--shapes", shapes, "--output", "f/%02d.obj"})
        .err;
  };
  EXPECT_EQ(err("9"), "");
  EXPECT_EQ(err("9"), "");
  ExpectContains(err("3"), "note: f/05.obj .. f/10.obj are of an earlier run, and stay");
  ExpectContains(err("8"), "note: f/10.obj is of an earlier run, and stays");
  EXPECT_TRUE(std::filesystem::exists(Path("f/10.obj")));
}

TEST_F(OutputsTest, NamesMayBeInCapitalsAndStandApart) {
  MakeTubes();
  Succeed("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "1", "--output",
                                " w.PATH, w.PNG ,\tA %d.OBJ, w.Glb", "--report", "r.JSON"});
  EXPECT_EQ(Files(), (Strings{"A 0.OBJ", "A 1.OBJ", "A 2.OBJ", "r.JSON", "tube0.obj", "tube1.obj",
                              "w.Glb", "w.PATH", "w.PNG"}));
  EXPECT_EQ(nlohmann::json::parse(Content(Path("r.JSON")))["converged"], true);
  Succeed("shape-extrapolate", {"w.PATH", "--steps", "1", "--output", "on.path"});
  ExpectContains(Run("shape-inspect", {"w.PATH"}).out, "3 shapes, 2 of them given");
  Succeed("shape-interpolate",
          {"A 0.OBJ", "A 2.OBJ", "--shapes", "1", "--output", "b.path", "--report", "100%.txt"});
  ExpectContains(ReadPath(Path("b.path")).provenance, ": 'A 0.OBJ' 'A 2.OBJ'");
  Succeed("shape-body", {"bar", "--output", "bar%d.PLY"});
}

TEST_F(OutputsTest, FilmsAndPicturesOfShapesAreWritten) {
  MakeWalk();
  const Outcome outcome = Run(
      "shape-export", {"walk.path", "--seconds", "0.2", "--output", "a.gif,a.apng,in/%02d.png"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  for (const char* name : {"a.gif", "a.apng", "in/00.png", "in/04.png"}) {
    ExpectContains(outcome.out, name);
  }
  EXPECT_EQ(Content(Path("a.gif")).substr(0, 6), "GIF89a");
  ExpectContains(Content(Path("a.apng")), "acTL");
  // Pictures of shapes are PNG files of one size.
  for (const char* name : {"in/01.png", "in/02.png", "in/03.png", "in/04.png"}) {
    EXPECT_EQ(Content(Path(name)).substr(0, 24), Content(Path("in/00.png")).substr(0, 24)) << name;
  }
  EXPECT_FALSE(std::filesystem::exists(Path("in/05.png")));
  const Outcome refused = Run("shape-export", {"walk.path", "--output", "a.png,in/%d.gif"});
  EXPECT_EQ(refused.code, 2);
  ExpectContains(refused.err, "in/%d.gif");
  EXPECT_FALSE(std::filesystem::exists(Path("a.png")));
  Succeed("shape-export",
          {"walk.path", "--seconds", "0.2", "--labels", "a,b", "--output", "labelled/%02d.png"});
  EXPECT_NE(Content(Path("labelled/00.png")), Content(Path("in/00.png")));
  std::filesystem::create_symlink(Path("walk.path"), Path("link2.png"));
  ExpectContains(Run("shape-export", {"walk.path", "--output", "link%d.png"}).err, "link2.png");
}

// The last shape of a cycle is its first, so that it goes on instead of back.
TEST_F(OutputsTest, ACycleIsPlayedAround) {
  MakeTubes();
  Succeed("shape-interpolate", {"tube0.obj", "tube1.obj", "tube0.obj", "--shapes", "1", "--seconds",
                                "2", "--output", "cycle.glb,cycle.path"});
  // With rests at both ends there would be more times than shapes.
  EXPECT_EQ(Times("cycle.glb").size(), 5u);
  Succeed("shape-export", {"cycle.path", "--once", "--output", "once.glb"});
  EXPECT_EQ(Times("once.glb").size(), 6u);
  Succeed("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "3", "--output", "back.glb"});
  EXPECT_GT(Times("back.glb").size(), 6u);
}

// Long solves are worth a file from which everything else can be made.
TEST_F(OutputsTest, WithoutAFlagThePathIsKeptToo) {
  MakeTubes();
  Succeed("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "1"});
  EXPECT_EQ(ReadPath(Path("path.path")).NumShapes(), 3);
  EXPECT_TRUE(std::filesystem::exists(Path("path.png")));
  Succeed("shape-export", {"path.path"});
}

TEST_F(OutputsTest, OneShapeNeedsNoNumber) {
  MakeWalk();
  Succeed("shape-export", {"walk.path", "--at", ".5", "--output", "middle.obj,middle%d.obj"});
  EXPECT_EQ(Content(Path("middle.obj")), Content(Path("middle0.obj")));
  EXPECT_EQ(Run("shape-export", {"walk.path", "--at", "0,.5", "--output", "two.obj"}).code, 2);
}

// Nobody can make a file in /proc, though its permissions seem to allow it.
TEST_F(OutputsTest, OutputsAreTriedBeforeTheSolve) {
  MakeTubes();
  const Strings before = Files();
  const Outcome outcome =
      Run("shape-interpolate", {"tube0.obj", "tube1.obj", "--output", "a.path,/proc/x.png"});
  EXPECT_EQ(outcome.code, 1);
  ExpectContains(outcome.err, "/proc/x.png");
  EXPECT_EQ(outcome.out, "");
  EXPECT_EQ(Files(), before);
}

TEST_F(OutputsTest, AnimationsHaveYOrZUp) {
  MakeWalk();
  const Outcome refused =
      Run("shape-export", {"walk.path", "--up", "x", "--output", "a.png,a.glb"});
  EXPECT_EQ(refused.code, 2);
  for (const char* part : {"--up x", "a.glb"}) ExpectContains(refused.err, part);
  EXPECT_FALSE(std::filesystem::exists(Path("a.png")));
  Succeed("shape-export", {"walk.path", "--up", "x", "--output", "x.png"});
  Succeed("shape-export", {"walk.path", "--up", "-x", "--output", "minus.png"});
  EXPECT_NE(Content(Path("x.png")), Content(Path("minus.png")));
  Succeed("shape-export", {"walk.path", "--view", "1,0,0", "--output", "side.png"});
  Succeed("shape-export", {"walk.path", "--view", "0,0,1", "--output", "front.png"});
  EXPECT_NE(Content(Path("side.png")), Content(Path("front.png")));
}

TEST_F(OutputsTest, FlagsSetTheTimesOfAGlb) {
  MakeWalk();
  const auto times = [&](Strings flags) {
    flags.insert(flags.begin(), {"walk.path", "--output", "a.glb"});
    Succeed("shape-export", flags);
    return Times("a.glb");
  };
  EXPECT_NEAR(times({}).back(), 4, 1e-6);
  EXPECT_NEAR(times({"--seconds", "7"}).back(), 7, 1e-6);
  // Five shapes, four steps.
  EXPECT_EQ(times({"--loop", "--fps", "2"}), (std::vector<double>{0, .5, 1, 1.5, 2}));
  const std::vector<double> once = times({"--once", "--seconds", "10"});
  EXPECT_NEAR(once[4], 9, 1e-6);  // then it is held
  EXPECT_NEAR(once[1] - once[0], once[2] - once[1], 1e-6);
  // After a quarter of the time an eased motion has covered (1 - cos(pi / 4)) / 2 of the path, and
  // after half the time a half; likewise for frames at eased times.
  EXPECT_NEAR(ShapeAt("a.glb", 0.25), 0.25 * 4 / 0.9, 1e-3);
  times({"--loop", "--ease"});
  EXPECT_NEAR(ShapeAt("a.glb", 0.25), 4 * 0.146447, 1e-2);
  EXPECT_NEAR(ShapeAt("a.glb", 0.5), 2, 1e-3);
  times({"--loop", "--ease", "--frames", "5"});
  EXPECT_NEAR(ShapeAt("a.glb", 0.25), 1, 1e-2);

  Succeed("shape-interpolate",
          {"tube0.obj", "tube1.obj", "--shapes", "3", "--loop", "--ease", "--output", "b.glb"});
  EXPECT_NEAR(ShapeAt("b.glb", 0.25), 4 * 0.146447, 1e-2);
  Succeed("shape-transfer", {"walk.path", "--target", "tube0.obj", "--once", "--fps", "4",
                             "--output", "c.path", "--hybrids", "c.glb"});
  EXPECT_NEAR(Times("c.glb")[4], 1, 1e-6);
  const Outcome useless = Run("shape-export", {"walk.path", "--ease", "--output", "%d.obj"});
  EXPECT_EQ(useless.code, 2);
  ExpectContains(useless.err, "--ease");
}

TEST_F(OutputsTest, MoreFramesThanFitAreRefused) {
  MakeWalk();
  for (const Strings& flags :
       {Strings{"--frames", "2000000000"}, Strings{"--frames", "200", "--memory_limit", "0.001"}}) {
    Strings arguments = {"walk.path", "--output", "%d.ply"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    const Outcome outcome = Run("shape-export", arguments);
    EXPECT_EQ(outcome.code, 1);
    ExpectContains(outcome.err, "--frames " + flags[1] + ": needs about ");
    ExpectContains(outcome.err, " MB, more than the memory limit");
    ExpectContains(outcome.err, "raise --memory_limit");
  }
  Succeed("shape-export", {"walk.path", "--output", "%d.ply", "--frames", "200"});
}

TEST_F(OutputsTest, StrictTakesWhatDidNotConvergeForAFailure) {
  MakeTubes();
  Strings arguments = {"tube0.obj",        "tube1.obj", "--shapes", "3",
                       "--tolerance",      "1e-12",     "--output", "w.path,w%d.ply",
                       "--max_iterations", "1"};
  const Outcome lenient = Run("shape-interpolate", arguments);
  EXPECT_EQ(lenient.code, 0);
  ExpectContains(lenient.out, "NOT CONVERGED");
  std::filesystem::remove(Path("w.path"));
  arguments.push_back("--strict");
  const Outcome strict = Run("shape-interpolate", arguments);
  EXPECT_EQ(strict.code, 1);
  ExpectContains(strict.err, "not converged");
  EXPECT_FALSE(ReadPath(Path("w.path")).converged);
  // Tools that continue from there print a warning.
  ExpectContains(Run("shape-inspect", {"w.path"}).out, "NOT CONVERGED");
  const Outcome shown = Run("shape-export", {"w.path", "--output", "w.png"});
  EXPECT_EQ(shown.code, 0);
  ExpectContains(shown.err, "w.path: the solve that made it did not converge");
  const Outcome on =
      Run("shape-extrapolate", {"w.path", "--steps", "1", "--output", "on.path", "--strict"});
  EXPECT_EQ(on.code, 0) << on.err;  // this solve did
  EXPECT_FALSE(ReadPath(Path("on.path")).converged);
  EXPECT_EQ(Run("shape-extrapolate", {"w.path", "--steps", "1", "--output", "on.path",
                                      "--step_iterations", "1", "--strict"})
                .code,
            1);

  Succeed("shape-interpolate",
          {"tube0.obj", "tube1.obj", "--shapes", "3", "--output", "good.path", "--strict"});
  EXPECT_TRUE(ReadPath(Path("good.path")).converged);
  ExpectLacks(Run("shape-inspect", {"good.path"}).out, "NOT CONVERGED");
}

}  // namespace
}  // namespace shapespace
