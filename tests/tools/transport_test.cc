#include <cmath>

#include <Eigen/Geometry>
#include <nlohmann/json.hpp>

#include <shapespace/files/read.h>
#include <shapespace/files/write.h>
#include <shapespace/statistics/pose_table.h>

#include "tools/run.h"

namespace shapespace {
namespace {

using testing::Content;
using testing::ExpectContains;
using testing::Outcome;
using testing::ToolsTest;

class TransportToolTest : public ToolsTest {
 protected:
  // a.ply, a straight tube; b.ply, the same turned and moved; changed.ply, bent by 60 degrees.
  void MakePoses() const {
    MakeTubes();
    Soup soup = ReadSoup(Path("tube0.obj"));
    WriteMesh(Path("a.ply"), soup.vertices, soup);
    WriteMesh(Path("b.ply"), (turn_ * soup.vertices).colwise() + Eigen::Vector3d(1, 2, 3), soup);
    WriteMesh(Path("changed.ply"), ReadSoup(Path("tube1.obj")).vertices, soup);
  }

  // The distances between every two vertices of a shape, which rigid motions keep.
  static Eigen::MatrixXd Distances(const Shape& shape) {
    Eigen::MatrixXd distances(shape.cols(), shape.cols());
    for (Eigen::Index v = 0; v < shape.cols(); ++v) {
      distances.col(v) = (shape.colwise() - shape.col(v)).colwise().norm();
    }
    return distances;
  }

  const Eigen::Matrix3d turn_ =
      Eigen::AngleAxisd(0.7, Eigen::Vector3d(1, 2, 3).normalized()).toRotationMatrix();
};

TEST_F(TransportToolTest, AlongARigidMotionTheChangeIsTheSame) {
  MakePoses();
  Succeed("shape-transport",
          {"a.ply", "b.ply", "changed.ply", "-o", "there.ply", "--tangents", "change.csv"});
  const Shape changed = ReadSoup(Path("changed.ply")).vertices;
  const Shape there = ReadSoup(Path("there.ply")).vertices;
  const double size = Distances(changed).maxCoeff();
  EXPECT_LE((Distances(there) - Distances(changed)).cwiseAbs().maxCoeff(), 1e-3 * size);

  const PoseTable table = ReadPoseTable(Path("change.csv"));
  EXPECT_EQ(table.columns, (std::vector<std::string>{"first_x", "first_y", "first_z", "last_x",
                                                     "last_y", "last_z"}));
  ASSERT_EQ(static_cast<Eigen::Index>(table.poses.size()), changed.cols());
  const Eigen::MatrixXd numbers = table.NumbersOf(table.poses).transpose();
  const Eigen::MatrixXd first = numbers.topRows(3), last = numbers.bottomRows(3);
  EXPECT_GE(first.colwise().norm().maxCoeff(), 0.05 * size);
  EXPECT_LE((last - turn_ * first).norm(), 1e-4 * first.norm());
}

TEST_F(TransportToolTest, APathGivesWhatItsPosesGive) {
  MakePoses();
  Succeed("shape-interpolate", {"a.ply", "b.ply", "-o", "w.path"});
  Succeed("shape-transport", {"a.ply", "b.ply", "changed.ply", "-o", "poses.ply"});
  Succeed("shape-transport",
          {"w.path", "changed.ply", "-o", "path.ply,back.glb", "--report", "r.json"});
  const Shape from_poses = ReadSoup(Path("poses.ply")).vertices;
  const Shape from_path = ReadSoup(Path("path.ply")).vertices;
  EXPECT_LE((from_poses - from_path).norm(), 1e-3 * from_poses.norm());

  Soup flipped = ReadSoup(Path("changed.ply"));
  flipped.vertices.row(0) *= -1;
  WriteMesh(Path("flipped.ply"), flipped.vertices, flipped);
  Succeed("shape-transport", {"w.path", "flipped.ply", "--mirror", "x", "-o", "back.ply"});
  EXPECT_EQ(ReadSoup(Path("back.ply")).vertices, from_path);
  const auto report = nlohmann::json::parse(Content(Path("r.json")));
  EXPECT_EQ(report["termination"], "converged");
  EXPECT_NEAR(report["transport"]["last_norm"][0].get<double>() /
                  report["transport"]["first_norm"][0].get<double>(),
              1, 1e-6);
}

TEST_F(TransportToolTest, GroupsAreKept) {
  MakeTubes();
  std::string grouped = Content(Path("tube0.obj"));
  grouped.insert(grouped.find("\nf ") + 1, "g skin\n");
  File("grouped.obj", grouped);
  Succeed("shape-transport", {"grouped.obj", "tube0.obj", "tube1.obj", "-o", "poses.obj"});
  Succeed("shape-interpolate", {"grouped.obj", "tube0.obj", "-o", "w.path"});
  Succeed("shape-transport", {"w.path", "tube1.obj", "-o", "path.obj"});
  for (const char* file : {"poses.obj", "path.obj"}) {
    ExpectContains(Content(Path(file)), "\ng skin\n");
  }
}

TEST_F(TransportToolTest, Refuses) {
  MakePoses();
  Succeed("shape-interpolate", {"a.ply", "b.ply", "-o", "w.path"});
  for (const auto& [arguments, message] :
       {std::make_pair(std::vector<std::string>{"a.ply", "b.ply"},
                       "name a .path and a changed pose"),
        {{"w.path", "changed.ply", "--metric", "isometric"}, "--metric: goes with poses"},
        {{"w.path", "changed.ply", "--tangents", "t.txt"}, "--tangents t.txt: must end in .csv"},
        {{"w.path", "changed.ply", "--steps", "1"}, "--steps must be 2 or more"},
        {{"w.path", "changed.ply", "-o", "changed.ply"}, "would overwrite changed.ply"}}) {
    const Outcome outcome = Run("shape-transport", arguments);
    EXPECT_EQ(outcome.code, 2) << message;
    ExpectContains(outcome.err, message);
  }
  Succeed("shape-body", {"tube", "--triangles", "500", "--at", "0", "-o", "other%d.ply"});
  const Outcome outcome = Run("shape-transport", {"w.path", "other0.ply", "-o", "x.ply"});
  EXPECT_EQ(outcome.code, 1);
  ExpectContains(outcome.err, "other0.ply");
}

}  // namespace
}  // namespace shapespace
