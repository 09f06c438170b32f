#include <shapespace/files/read.h>
#include <shapespace/files/write.h>
#include <shapespace/path/path_file.h>

#include "tools/run.h"

namespace shapespace {
namespace {

using testing::ExpectContains;
using testing::ExpectLacks;
using testing::Outcome;
using testing::ToolsTest;

using Strings = std::vector<std::string>;

constexpr char kVertex[] = R"({"vertices": [1]})";
constexpr char kEnd[] = R"({"vertices": [[1, 20]]})";

/// --anchor and --ground of all tools with these flags.
class AnchorTest : public ToolsTest {
 protected:
  /// tube0.obj and bent.obj: a tube, straight and bent, whose first vertices (a cap, which hardly
  /// deforms) are in the same position; walk.path: five shapes from one to the other.
  void MakeWalk() const {
    MakeTubes();
    const Soup tube = ReadSoup(Path("tube0.obj")), bent = ReadSoup(Path("tube1.obj"));
    const Eigen::VectorXd weights = Eigen::VectorXd::Ones(20);
    RigidMotion motion =
        FitRigidMotion(bent.vertices.leftCols(20), tube.vertices.leftCols(20), weights);
    motion.translation += tube.vertices.col(0) - motion(bent.vertices).col(0);
    WriteMesh(Path("bent.obj"), motion(bent.vertices), tube);
    Succeed("shape-interpolate",
            {"tube0.obj", "bent.obj", "--shapes", "3", "--output", "walk.path"});
  }

  Shape Vertices(const std::string& file) const { return ReadSoup(Path(file)).vertices; }

  /// The greatest distance of vertex 1 from its position in tube0.obj, over the frames 0, 1, ... of
  /// `pattern`.
  double Slip(const std::string& pattern, int frames) const {
    const Eigen::Vector3d place = Vertices("tube0.obj").col(0);
    double most = 0;
    for (int i = 0; i < frames; ++i) {
      std::string file = pattern;
      file.replace(file.find("%d"), 2, std::to_string(i));
      most = std::max(most, (Vertices(file).col(0) - place).norm());
    }
    return most;
  }

  void ExpectOnGround(const shapespace::Path& path, int axis, double height) const {
    for (int i = 0; i < path.NumShapes(); ++i) {
      EXPECT_NEAR(path.Placed(i).row(axis).minCoeff(), height, 1e-12) << i;
    }
  }
};

TEST_F(AnchorTest, InterpolatedShapesStandOnTheirAnchorAndPosesStay) {
  MakeWalk();
  Succeed("shape-interpolate", {"tube0.obj", "bent.obj", "--shapes", "3", "--anchor", kVertex,
                                "--output", "held.path,held%d.ply"});
  Succeed("shape-export", {"walk.path", "--output", "free%d.ply"});
  EXPECT_GT(Slip("free%d.ply", 5), 1e-3);
  EXPECT_LT(Slip("held%d.ply", 5), 1e-12);
  EXPECT_LT((Vertices("held0.ply") - Vertices("tube0.obj")).norm(), 1e-12);
  EXPECT_LT((Vertices("held4.ply") - Vertices("bent.obj")).norm(), 1e-12);
  const shapespace::Path path = ReadPath(Path("held.path"));
  for (int i = 0; i < 5; ++i) {
    EXPECT_TRUE(Vertices("held" + std::to_string(i) + ".ply") == path.Placed(i));
  }
  ExpectContains(path.provenance, "bent.obj; anchored");
  ExpectLacks(path.provenance, "ground");
}

TEST_F(AnchorTest, APartIsHeldAtItsCentroidAndDoesNotTurn) {
  MakeWalk();
  Succeed("shape-interpolate",
          {"tube0.obj", "bent.obj", "--shapes", "3", "--anchor", kEnd, "--output", "held.path"});
  const shapespace::Path path = ReadPath(Path("held.path"));
  const Eigen::VectorXd weights = path.metric->vertex_area.head(20);
  const Shape first = path.Placed(0).leftCols(20), last = path.Placed(4).leftCols(20);
  for (int i = 1; i < 4; ++i) {
    const Shape part = path.Placed(i).leftCols(20);
    const Shape wanted = (1 - path.parameters[i]) * first + path.parameters[i] * last;
    EXPECT_LT((Centroid(part, weights) - Centroid(wanted, weights)).norm(), 1e-12);
    EXPECT_LT((FitRigidMotion(part, wanted, weights).rotation - Eigen::Matrix3d::Identity()).norm(),
              0.01)
        << i;
  }
}

TEST_F(AnchorTest, ShapesStandOnTheGround) {
  MakeWalk();
  Succeed("shape-interpolate", {"tube0.obj", "bent.obj", "--shapes", "3", "--anchor", kVertex,
                                "--ground", "y=-1.5", "--output", "low.path"});
  const shapespace::Path path = ReadPath(Path("low.path"));
  ExpectOnGround(path, 1, -1.5);
  ExpectContains(path.provenance, "; anchored; on the ground y=-1.5");
}

TEST_F(AnchorTest, ExtrapolatedShapesGoOnOnTheirAnchor) {
  MakeWalk();
  Succeed("shape-extrapolate", {"tube0.obj", "bent.obj", "--shapes", "3", "--steps", "2",
                                "--anchor", kVertex, "--output", "on%d.ply"});
  EXPECT_LT(Slip("on%d.ply", 7), 1e-12);
  Succeed("shape-extrapolate",
          {"walk.path", "--steps", "2", "--anchor", kVertex, "--output", "also%d.ply"});
  EXPECT_LT(Slip("also%d.ply", 7), 1e-12);
  Succeed("shape-extrapolate", {"walk.path", "--keep", "2", "--steps", "2", "--ground", "z=3",
                                "--output", "grounded.path"});
  ExpectOnGround(ReadPath(Path("grounded.path")), 2, 3);
}

TEST_F(AnchorTest, AnExportHoldsItAtAllTimes) {
  MakeWalk();
  Succeed("shape-export", {"walk.path", "--anchor", kVertex, "--output", "own%d.ply"});
  EXPECT_LT(Slip("own%d.ply", 5), 1e-12);
  Succeed("shape-export",
          {"walk.path", "--at", ".1,.4,.77", "--anchor", kVertex, "--output", "at%d.ply"});
  EXPECT_LT(Slip("at%d.ply", 3), 1e-12);
  Succeed("shape-export",
          {"walk.path", "--frames", "8", "--anchor", kVertex, "--output", "frames%d.ply"});
  EXPECT_LT(Slip("frames%d.ply", 8), 1e-12);
  Succeed("shape-export", {"walk.path", "--frames", "3", "--ground", "x=1", "--output", "g%d.ply"});
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(Vertices("g" + std::to_string(i) + ".ply").row(0).minCoeff(), 1, 1e-12);
  }
}

TEST_F(AnchorTest, ATransferStandsWhereItsTargetDoes) {
  MakeWalk();
  const Soup tube = ReadSoup(Path("tube0.obj"));
  WriteMesh(Path("thin.obj"), Eigen::Vector3d(1.4, 0.8, 0.8).asDiagonal() * tube.vertices, tube);
  const Eigen::Vector3d place = Vertices("thin.obj").col(0);
  const auto expect_still = [&](const std::string& file, int shapes) {
    const shapespace::Path path = ReadPath(Path(file));
    ASSERT_EQ(path.NumShapes(), shapes) << file;
    const Eigen::Vector3d there = file == "half.path" ? path.Placed(0).col(0).eval() : place;
    for (int i = 0; i < shapes; ++i) {
      EXPECT_LT((path.Placed(i).col(0) - there).norm(), 1e-12) << file << ' ' << i;
    }
    ExpectContains(path.provenance, "; anchored");
  };
  Succeed("shape-transfer", {"tube0.obj", "bent.obj", "--target", "thin.obj", "--anchor", kVertex,
                             "--output", "moved.path", "--hybrids", "half.path"});
  expect_still("moved.path", 2);
  expect_still("half.path", 2);
  Succeed("shape-transfer",
          {"walk.path", "--target", "thin.obj", "--anchor", kVertex, "--output", "walked.path"});
  expect_still("walked.path", 5);
  Succeed("shape-transfer",
          {"walk.path", "--target", "thin.obj", "--ground", "y=0", "--output", "grounded.path"});
  ExpectOnGround(ReadPath(Path("grounded.path")), 1, 0);
}

TEST_F(AnchorTest, GroupsOfTheFirstPoseCanBeHeld) {
  MakeWalk();
  std::string text = testing::Content(Path("tube0.obj"));
  text.insert(text.find("f "), "g foot\n");
  File("tube0.obj", text);
  Succeed("shape-interpolate", {"tube0.obj", "bent.obj", "--shapes", "1", "--anchor",
                                R"({"group": "foot"})", "--output", "held.path"});
  Succeed("shape-export", {"held.path", "--anchor", R"({"group": "foot"})", "--output", "%d.obj"});
}

TEST_F(AnchorTest, WhatCannotBeHeldIsRefusedBeforeAnythingIsSolved) {
  MakeWalk();
  const Strings before = Files();
  const struct {
    const char* tool;
    Strings arguments;
  } runs[] = {{"shape-interpolate", {"tube0.obj", "bent.obj"}},
              {"shape-extrapolate", {"tube0.obj", "bent.obj"}},
              {"shape-extrapolate", {"walk.path"}},
              {"shape-transfer", {"tube0.obj", "bent.obj", "--target", "tube0.obj"}},
              {"shape-transfer", {"walk.path", "--target", "tube0.obj"}},
              {"shape-export", {"walk.path"}}};
  const struct {
    const char *flag, *value, *message;
  } cases[] = {
      {"--anchor", "", "--anchor : line 1: this is not valid JSON: "},
      {"--anchor", "feet", "--anchor feet: line 1: this is not valid JSON: "},
      {"--anchor", R"({"vertices": [0]})", "vertices: 0 is not a vertex number"},
      {"--anchor", R"({"feet": 1})", "unknown key 'feet'; the keys here are vertices, ball, "},
      {"--anchor", R"({"vertices": [153]})",
       "vertices: 153 is not a vertex of this mesh, which has 152"},
      {"--anchor", R"({"group": "foot"})",
       "group: no polygon has the group or object 'foot'; this mesh has none at all"},
      {"--anchor", R"({"ball": {"centre": [99, 0, 0], "radius": 1}})", "no vertex is in {"},
      {"--ground", "", "--ground : must be x, y or z, = and a height, such as y=0"},
      {"--ground", "0", "--ground 0: must be"},
      {"--ground", "y", "--ground y: must be"},
      {"--ground", "y=", "--ground y=: must be"},
      {"--ground", "w=0", "--ground w=0: must be"},
      {"--ground", "y=low", "--ground y=low: must be"},
      {"--ground", "y=nan", "--ground y=nan: must be"},
      {"--ground", "y=1e61", "--ground y=1e61: must be"},
  };
  for (const auto& [tool, inputs] : runs) {
    for (const auto& [flag, value, message] : cases) {
      SCOPED_TRACE(std::string(tool) + " " + flag + " " + value);
      Strings arguments = inputs;
      arguments.insert(arguments.end(), {flag, value, "--output", "new%d.obj"});
      const Outcome outcome = Run(tool, arguments);
      EXPECT_EQ(outcome.code, 2);
      ExpectContains(outcome.err, message);
      ExpectContains(outcome.err, "--help");
    }
  }
  EXPECT_EQ(Files(), before);
  // Errors of the command line alone are reported before any file is read.
  const Outcome outcome = Run("shape-interpolate", {"no.obj", "no.obj", "--anchor", "feet"});
  EXPECT_EQ(outcome.code, 2);
  ExpectContains(outcome.err, "--anchor feet");
}

}  // namespace
}  // namespace shapespace
