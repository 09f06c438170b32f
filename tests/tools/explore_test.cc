#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <random>
#include <thread>

#include <nlohmann/json.hpp>

#include <shapespace/files/read.h>
#include <shapespace/statistics/pose_table.h>

#include "tools/run.h"

namespace shapespace {
namespace {

namespace fs = std::filesystem;

using testing::Content;
using testing::ExpectContains;
using testing::Outcome;
using testing::ToolsTest;

class ExploreToolTest : public ToolsTest {
 protected:
  // Four poses of the quadruped.
  void MakePoses() const {
    Succeed("shape-body", {"quadruped", "--pose", "stand,stride,sit,stretch", "--triangles", "1500",
                           "--output", "pose%d.obj"});
  }
  std::vector<std::string> WithPoses(std::vector<std::string> arguments) const {
    const std::vector<std::string> poses = {"pose0.obj", "pose1.obj", "pose2.obj", "pose3.obj"};
    arguments.insert(arguments.begin(), poses.begin(), poses.end());
    return arguments;
  }
};

TEST_F(ExploreToolTest, MakesASpaceMeasuresItAndWalksThroughIt) {
  MakePoses();
  const Outcome made = Run("shape-explore", WithPoses({"--depth", "1", "--output", "p.space",
                                                       "--report", "r.json", "--measure", "20"}));
  ASSERT_EQ(made.code, 0) << made.err;
  ExpectContains(made.out, "converged: 4 poses");
  ExpectContains(made.out, "at 20 points");
  const nlohmann::json report = nlohmann::json::parse(Content(Path("r.json")));
  EXPECT_EQ(report["found"], 0);
  EXPECT_FALSE(fs::exists(Path("p.space.records")));

  const Outcome inspected = Run("shape-inspect", {"p.space"});
  EXPECT_EQ(inspected.code, 0) << inspected.err;
  ExpectContains(inspected.out, "of which 4 are poses");
  ExpectContains(inspected.out, "pose3\n");

  File("curve.json", R"({"points": ["pose0", "pose3", "pose2"]})");
  const Outcome walk = Run("shape-explore", {"--sample", "curve.json", "p.space", "--frames", "9",
                                             "--output", "walk.glb,frames/%d.obj"});
  ASSERT_EQ(walk.code, 0) << walk.err;
  ExpectQuiet(walk);
  EXPECT_TRUE(fs::exists(Path("frames/8.obj")));
  EXPECT_FALSE(fs::exists(Path("frames/9.obj")));
  // The curve begins at the first pose, which is unchanged.
  const Poses first = ReadPoses({Path("pose0.obj"), Path("frames/0.obj")});
  EXPECT_LT((first.shapes[0] - first.shapes[1]).cwiseAbs().maxCoeff(), 1e-12);

  File("far.json", R"({"points": ["pose0", [1e9, 0]]})");
  const Outcome far = Run(
      "shape-explore", {"--sample", "far.json", "p.space", "--frames", "3", "--output", "far.glb"});
  EXPECT_EQ(far.code, 0);
  ExpectContains(far.err, "outside");
}

TEST_F(ExploreToolTest, KilledAtAnyTimeItGoesOn) {
  MakePoses();
  const auto begin = std::chrono::steady_clock::now();
  Succeed("shape-explore", WithPoses({"--output", "whole.space"}));
  const std::chrono::duration<double> whole = std::chrono::steady_clock::now() - begin;
  std::mt19937 random(11);
  size_t most = 0;
  for (int i = 0; i < 10; ++i) {
    const int null = open("/dev/null", O_WRONLY);
    const pid_t process =
        Start("shape-explore", WithPoses({"--output", "killed.space"}), null, null);
    std::this_thread::sleep_for(std::uniform_real_distribution<double>(0, 0.5)(random) * whole);
    kill(process, SIGKILL);
    Wait(process);
    close(null);
    size_t records = 0;
    if (fs::exists(Path("killed.space.records"))) {
      for (const auto& entry : fs::directory_iterator(Path("killed.space.records"))) {
        if (entry.path().extension() == ".geodesic") ++records;
      }
    }
    most = std::max(most, records);
  }
  const bool was_left = fs::exists(Path("killed.space.records"));
  const Outcome last =
      Run("shape-explore", WithPoses({"--output", "killed.space", "--report", "r.json"}));
  EXPECT_EQ(last.code, 0);
  const nlohmann::json report = nlohmann::json::parse(Content(Path("r.json")));
  const int found = report["found"], solved = report["solved"];
  if (was_left) {
    ExpectContains(last.err, "note: of " + std::to_string(found + solved) + " geodesics, " +
                                 std::to_string(found) +
                                 " were taken from killed.space.records, the records of an earlier "
                                 "run\n");
  }
  EXPECT_GT(most, 0u);
  EXPECT_TRUE(Content(Path("killed.space")) == Content(Path("whole.space")));
  EXPECT_FALSE(fs::exists(Path("killed.space.records")));
}

TEST_F(ExploreToolTest, MeasuringLeavesTheRecordsOfAnEndedRun) {
  MakePoses();
  Succeed("shape-explore", WithPoses({"--depth", "0", "--output", "p.space"}));
  fs::create_directory(Path("p.space.records"));
  File("p.space.records/0123.geodesic", "left by another run");
  Succeed("shape-explore", {"--measure", "3", "--resolution", "500", "p.space"});
  EXPECT_TRUE(fs::exists(Path("p.space.records/0123.geodesic")));
  EXPECT_FALSE(fs::exists(Path("p.space.measure.records")));
}

TEST_F(ExploreToolTest, NamesOfPosesMayBeOfAnyBytes) {
  MakePoses();
  fs::copy_file(Path("pose0.obj"), Path("k\xf6rper.obj"));
  const Outcome outcome =
      Run("shape-explore", {"pose0.obj", "pose1.obj", "pose2.obj", "k\xf6rper.obj", "--depth", "0",
                            "--output", "p.space", "--report", "r.json"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(Content(Path("r.json")), "is at the position of an earlier pose");
}

TEST_F(ExploreToolTest, AnyNumberOfRanksMakesTheSameFile) {
  if (std::system("mpirun --version >/dev/null 2>&1") != 0) GTEST_SKIP() << "there is no mpirun";
  MakePoses();
  setenv("OMPI_ALLOW_RUN_AS_ROOT", "1", 1);
  setenv("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1", 1);
  const std::string poses = " pose0.obj pose1.obj pose2.obj pose3.obj ";
  const auto run = [&](int ranks, const std::string& arguments) {
    const std::string command = "cd '" + Path("") + "' && mpirun --oversubscribe -n " +
                                std::to_string(ranks) + " " SHAPESPACE_TOOLS_DIR "/shape-explore" +
                                arguments + " >out 2>err";
    return std::system(command.c_str());
  };
  Succeed("shape-explore", WithPoses({"--output", "alone.space"}));
  for (const auto& [ranks, threads] :
       std::vector<std::pair<int, int>>{{1, 1}, {2, 1}, {4, 1}, {2, 3}}) {
    ASSERT_EQ(run(ranks, poses + "--threads " + std::to_string(threads) + " --output ranks.space"),
              0)
        << Content(Path("err"));
    EXPECT_TRUE(Content(Path("ranks.space")) == Content(Path("alone.space"))) << ranks;
    const std::string out = Content(Path("out"));
    EXPECT_EQ(out.find("converged"), out.rfind("converged")) << "said more than once: " << out;
  }
  EXPECT_NE(run(2, " pose0.obj none.obj --output ranks2.space"), 0);
  ExpectContains(Content(Path("err")), "none.obj");
  EXPECT_NE(run(2, poses + "--depth x"), 0);
  EXPECT_EQ(WEXITSTATUS(run(2, poses + "--threshold 0")), 2);
  ExpectContains(Content(Path("err")), "--threshold 0:");
}

TEST_F(ExploreToolTest, DistancesAreLengthsOfGeodesics) {
  Succeed("shape-body", {"tube", "--triangles", "300", "--at", "0,30,60", "-o", "tube%d.obj"});
  Succeed("shape-explore", {"tube0.obj", "tube1.obj", "tube2.obj", "-o", "d.csv"});
  const PoseTable table = ReadPoseTable(Path("d.csv"));
  EXPECT_EQ(table.columns, (std::vector<std::string>{"tube0", "tube1", "tube2"}));
  const Eigen::MatrixXd distances = table.NumbersOf(table.poses);
  EXPECT_EQ(distances, distances.transpose());
  EXPECT_EQ(distances.diagonal().norm(), 0);
  // The straight tube is bent along a geodesic, so that distances nearly add up.
  EXPECT_NEAR(distances(0, 1) + distances(1, 2), distances(0, 2), 0.02 * distances(0, 2));
  EXPECT_LE(distances(0, 2), distances(0, 1) + distances(1, 2));
  const Outcome outcome =
      Run("shape-explore", {"tube0.obj", "tube1.obj", "-o", "d.csv", "--depth", "1"});
  EXPECT_EQ(outcome.code, 2);
  ExpectContains(outcome.err, "--depth: goes with a .space");
  EXPECT_FALSE(fs::exists(Path("d.csv.records")));
}

TEST_F(ExploreToolTest, WhatIsWrongIsNamed) {
  MakePoses();
  const auto expect = [&](int code, const std::vector<std::string>& arguments,
                          const std::vector<std::string>& parts) {
    const Outcome outcome = Run("shape-explore", arguments);
    EXPECT_EQ(outcome.code, code) << outcome.err;
    for (const std::string& part : parts) ExpectContains(outcome.err, part);
  };
  expect(2, {"pose0.obj"}, {"two poses"});
  expect(2, WithPoses({"--output", "a.path"}), {"--output a.path", ".space"});
  expect(2, WithPoses({"--threshold", "much"}), {"--threshold", "much"});
  expect(2, WithPoses({"--threshold", "0"}), {"--threshold 0"});
  expect(2, WithPoses({"--shapes", "4"}), {"--shapes 4", "odd"});
  expect(2, WithPoses({"--depth", "11"}), {"--depth 11"});
  expect(2, WithPoses({"--resolution", "-1"}), {"--resolution -1"});
  expect(2, WithPoses({"--metric", "rigid"}), {"rigid"});
  expect(2, WithPoses({"--frames", "3"}), {"--frames", "--sample"});
  expect(2, WithPoses({"--sample", "c.json"}), {"--sample", ".space"});
  expect(2, {"p.space"}, {"--sample", "--measure"});
  expect(1, {"--measure", "5", "none.space"}, {"none.space"});
  File("bad.space", "no");
  expect(1, {"--measure", "5", "bad.space"}, {"bad.space", "not a .space file"});

  Succeed("shape-explore", WithPoses({"--depth", "0", "--output", "p.space"}));
  expect(2, {"--measure", "5", "p.space", "--depth", "3"}, {"--depth", "goes with poses"});
  expect(2, {"--measure", "5", "p.space", "--bending", "1"}, {"--bending", "goes with poses"});
  expect(2, {"--sample", "c.json", "p.space"}, {"--sample", "--output"});
  expect(2, {"--sample", "c.json", "p.space", "--output", "w.glb", "--threshold", "1"},
         {"--threshold", "--sample"});
  File("c.json", R"({"points": ["nobody"]})");
  expect(1, {"--sample", "c.json", "p.space", "--output", "w.glb"}, {"c.json", "nobody"});
  File("d.json", R"({"points": ["pose0"]})");
  expect(2, {"--sample", "d.json", "p.space", "--output", "w.path"}, {"w.path", "not a geodesic"});
  expect(2, {"--sample", "d.json", "p.space", "--frames", "0", "--output", "w.glb"},
         {"--frames 0"});
  const std::string before = Content(Path("p.space"));
  expect(2, {"pose0.obj", "p.space.obj", "--output", "p.space.obj"}, {"--output"});
  EXPECT_TRUE(Content(Path("p.space")) == before);
  EXPECT_FALSE(fs::exists(Path("w.glb")));
}

}  // namespace
}  // namespace shapespace
