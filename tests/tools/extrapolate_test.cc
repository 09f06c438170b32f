#define STB_IMAGE_IMPLEMENTATION
#define STB_IMAGE_STATIC
#define STBI_ONLY_PNG
#include <stb_image.h>

#include <algorithm>
#include <array>
#include <memory>

#include <nlohmann/json.hpp>

#include <shapespace/analysis/quality.h>
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

using Strings = std::vector<std::string>;

/// The initial of the dominant colour of each cell of a film strip without legend, which has
/// `count` cells in one row.
std::string CellColours(const std::string& file, int count) {
  int width, height, channels;
  const std::unique_ptr<stbi_uc, void (*)(void*)> pixels(
      stbi_load(file.c_str(), &width, &height, &channels, 3), stbi_image_free);
  if (pixels == nullptr) return "no picture";
  std::string colours;
  for (int cell = 0; cell < count; ++cell) {
    std::array<int, 3> seen = {0, 0, 0};
    for (int y = 0; y < height; ++y) {
      for (int x = cell * width / count; x < (cell + 1) * width / count; ++x) {
        const unsigned char* p = pixels.get() + 3 * (y * width + x);
        const int red = p[0], green = p[1], blue = p[2];
        seen[0] += blue > green + 20 && green > red + 20;
        seen[1] += green > red + 20 && green > blue + 20;
        seen[2] += red > green + 20 && blue > green + 20;
      }
    }
    colours += "bgp"[std::max_element(seen.begin(), seen.end()) - seen.begin()];
  }
  return colours;
}

class ExtrapolateTest : public ToolsTest {
 protected:
  /// Writes walk.path: five shapes from one tube to the other.
  void MakeWalk() const {
    MakeTubes();
    Succeed("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "3", "--tolerance", "1e-6",
                                  "--output", "walk.path"});
  }

  Shape Vertices(const std::string& file) const { return ReadSoup(Path(file)).vertices; }
};

TEST_F(ExtrapolateTest, PosesAreInterpolatedAndGoneOnFrom) {
  MakeTubes();
  const Outcome outcome =
      Run("shape-extrapolate", {"tube0.obj", "tube1.obj", "--shapes", "3", "--steps", "2",
                                "--output", "on.path,on.glb,on.png,on/%d.ply"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(Files(),
            (Strings{"on", "on.glb", "on.path", "on.png", "on/0.ply", "on/1.ply", "on/2.ply",
                     "on/3.ply", "on/4.ply", "on/5.ply", "on/6.ply", "tube0.obj", "tube1.obj"}));
  const shapespace::Path path = ReadPath(Path("on.path"));
  EXPECT_EQ(path.poses, (std::vector<int>{0, 4}));
  EXPECT_EQ(path.extrapolated, 2);
  ASSERT_EQ(path.NumShapes(), 7);
  for (int i = 0; i < 7; ++i) {
    EXPECT_NEAR(path.parameters[i], i / 4.0, 1e-12);
    EXPECT_TRUE(Vertices("on/" + std::to_string(i) + ".ply") == path.Placed(i)) << i;
  }
  ExpectContains(path.provenance, "shape-extrapolate ");
  ExpectContains(path.provenance, ": tube0.obj tube1.obj");
  EXPECT_EQ(Content(Path("on.glb")).substr(0, 4), "glTF");
  ExpectContains(outcome.out, "2 poses, 3 shapes inserted");  // the summary of the interpolation
  ExpectQuiet(outcome);
}

TEST_F(ExtrapolateTest, EndsBeforeContactIfAskedTo) {
  MakeTubes();
  const Outcome outcome =
      Run("shape-extrapolate", {"tube0.obj", "tube1.obj", "--shapes", "1", "--steps", "12",
                                "--stop_at_contact", "--output", "on.path", "--report", "on.json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(outcome.out, "ended before contact");
  const auto report = nlohmann::json::parse(Content(Path("on.json")));
  EXPECT_EQ(report["termination"], "contact");
  EXPECT_EQ(report["converged"], true);
  const shapespace::Path path = ReadPath(Path("on.path"));
  EXPECT_GT(path.extrapolated, 1);
  EXPECT_LT(path.extrapolated, 12);
}

TEST_F(ExtrapolateTest, APathGoesOnWithAllThatItIs) {
  MakeWalk();
  Succeed("shape-extrapolate", {"walk.path", "--steps", "3", "--output", "on.path"});
  const shapespace::Path walk = ReadPath(Path("walk.path")), on = ReadPath(Path("on.path"));
  ASSERT_EQ(on.NumShapes(), 8);
  EXPECT_EQ(on.poses, walk.poses);
  EXPECT_EQ(on.extrapolated, 3);
  EXPECT_EQ(on.metric->unit, walk.metric->unit);
  EXPECT_EQ(DescribeMetric(on.metric->options), DescribeMetric(walk.metric->options));
  for (int i = 0; i < 5; ++i) EXPECT_TRUE(on.Placed(i) == walk.Placed(i)) << i;
  EXPECT_EQ(on.provenance.rfind(walk.provenance + "; shape-extrapolate ", 0), 0u);
  ExpectContains(on.provenance, ": walk.path");

  // Extrapolating again: all shapes that were ever extrapolated are counted.
  Succeed("shape-extrapolate", {"on.path", "--steps", "1", "--output", "again.path"});
  const shapespace::Path again = ReadPath(Path("again.path"));
  EXPECT_EQ(again.NumShapes(), 9);
  EXPECT_EQ(again.poses, walk.poses);
  EXPECT_EQ(again.extrapolated, 4);
}

// The two shapes must be accurate, because shooting amplifies their errors. At tolerances of 1e-8,
// 1e-10 and 1e-12, round trips had errors of 2e-5, 3e-6 and 2e-7 of the diameter.
TEST_F(ExtrapolateTest, ShotFromItsFirstTwoShapesAPathComesBack) {
  Succeed("shape-body", {"bar", "--triangles", "300", "--at", "0,90", "--output", "bar%d.obj"});
  Succeed("shape-interpolate", {"bar0.obj", "bar1.obj", "--shapes", "7", "--tolerance", "1e-12",
                                "--output", "bar.path"});
  Succeed("shape-extrapolate",
          {"bar.path", "--keep", "2", "--steps", "7", "--output", "back.path"});
  const shapespace::Path there = ReadPath(Path("bar.path")), back = ReadPath(Path("back.path"));
  ASSERT_EQ(back.NumShapes(), 9);
  EXPECT_EQ(back.poses, std::vector<int>{0});
  EXPECT_EQ(back.extrapolated, 7);
  const Shape first = there.Placed(0);
  const double diameter = (first.rowwise().maxCoeff() - first.rowwise().minCoeff()).norm();
  for (int i = 0; i < 9; ++i) {
    const Shape apart = back.Placed(i) - there.Placed(i);
    EXPECT_LE(apart.colwise().norm().maxCoeff(), 1e-6 * diameter) << i;
    EXPECT_NEAR(back.parameters[i], there.parameters[i], 1e-12);
  }
}

TEST_F(ExtrapolateTest, KeepLeavesOutLaterPoses) {
  MakeTubes();
  Succeed("shape-extrapolate", {"tube0.obj", "tube1.obj", "--shapes", "3", "--keep", "3", "--steps",
                                "1", "--output", "on.path,%d.obj"});
  const shapespace::Path path = ReadPath(Path("on.path"));
  EXPECT_EQ(path.NumShapes(), 4);
  EXPECT_EQ(path.poses, std::vector<int>{0});
  EXPECT_EQ(path.extrapolated, 1);
  EXPECT_EQ(Files().size(), 4u + 1 + 2);
}

TEST_F(ExtrapolateTest, ColoursTellPosesInterpolatedAndExtrapolatedShapes) {
  MakeTubes();
  Succeed("shape-extrapolate", {"tube0.obj", "tube1.obj", "--shapes", "1", "--steps", "2",
                                "--output", "on.path,on.png"});
  EXPECT_EQ(CellColours(Path("on.png"), 5), "bgbpp");
  Succeed("shape-export", {"on.path", "--at", "0,.3,1,1.2,1.5", "--output", "at.png"});
  EXPECT_EQ(CellColours(Path("at.png"), 5), "bgbpp");
  Succeed("shape-extrapolate", {"on.path", "--keep", "2", "--steps", "1", "--output", "kept.png"});
  EXPECT_EQ(CellColours(Path("kept.png"), 3), "bgp");
}

TEST_F(ExtrapolateTest, OtherToolsShowWhatGoesOn) {
  MakeWalk();
  Succeed("shape-extrapolate", {"walk.path", "--steps", "4", "--output", "on.path,solved%d.ply"});
  // The whole path at evenly spaced times: at the first and the last shape, and at one between.
  Succeed("shape-export", {"on.path", "--frames", "5", "--output", "even%d.ply"});
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(Vertices("even" + std::to_string(i) + ".ply") ==
                Vertices("solved" + std::to_string(2 * i) + ".ply"))
        << i;
  }
  const Outcome inspected = Run("shape-inspect", {"on.path"});
  EXPECT_EQ(inspected.code, 0) << inspected.err;
  ExpectContains(inspected.out, "9 shapes, 2 of them given, 4 extrapolated; 152 vertices");
  ExpectContains(inspected.out, "from the lengths in the first shape");
  ExpectLacks(Run("shape-inspect", {"walk.path"}).out, "extrapolated");
}

TEST_F(ExtrapolateTest, ReportsGoWhereTheyAreSent) {
  MakeWalk();
  const Outcome on_stdout = Run(
      "shape-extrapolate", {"walk.path", "--steps", "2", "--output", "on.path", "--report", "-"});
  ASSERT_EQ(on_stdout.code, 0) << on_stdout.err;
  const nlohmann::json report = nlohmann::json::parse(on_stdout.out, nullptr, false);
  ASSERT_TRUE(report.is_object()) << on_stdout.out;
  EXPECT_EQ(report["vertices"], 152);
  EXPECT_EQ(report["requested_steps"], 2);
  EXPECT_EQ(report["steps"].size(), 2u);
  EXPECT_NE(on_stdout.err, "");  // the line that is otherwise on stdout
  for (const char* file : {"r.json", "r.txt"}) {
    const Outcome in_file =
        Run("shape-extrapolate", {"tube0.obj", "tube1.obj", "--shapes", "1", "--steps", "2",
                                  "--output", "on.path", "--report", file});
    ASSERT_EQ(in_file.code, 0) << in_file.err;
    EXPECT_NE(in_file.out, "");
    EXPECT_NE(Content(Path(file)), "");
  }
  EXPECT_EQ(nlohmann::json::parse(Content(Path("r.json")))["requested_steps"], 2);
}

TEST_F(ExtrapolateTest, EveryIntegratorAndSolverOfStepsCanBeChosen) {
  MakeWalk();
  const auto end = [&](const Strings& flags) {
    Strings arguments = {"walk.path", "--steps", "1", "--output", "on.path"};
    arguments.insert(arguments.end(), flags.begin(), flags.end());
    Succeed("shape-extrapolate", arguments);
    return ReadPath(Path("on.path")).Placed(5);
  };
  const Shape variational = end({});
  const Shape bent = Vertices("tube1.obj");
  const double size = (bent.rowwise().maxCoeff() - bent.rowwise().minCoeff()).norm();
  const auto apart = [&](const Shape& shape) {
    return (shape - variational).colwise().norm().maxCoeff() / size;
  };
  // Two solvers of the same equations agree; another integrator is close, but different.
  EXPECT_LT(apart(end({"--step_solver", "newton_krylov"})), 1e-8);
  EXPECT_LT(apart(end({"--step_solver", "ceres"})), 1e-6);
  const double distance = apart(end({"--integrator", "first_integral"}));
  EXPECT_GT(distance, 1e-8);
  EXPECT_LT(distance, 0.2);
}

TEST_F(ExtrapolateTest, CorrectionBringsEdgesBackToTheFirstShapesLengths) {
  MakeWalk();
  Succeed("shape-extrapolate", {"walk.path", "--steps", "4", "--output", "on.path"});
  Succeed("shape-extrapolate", {"walk.path", "--steps", "4", "--correct", "1", "--output",
                                "corrected.path", "--report", "corrected.json"});
  const shapespace::Path on = ReadPath(Path("on.path")),
                         corrected = ReadPath(Path("corrected.path"));
  EXPECT_EQ(corrected.NumShapes(), 9);
  EXPECT_EQ(corrected.extrapolated, 4);
  EXPECT_TRUE(corrected.Placed(0) == on.Placed(0));
  EXPECT_LT(MeasureQuality(corrected).first_rms, 0.9 * MeasureQuality(on).first_rms);
  const auto report = nlohmann::json::parse(Content(Path("corrected.json")));
  EXPECT_NEAR(report["correction"]["quality"]["first_rms"].get<double>(),
              MeasureQuality(corrected).first_rms, 1e-9);
}

TEST_F(ExtrapolateTest, WrongCommandLines) {
  MakeWalk();
  const Strings before = Files();
  const struct {
    Strings arguments;
    const char* message;
  } cases[] = {
      {{}, "name at least two poses of one mesh, or one .path file alone"},
      {{"tube0.obj"}, "tube0.obj has one pose; name at least two poses of one mesh"},
      {{"walk.path", "tube1.obj"}, "or one .path file alone"},
      {{"walk.path", "walk.path"}, "or one .path file alone"},
      {{"walk.path", "--steps", "0"}, "--steps must be 1 or more"},
      {{"walk.path", "--keep", "1"}, "--keep must be 2 or more, or 0 for all"},
      {{"walk.path", "--keep=-2"}, "--keep must be 2 or more, or 0 for all"},
      {{"walk.path", "--keep", "6"}, "--keep 6: the path has 5 shapes"},
      {{"tube0.obj", "tube1.obj", "--keep", "18"}, "--keep 18: the path has 17 shapes"},
      {{"walk.path", "--lambda", "0.001"}, "--lambda: goes with poses"},
      {{"walk.path", "--shapes", "15"}, "--shapes: goes with poses"},
      {{"walk.path", "--integrator", "euler"},
       "--integrator euler: must be one of variational, first_integral"},
      {{"walk.path", "--step_solver", "lbfgs"},
       "--step_solver lbfgs: must be one of newton_krylov, ceres"},
      {{"walk.path", "--step_iterations", "0"}, "--step_iterations 0: must be"},
      {{"walk.path", "--correct=-1"}, "--correct -1: must be"},
      {{"walk.path", "--report", "r.html"}, "--report r.html: must end in .json or .txt, or be -"},
      {{"walk.path", "--output", "on.tif"}, "on.tif: must end in"},
  };
  for (const auto& [arguments, message] : cases) {
    SCOPED_TRACE(message);
    const Outcome outcome = Run("shape-extrapolate", arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    ExpectContains(outcome.err, message);
    ExpectContains(outcome.err, "--help");
    EXPECT_EQ(Files(), before);
  }
  EXPECT_EQ(Run("shape-extrapolate", {"nowhere.path"}).code, 1);
}

// Continued to three times its length under this metric, the motion comes to a halt.
TEST_F(ExtrapolateTest, WhatIsMadeBeforeAShapeDegeneratesIsWritten) {
  MakeTubes(150);
  const Outcome some =
      Run("shape-extrapolate", {"tube0.obj", "tube1.obj", "--metric", "isometric", "--shapes", "1",
                                "--steps", "30", "--output", "some.path"});
  EXPECT_EQ(some.code, 0) << some.err;
  ExpectContains(some.err, "stopped early, at step ");
  const shapespace::Path path = ReadPath(Path("some.path"));
  EXPECT_GT(path.extrapolated, 0);
  EXPECT_LT(path.extrapolated, 30);
  EXPECT_EQ(path.NumShapes(), 3 + path.extrapolated);

  // Where it came to a halt, rounding may leave room for a few more shapes, but not for many.
  std::string last = "some.path";
  Outcome none;
  for (const char* next : {"a.path", "b.path", "c.path", "d.path", "e.path"}) {
    none = Run("shape-extrapolate", {last, "--steps", "3", "--output", next, "--report", "r.json"});
    if (none.code != 0) {
      EXPECT_EQ(ReadPath(Path(next)).shapes, ReadPath(Path(last)).shapes);
      break;
    }
    last = next;
  }
  EXPECT_EQ(none.code, 1) << none.err;
  ExpectContains(none.err, "stopped early, at step 1: ");
  ExpectContains(none.err, "no shape could be added");
  EXPECT_EQ(nlohmann::json::parse(Content(Path("r.json")))["ending"], "degenerate");
}

TEST_F(ExtrapolateTest, RigidMetricsAreRefused) {
  MakeTubes();
  Succeed("shape-interpolate", {"tube0.obj", "tube1.obj", "--shapes", "3", "--metric", "rigid",
                                "--output", "rigid.path"});
  const Outcome outcome = Run("shape-extrapolate", {"rigid.path", "--output", "on.path"});
  EXPECT_EQ(outcome.code, 1) << outcome.err;
  ExpectContains(outcome.err, "rigid.path: was computed under the rigid metric");
  const Outcome poses = Run("shape-extrapolate", {"tube0.obj", "tube1.obj", "--metric", "rigid"});
  EXPECT_EQ(poses.code, 2);
  ExpectContains(poses.err, "--rigid");
}

}  // namespace
}  // namespace shapespace
