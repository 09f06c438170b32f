#include <cstdio>
#include <filesystem>
#include <fstream>

#include <nlohmann/json.hpp>

#include <shapespace/files/read.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/statistics/pose_table.h>

#include "tools/run.h"

namespace shapespace {
namespace {

using testing::Content;
using testing::ExpectContains;
using testing::Outcome;
using testing::ToolsTest;

class StatisticsToolTest : public ToolsTest {
 protected:
  static constexpr const char* kPoses[] = {"pose0.obj", "pose1.obj", "pose2.obj", "pose3.obj"};

  void MakePoses() const {
    Succeed("shape-body", {"quadruped", "--pose", "stand,stride,sit,stretch", "--triangles", "600",
                           "--output", "pose%d.obj"});
  }
  static std::vector<std::string> WithPoses(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), std::begin(kPoses), std::end(kPoses));
    return arguments;
  }
  void MakeModes() const {
    MakePoses();
    Succeed("shape-statistics", WithPoses({"--modes", "2", "--output", "herd.modes"}));
  }
  bool Exists(const std::string& file) const { return std::filesystem::exists(Path(file)); }
  Shape Read(const std::string& file) const { return ReadSoup(Path(file)).vertices; }
  void ExpectUsage(const std::vector<std::string>& arguments, const std::string& message) const {
    const Outcome outcome = Run("shape-statistics", arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    ExpectContains(outcome.err, message);
  }
};

TEST_F(StatisticsToolTest, AverageIsWrittenAndCertified) {
  MakePoses();
  const Outcome outcome =
      Run("shape-average", WithPoses({"--output", "mean.obj,mean.png", "--report", "r.json"}));
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(outcome.out, "converged: 296 vertices, average of 4 poses");
  const nlohmann::json report = nlohmann::json::parse(Content(Path("r.json")));
  EXPECT_GT(report["ratio"], 1);
  EXPECT_LT(report["ratio"], 1.1);
  EXPECT_TRUE(Exists("mean.png"));
  EXPECT_EQ(Read("mean.obj").cols(), 296);
  // All the weight on one pose.
  Succeed("shape-average", WithPoses({"--weights", "0,0,3,0", "--output", "sit.obj"}));
  EXPECT_LT((Read("sit.obj") - Read("pose2.obj")).norm(), 1e-4 * Read("sit.obj").norm());
  // Refined, it is not farther from the poses.
  Succeed("shape-average", WithPoses({"--refine", "--output", "r.obj", "--report", "s.json"}));
  EXPECT_LE(nlohmann::json::parse(Content(Path("s.json")))["ratio"], report["ratio"]);
}

TEST_F(StatisticsToolTest, AverageNamesItsFlags) {
  MakePoses();
  const auto refused = [&](std::vector<std::string> arguments, const std::string& message) {
    const Outcome outcome = Run("shape-average", WithPoses(std::move(arguments)));
    EXPECT_EQ(outcome.code, 2);
    ExpectContains(outcome.err, message);
  };
  refused({"--weights", "1,2"}, "--weights 1,2: must be 4, one for each pose, not 2");
  refused({"--weights", "1,-2,1,1"}, "--weights 1,-2,1,1: must be finite and not negative");
  refused({"--metric", "rigid"}, "--rigid: is no feature");
  refused({"--output", "mean.path"}, "--output mean.path: must end in");
  refused({"--output", "pose1.obj"}, "pose1.obj");
}

TEST_F(StatisticsToolTest, ModesAreWrittenInAllForms) {
  MakePoses();
  const Outcome outcome =
      Run("shape-statistics",
          WithPoses({"--modes", "2", "--output", "herd.modes,m.png,mode%d.glb,herd.html,c.csv"}));
  // Without ./dev viewer there are no pages.
  if (outcome.code == 1) {
    ExpectContains(outcome.err, "./dev viewer");
    GTEST_SKIP() << "this build has no viewer";
  }
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(outcome.out, "4 poses, 2 modes");
  for (const char* file : {"herd.modes", "m.png", "mode1.glb", "mode2.glb", "herd.html"}) {
    EXPECT_TRUE(Exists(file)) << file;
  }
  EXPECT_FALSE(Exists("mode3.glb"));
  EXPECT_EQ(Content(Path("c.csv")).find("pose,mode 1,mode 2\npose0,"), 0u);
}

TEST_F(StatisticsToolTest, CoordinatesLeadBackToTheShape) {
  MakePoses();
  Succeed("shape-statistics", WithPoses({"--output", "herd.modes"}));
  const Outcome outcome = Run("shape-statistics", {"herd.modes", "--coordinates", "pose2.obj",
                                                   "--fit", "--output", "new.csv"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const std::string row = Content(Path("new.csv"));
  const size_t begin = row.find("pose2,") + 6;
  const std::string coordinates = row.substr(begin, row.rfind(',') - begin);
  Succeed("shape-statistics", {"herd.modes", "--at", coordinates, "--output", "again.obj"});
  const Shape truth = Read("pose2.obj"), again = Read("again.obj");
  const Shape placed = FitRigidMotion(again, truth, Eigen::VectorXd::Ones(truth.cols()))(again);
  EXPECT_LT((placed - truth).norm(), 1e-3 * truth.norm());
}

TEST_F(StatisticsToolTest, SamplesScalarsAndGroups) {
  MakeModes();
  Succeed("shape-statistics", {"herd.modes", "--sample", "2", "--output", "s%d.obj,s.csv"});
  EXPECT_TRUE(Exists("s1.obj"));
  EXPECT_NE(Content(Path("s0.obj")), Content(Path("s1.obj")));
  Succeed("shape-statistics",
          {"herd.modes", "--sample", "1", "--seed", "2", "--output", "next%d.obj"});
  EXPECT_EQ(Content(Path("next0.obj")), Content(Path("s1.obj")));
  File("ages.csv", "file,age\npose0.obj,1\npose1.obj,2\npose2.obj,3\npose3.obj,5\n");
  const Outcome scalars = Run("shape-statistics", {"herd.modes", "--scalars", "ages.csv",
                                                   "--predict", "7", "--output", "seven.obj"});
  ASSERT_EQ(scalars.code, 0) << scalars.err;
  ExpectContains(scalars.out, "of the variance (p = ");
  ExpectContains(scalars.err, "warning: age = 7 is outside of the poses' range, 1 to 5");
  File("groups.csv", "file,group\npose0,a\npose1,a\npose2,b\npose3,b\n");
  const Outcome groups =
      Run("shape-statistics", {"herd.modes", "--groups", "groups.csv", "--report", "g.json"});
  ASSERT_EQ(groups.code, 0) << groups.err;
  ExpectContains(groups.out, "a (2 poses) and b (2 poses)");
  EXPECT_EQ(nlohmann::json::parse(Content(Path("g.json")))[0]["second"], "b");
  const Outcome assessed = Run("shape-statistics", {"herd.modes", "--assess"});
  ASSERT_EQ(assessed.code, 0) << assessed.err;
  ExpectContains(assessed.out, "generalisation");
}

TEST_F(StatisticsToolTest, FarCoordinatesAreWarnedOf) {
  MakeModes();
  const Outcome outcome =
      Run("shape-statistics", {"herd.modes", "--at", "3.5", "--output", "far.obj"});
  EXPECT_EQ(outcome.code, 0);
  ExpectContains(outcome.err, "warning: a coordinate is 3.5 standard deviations from the mean");
}

TEST_F(StatisticsToolTest, RefusesWhatMakesNoSense) {
  MakeModes();
  ExpectUsage({}, "name poses of one mesh, or a .modes file");
  ExpectUsage({"herd.modes", "--at", "1", "--assess"}, "--at and --assess: ask one question");
  ExpectUsage({"herd.modes", "--at", "1,2,3", "--output", "a.obj"},
              "--at 1,2,3: must be at most 2, one for each mode, not 3");
  ExpectUsage({"herd.modes", "--at", "1"}, "--output: name a mesh to write");
  ExpectUsage({"herd.modes", "--fit"}, "--fit: goes with --coordinates or --assess");
  ExpectUsage({"herd.modes", "--lambda", "1"}, "--lambda: goes with poses");
  ExpectUsage({"herd.modes", "--output", "a.obj"}, "--output a.obj: must end in .modes, .png");
  ExpectUsage(WithPoses({"--modes", "9"}), "--modes 9: must be at most 3");
  ExpectUsage({"herd.modes", "--modes", "9"}, "--modes 9: must be from 0 to 2");
  File("ages.csv", "file,age\npose0.obj,1\npose1.obj,2\npose3.obj,5\n");
  const Outcome missing = Run("shape-statistics", {"herd.modes", "--scalars", "ages.csv"});
  EXPECT_EQ(missing.code, 1);
  ExpectContains(missing.err, "ages.csv: there is no row for the pose 'pose2'");
  Succeed("shape-body", {"tube", "--triangles", "200", "--output", "tube%d.obj"});
  const Outcome other = Run("shape-statistics", {"herd.modes", "--coordinates", "tube0.obj"});
  EXPECT_EQ(other.code, 1);
  ExpectContains(other.err, "tube0.obj");
}

TEST_F(StatisticsToolTest, InspectPrintsAModel) {
  MakeModes();
  Succeed("shape-statistics", {"herd.modes", "--output", "c.csv"});
  const Outcome outcome = Run("shape-inspect", {"herd.modes"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  ExpectContains(outcome.out, "herd.modes\n  made by ");
  ExpectContains(outcome.out, "mesh         296 vertices");
  ExpectContains(outcome.out, "poses        4\n  modes        2, with ");
  // The coordinates are those of the table.
  const Eigen::MatrixXd coordinates =
      ReadPoseTable(Path("c.csv")).NumbersOf({"pose0", "pose1", "pose2", "pose3"});
  char line[80];
  std::snprintf(line, sizeof(line), "  pose         at %7.3f %7.3f  pose2\n", coordinates(2, 0),
                coordinates(2, 1));
  ExpectContains(outcome.out, line);
  std::ofstream(Path("bad.modes")) << "nothing";
  const Outcome bad = Run("shape-inspect", {"bad.modes"});
  EXPECT_EQ(bad.code, 1);
  ExpectContains(bad.err, "bad.modes");
}

}  // namespace
}  // namespace shapespace
