#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <shapespace/files/read.h>
#include <shapespace/files/write.h>
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

class TransferTest : public ToolsTest {
 protected:
  Shape Vertices(const std::string& file) const { return ReadSoup(Path(file)).vertices; }

  /// tube0.obj, tube1.obj, tube2.obj: a tube bent by 0, 40 and 20 degrees; thin.obj: the first one,
  /// longer and thinner.
  void MakeBodies() const {
    Succeed("shape-body",
            {"tube", "--triangles", "300", "--at", "0,40,20", "--output", "tube%d.obj"});
    const Soup tube = ReadSoup(Path("tube0.obj"));
    WriteMesh(Path("thin.obj"), Eigen::Vector3d(1.4, 0.8, 0.8).asDiagonal() * tube.vertices, tube);
  }

  /// The largest distance between corresponding vertices, over the diameter.
  double Apart(const std::string& file, const Shape& other) const {
    const Shape shape = Vertices(file);
    return (shape - other).colwise().norm().maxCoeff() /
           (other.rowwise().maxCoeff() - other.rowwise().minCoeff()).norm();
  }
};

TEST_F(TransferTest, TheLadderMakesAFrameOfEveryPose) {
  MakeBodies();
  const Outcome outcome = Run(
      "shape-transfer", {"tube0.obj", "tube1.obj", "tube2.obj", "--target", "thin.obj", "--shapes",
                         "3", "--method", "ladder", "--output", "out/%02d.obj,out.path,out.png",
                         "--hybrids", "mid/%02d.ply,mid.path"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(Files(), (Strings{"mid", "mid.path", "mid/00.ply", "mid/01.ply", "mid/02.ply", "out",
                              "out.path", "out.png", "out/00.obj", "out/01.obj", "out/02.obj",
                              "thin.obj", "tube0.obj", "tube1.obj", "tube2.obj"}));
  EXPECT_LT(Apart("out/00.obj", Vertices("thin.obj")), 1e-8);
  const shapespace::Path path = ReadPath(Path("out.path"));
  ASSERT_EQ(path.NumShapes(), 3);
  EXPECT_EQ(path.poses, std::vector<int>{0});
  EXPECT_EQ(path.extrapolated, 2);
  EXPECT_EQ(DescribeMetric(path.metric->options), "strain 1, lambda 0.0001, bending 0.02");
  ExpectContains(path.provenance, "shape-transfer ");
  ExpectContains(path.provenance, ": tube0.obj tube1.obj tube2.obj thin.obj");
  const shapespace::Path hybrids = ReadPath(Path("mid.path"));
  ASSERT_EQ(hybrids.NumShapes(), 3);
  EXPECT_TRUE(hybrids.poses.empty());
  for (int i = 0; i < 3; ++i) {
    const std::string number = std::to_string(i);
    EXPECT_LT(Apart("out/0" + number + ".obj", path.Placed(i)), 1e-8);
    EXPECT_TRUE(Vertices("mid/0" + number + ".ply") == hybrids.Placed(i));
  }
  // Each pose is reached from the reference, independently of the poses before it.
  Succeed("shape-transfer", {"tube0.obj", "tube2.obj", "--target", "thin.obj", "--shapes", "3",
                             "--method", "ladder", "--output", "alone%d.obj"});
  EXPECT_LT(Apart("alone1.obj", path.Placed(2)), 1e-8);
  ExpectContains(outcome.out, "converged: 152 vertices, 2 poses in 8 steps");
  ExpectQuiet(outcome);
}

TEST_F(TransferTest, EveryPoseMakesAFrame) {
  MakeBodies();
  const Outcome outcome =
      Run("shape-transfer",
          {"tube0.obj", "tube1.obj", "tube2.obj", "--target", "thin.obj", "--output",
           "out/%02d.obj,out.path,out.png", "--hybrids", "mid/%02d.ply", "--report", "r.json"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(Files(), (Strings{"mid", "mid/00.ply", "mid/01.ply", "mid/02.ply", "out", "out.path",
                              "out.png", "out/00.obj", "out/01.obj", "out/02.obj", "r.json",
                              "thin.obj", "tube0.obj", "tube1.obj", "tube2.obj"}));
  const shapespace::Path path = ReadPath(Path("out.path"));
  ASSERT_EQ(path.NumShapes(), 3);
  EXPECT_EQ(path.poses, std::vector<int>{0});
  for (int i = 0; i < 3; ++i) {
    EXPECT_LT(Apart("out/0" + std::to_string(i) + ".obj", path.Placed(i)), 1e-8);
  }
  EXPECT_LT(Apart("out/00.obj", Vertices("thin.obj")), 1e-8);
  EXPECT_GT(Apart("out/02.obj", Vertices("thin.obj")), 0.05);
  ExpectContains(outcome.out, "converged: 152 vertices, 2 shapes; target ");
  ExpectQuiet(outcome);
  const nlohmann::json report = nlohmann::json::parse(Content(Path("r.json")));
  EXPECT_EQ(report["method"], "features");
  EXPECT_EQ(report["steps"].size(), 2u);
  // A path that was transferred can be continued.
  Succeed("shape-extrapolate", {"out.path", "--steps", "1", "--output", "on%d.obj"});
}

TEST_F(TransferTest, ACopyTakesThePosesAsTheyAre) {
  MakeBodies();
  const Soup tube = ReadSoup(Path("tube0.obj"));
  const Eigen::Matrix3d turn =
      Eigen::AngleAxisd(1.2, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
  const auto copy = [&](const Shape& shape) -> Shape {
    return (3 * turn * shape).colwise() + Eigen::Vector3d(5, 6, 7);
  };
  WriteMesh(Path("copy.ply"), copy(tube.vertices), tube);
  Succeed("shape-transfer", {"tube0.obj", "tube1.obj", "tube2.obj", "--target", "copy.ply",
                             "--output", "%d.ply", "--hybrids", "h%d.ply"});
  for (int i = 0; i < 3; ++i) {
    const std::string number = std::to_string(i);
    const Shape wanted = copy(Vertices("tube" + number + ".obj"));
    EXPECT_LT(Apart(number + ".ply", wanted), 1e-9) << i;
    EXPECT_LT(Apart("h" + number + ".ply", wanted), 1e-9) << i;
  }
}

TEST_F(TransferTest, OfAPathEveryShapeIsTransferred) {
  MakeBodies();
  Succeed("shape-interpolate",
          {"tube0.obj", "tube1.obj", "--shapes", "3", "--output", "walk.path"});
  const Outcome outcome = Run("shape-transfer", {"walk.path", "--target", "thin.obj", "--output",
                                                 "on.path,%d.obj", "--report", "-"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const shapespace::Path walk = ReadPath(Path("walk.path")), on = ReadPath(Path("on.path"));
  ASSERT_EQ(on.NumShapes(), 5);
  EXPECT_EQ(on.parameters, walk.parameters);
  EXPECT_EQ(on.extrapolated, 4);
  EXPECT_LT(Apart("4.obj", on.Placed(4)), 1e-8);
  const nlohmann::json report = nlohmann::json::parse(outcome.out, nullptr, false);
  ASSERT_TRUE(report.is_object()) << outcome.out;
  EXPECT_EQ(report["converged"], true);
  EXPECT_EQ(report["steps"].size(), 4u);
  ExpectContains(outcome.err, "converged: 152 vertices, 4 shapes");
  EXPECT_EQ(report["uncertified_segments"], -1);

  Succeed("shape-transfer", {"walk.path", "--target", "thin.obj", "--avoid_contact", "--output",
                             "past.path", "--report", "past.json"});
  EXPECT_EQ(nlohmann::json::parse(Content(Path("past.json")))["uncertified_segments"], 0);
  EXPECT_EQ(ReadPath(Path("past.path")).shapes, on.shapes);
}

TEST_F(TransferTest, FlagsOfTheTransferReachIt) {
  MakeBodies();
  const auto report = [&](Strings flags) {
    flags.insert(flags.begin(),
                 {"tube0.obj", "tube1.obj", "--method", "ladder", "--shapes", "1", "--target",
                  "thin.obj", "--output", "on.path", "--report", "r.json"});
    Succeed("shape-transfer", flags);
    return nlohmann::json::parse(Content(Path("r.json")));
  };
  const nlohmann::json plain = report({});
  EXPECT_EQ(plain["geodesics"][0]["shapes"], 1);
  EXPECT_EQ(plain["transfers"][0]["steps"].size(), 2u);
  for (const Strings& flags :
       {Strings{"--noscale"}, Strings{"--connection", "constrained_projection"},
        Strings{"--bending", "1e-3"}}) {
    EXPECT_NE(report(flags)["transfers"][0]["strain_rms"], plain["transfers"][0]["strain_rms"])
        << flags[0];
  }
  EXPECT_EQ(report({"--bending", "1e-3"})["geodesics"][0]["metric"],
            "strain 1, lambda 0.0001, bending 0.001");
  Succeed("shape-transfer",
          {"tube0.obj", "tube1.obj", "--shapes", "1", "--target", "thin.obj", "--method", "ladder",
           "--noalign", "--output", "on.path", "--report", "r.txt"});
  ExpectContains(Content(Path("r.txt")), "Pose 2, its transfer");
}

// A source is not fitted onto a mesh that has as many faces, but other ones, unless that is asked
// for: most likely it was exported in another order.
TEST_F(TransferTest, ATargetInAnotherOrderIsRefusedByName) {
  MakeBodies();
  Succeed("shape-interpolate",
          {"tube0.obj", "tube1.obj", "--shapes", "1", "--output", "walk.path"});
  // All counts are equal, but two vertices are exchanged.
  Soup changed = ReadSoup(Path("thin.obj"));
  for (int& v : changed.corners) v = v == 0 ? 70 : v == 70 ? 0 : v;
  changed.vertices.col(0).swap(changed.vertices.col(70));
  WriteMesh(Path("changed.obj"), changed.vertices, changed);
  const Strings before = Files();
  for (const Strings& source : {Strings{"tube0.obj", "tube1.obj"}, Strings{"walk.path"}}) {
    Strings arguments = source;
    arguments.insert(arguments.end(), {"--target", "changed.obj", "--output", "on%d.obj"});
    const Outcome outcome = Run("shape-transfer", arguments);
    EXPECT_EQ(outcome.code, 1);
    ExpectContains(outcome.err, "changed.obj against " + source[0] + ": ");
    ExpectContains(outcome.err, "shape-correspond ");
  }
  EXPECT_EQ(Run("shape-transfer", {"tube0.obj", "tube1.obj", "--target", "nowhere.obj"}).code, 1);
  EXPECT_EQ(Files(), before);
}

TEST_F(TransferTest, WrongCommandLines) {
  MakeBodies();
  Succeed("shape-interpolate",
          {"tube0.obj", "tube1.obj", "--shapes", "1", "--output", "walk.path"});
  const Strings before = Files();
  const struct {
    Strings arguments;
    const char* message;
  } cases[] = {
      {{}, "at least two poses of one mesh, or one .path file alone"},
      {{"tube0.obj"}, "tube0.obj has one pose; name at least two poses of one mesh"},
      {{"walk.path", "tube1.obj"}, "at least two poses of one mesh, or one .path file alone"},
      {{"tube0.obj", "tube1.obj", "--target", ""}, "--target: name the body to move"},
      {{"walk.path", "--lambda", "0.001"}, "--lambda: goes with poses"},
      {{"walk.path", "--shapes", "15"}, "--shapes: goes with poses"},
      {{"walk.path", "--stiffeners", "s.txt"}, "--stiffeners: goes with poses"},
      {{"walk.path", "--method", "magic"}, "--method magic: must be one of features, ladder"},
      {{"walk.path", "--method", "ladder", "--connection", "affine"},
       "--connection affine: must be one of levi_civita, constrained_projection"},
      {{"walk.path", "--connection", "constrained_projection"},
       "--connection: goes with --method ladder"},
      {{"tube0.obj", "tube1.obj", "--shapes", "3"}, "--shapes: goes with --method ladder"},
      {{"tube0.obj", "tube1.obj", "--lambda", "1e-3"}, "--lambda: goes with --method ladder"},
      {{"tube0.obj", "tube1.obj", "--noscale"}, "--scale: goes with --method ladder or --hybrids"},
      {{"walk.path", "--hybrids", "half.tif"}, "--hybrids half.tif: must end in"},
      {{"walk.path", "--hybrids", "half.obj"}, "--hybrids "},
      {{"walk.path", "--output", "on.tif"}, "--output on.tif: must end in"},
      {{"walk.path", "--report", "r.html"}, "--report r.html: must end in .json or .txt, or be -"},
  };
  for (const auto& [given, message] : cases) {
    SCOPED_TRACE(message);
    Strings arguments = {"--target", "thin.obj"};
    arguments.insert(arguments.end(), given.begin(), given.end());
    const Outcome outcome = Run("shape-transfer", arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_EQ(outcome.out, "");
    ExpectContains(outcome.err, message);
    ExpectContains(outcome.err, "--help");
    EXPECT_EQ(Files(), before);
  }
}

TEST_F(TransferTest, FramesLookLikeTheTarget) {
  const std::string faces = "f 1 2 3\nf 2 1 4\n", positions = "v 0 0 0\nv 0 1 0\n";
  File("a.obj", positions + "v -0.8 0.5 0.6\nv 0.8 0.5 0.6\n" + faces);
  File("b.obj", positions + "v -0.9 0.5 0.4\nv 0.9 0.5 0.4\n" + faces);
  File("t.obj",
       "mtllib paint.mtl\nv 0 0 0\nv 0 2 0\nv -0.9 0.5 0.6\nv 0.8 0.5 0.7\nusemtl red\n" + faces);
  Succeed("shape-transfer", {"a.obj", "b.obj", "--target", "t.obj", "--output", "%d.obj"});
  ExpectContains(Content(Path("1.obj")), "usemtl red");
  ExpectLacks(Content(Path("1.obj")), "nan");
}

}  // namespace
}  // namespace shapespace
