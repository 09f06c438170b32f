#include <shapespace/bodies/body.h>
#include <shapespace/bodies/quadruped.h>
#include <shapespace/bodies/skinned.h>
#include <shapespace/files/read.h>
#include <shapespace/statistics/pose_table.h>

#include "tools/run.h"

namespace shapespace {
namespace {

using testing::ExpectContains;
using testing::Outcome;
using testing::ToolsTest;

class BodyToolTest : public ToolsTest {};

TEST_F(BodyToolTest, ListsEveryBody) {
  const Outcome outcome = Run("shape-body", {});
  EXPECT_EQ(outcome.code, 0);
  for (const BodyInfo& info : ListBodies()) {
    ExpectContains(outcome.out, info.name + ": " + info.description);
  }
}

TEST_F(BodyToolTest, WritesBothEndsByDefault) {
  ASSERT_EQ(Run("shape-body", {"bricard"}).code, 0);
  EXPECT_EQ(Files(), (std::vector<std::string>{"body0.obj", "body1.obj"}));
  const ShapeFamily body = MakeBody("bricard");
  EXPECT_LE((ReadSoup(Path("body0.obj")).vertices - body.pose(body.begin)).cwiseAbs().maxCoeff(),
            1e-8);
  EXPECT_LE((ReadSoup(Path("body1.obj")).vertices - body.pose(body.end)).cwiseAbs().maxCoeff(),
            1e-8);
}

TEST_F(BodyToolTest, WritesOneFileAValue) {
  ASSERT_EQ(Run("shape-body", {"sheet", "--at", "0.1,0.2,0.3", "--output", "a/b/%02d.ply"}).code,
            0);
  EXPECT_EQ(Files(),
            (std::vector<std::string>{"a", "a/b", "a/b/00.ply", "a/b/01.ply", "a/b/02.ply"}));
}

TEST_F(BodyToolTest, OneShapeNeedsNoNumberInItsName) {
  Succeed("shape-body", {"quadruped", "--triangles", "500", "--random", "1", "--output", "a.obj",
                         "--table", "a.csv"});
  EXPECT_EQ(Files(), (std::vector<std::string>{"a.csv", "a.obj"}));
  EXPECT_EQ(ReadPoseTable(Path("a.csv")).NumbersOf({"a"}).rows(), 1);
}

TEST_F(BodyToolTest, ListsPosesAndProportions) {
  const Outcome outcome = Run("shape-body", {});
  ExpectContains(outcome.out,
                 "poses of quadruped: stand, stride, sit, stretch, rear, pass, "
                 "other_stride, other_pass\n");
  ExpectContains(outcome.out, "proportions of quadruped: normal, long, short, heavy\n");
}

TEST_F(BodyToolTest, WritesNamedPosesInNamedProportions) {
  Succeed("shape-body", {"quadruped", "--triangles", "500", "--pose", "sit,stand", "--proportions",
                         "long", "--output", "animal%d.obj"});
  EXPECT_EQ(Files(), (std::vector<std::string>{"animal0.obj", "animal1.obj"}));
  const SkinnedBody body = MakeSkinnedBody("quadruped", 500, "long");
  EXPECT_LE((ReadSoup(Path("animal0.obj")).vertices - body.pose("sit")).cwiseAbs().maxCoeff(),
            1e-8);
  EXPECT_LE((ReadSoup(Path("animal1.obj")).vertices - body.pose("stand")).cwiseAbs().maxCoeff(),
            1e-8);
}

TEST_F(BodyToolTest, WritesAHerdOfRandomAnimals) {
  const std::vector<std::string> herd = {"quadruped", "--triangles", "500", "--random",
                                         "3",         "--seed",      "4",   "--table"};
  std::vector<std::string> first = herd;
  first.insert(first.end(), {"a.csv", "--output", "a%d.obj"});
  Succeed("shape-body", first);
  EXPECT_EQ(Files(), (std::vector<std::string>{"a.csv", "a0.obj", "a1.obj", "a2.obj"}));
  const PoseTable table = ReadPoseTable(Path("a.csv"));
  EXPECT_EQ(table.columns.size(), 9u);
  const Eigen::MatrixXd measures = table.NumbersOf({"a0", "a1", "a2"});
  // The table and the files are of the same animals, in poses of their own.
  QuadrupedForm form;
  form.body_length = measures(1, 0), form.body_girth = measures(1, 1);
  form.neck_length = measures(1, 2), form.neck_girth = measures(1, 3);
  form.head_size = measures(1, 4), form.ear_length = measures(1, 5);
  form.leg_length = measures(1, 6), form.leg_girth = measures(1, 7);
  form.tail_length = measures(1, 8);
  const SkinnedBody body = MakeQuadruped(500, form);
  const Shape second = ReadSoup(Path("a1.obj")).vertices;
  EXPECT_LE((second - body.random_pose(5)).cwiseAbs().maxCoeff(), 1e-8);
  EXPECT_GT((ReadSoup(Path("a2.obj")).vertices - second).cwiseAbs().maxCoeff(), 0.1);
}

TEST_F(BodyToolTest, RefusesWhatItCannotMake) {
  const struct {
    std::vector<std::string> arguments;
    const char* message;
  } cases[] = {
      {{"spoon"}, "no body is called 'spoon'; known are tube"},
      {{"tube", "bar"}, "name one body"},
      {{"quadruped", "--pose", "fly"}, "'fly'; known are stand, stride, sit, stretch, rear, pass,"},
      {{"quadruped", "--pose", "sit", "--proportions", "huge"},
       "'huge'; known are normal, long, short, heavy"},
      {{"quadruped", "--proportions", "long"}, "--proportions needs --pose or --random"},
      {{"quadruped", "--random=-1"}, "--random must be at least 1"},
      {{"tube", "--random", "2"}, "--random is for quadruped alone"},
      {{"quadruped", "--random", "2", "--pose", "sit"}, "--random excludes --at and --pose"},
      {{"quadruped", "--table", "t.csv"}, "--table needs --random"},
      {{"quadruped", "--random", "2", "--table", "t.txt"}, "--table t.txt: must end in .csv"},
      {{"quadruped", "--pose", "sit", "--at", "1"}, "--at and --pose exclude each other"},
      {{"tube", "--pose", "sit"}, "no body with bones is called 'tube'; known are quadruped"},
      {{"tube", "--at", "0,x"}, "--at 0,x: 'x' is not a number"},
      {{"tube", "--at", "200"}, "--at 200: 200 is outside 0 .. 150"},
      {{"tube", "--triangles=-5"}, "--triangles -5: -5 is outside"},
      {{"tube", "--output", "tube.obj"}, "there are 2"},
      {{"tube", "--output", "tube%d%d.obj"}, "needs one number"},
      {{"tube", "--output", "tube%d.glb"}, "must end in .obj, .ply, .off or .stl"},
  };
  for (const auto& [arguments, message] : cases) {
    const Outcome outcome = Run("shape-body", arguments);
    EXPECT_EQ(outcome.code, 2) << message;
    ExpectContains(outcome.err, message);
    ExpectContains(outcome.err, "Try shape-body --help");
  }
  EXPECT_TRUE(Files().empty());
}

}  // namespace
}  // namespace shapespace
