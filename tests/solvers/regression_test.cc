#include <shapespace/statistics/regression.h>

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/quadruped.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/statistics/modes_file.h>
#include <shapespace/statistics/pose_table.h>

#include "mesh/files.h"
#include "support/message_of.h"
#include "support/motions.h"

namespace shapespace {
namespace {

using testing::MessageOf;
using testing::Names;

const PoseModes& Herd() {
  static const PoseModes herd = [] {
    const SkinnedBody body = MakeQuadruped(500);
    std::vector<Shape> poses;
    std::vector<std::string> names;
    for (int seed = 1; seed <= 8; ++seed) {
      poses.push_back(body.random_pose(seed));
      names.push_back("animal " + std::to_string(seed));
    }
    return MakeShapeModel(body.connectivity, poses, names).modes;
  }();
  return herd;
}

TEST(Regress, PredictsATubeBeyondThePoses) {
  const ShapeFamily tube = MakeTube(800);
  std::vector<Shape> poses;
  Eigen::VectorXd angles(5);
  for (int i = 0; i < 5; ++i) poses.push_back(tube.pose(angles(i) = 20 * i));
  const ShapeModel model(MakeShapeModel(tube.connectivity, poses, {}).modes);
  const Regression regression = Regress(model.Modes(), {"angle"}, angles);
  EXPECT_GT(regression.r_squared, 0.99);
  EXPECT_LT(regression.p_value, 0.05);
  const Shape shape = model.At(regression.CoordinatesAt(Eigen::VectorXd::Constant(1, 140))).shape;
  const Shape truth = tube.pose(140);
  const Eigen::VectorXd ones = Eigen::VectorXd::Ones(truth.cols());
  const double off = (FitRigidMotion(shape, truth, ones)(shape) - truth).colwise().norm().mean();
  EXPECT_LT(off, 0.01 * testing::Diameter(truth));
  EXPECT_THROW(regression.CoordinatesAt(Eigen::VectorXd::Zero(2)), InvalidOptions);
}

// Coordinates are uncorrelated and have variance 1, so that a coordinate explains its own mode.
TEST(Regress, OfACoordinateExplainsItsMode) {
  const PoseModes& herd = Herd();
  const Eigen::MatrixXd coordinates = herd.Coordinates();
  const Regression one = Regress(herd, {"first"}, 7 * coordinates.col(0).array() + 30);
  EXPECT_NEAR(one.r_squared, herd.Share(1), 1e-9);
  EXPECT_NEAR(one.slopes(0, 0), 1 / 7.0, 1e-9);
  EXPECT_NEAR(one.CoordinatesAt(Eigen::VectorXd::Constant(1, 30)).norm(), 0, 1e-9);
  // The second scalar explains nothing that the first two together do not: the third mode.
  Eigen::MatrixXd values(8, 2);
  values << coordinates.col(0), coordinates.col(0) + coordinates.col(1);
  const Regression two = Regress(herd, {"first", "sum"}, values);
  EXPECT_NEAR(two.r_squared, herd.Share(2), 1e-9);
  EXPECT_NEAR(two.slopes(1, 1), 1, 1e-9);
  EXPECT_NEAR(two.slopes(0, 1), 0, 1e-9);
  ASSERT_EQ(two.p_values.size(), 2u);
}

TEST(Regress, EachProbabilityIsOfItsOwnScalar) {
  const PoseModes& herd = Herd();
  const Eigen::MatrixXd coordinates = herd.Coordinates();
  Eigen::MatrixXd values(8, 2), exchanged(8, 2);
  values << coordinates.col(0), coordinates.col(4);
  exchanged << coordinates.col(4), coordinates.col(0);
  const Regression one = Regress(herd, {"first", "fifth"}, values);
  const Regression other = Regress(herd, {"fifth", "first"}, exchanged);
  ASSERT_EQ(one.p_values.size(), 2u);
  ASSERT_EQ(other.p_values.size(), 2u);
  EXPECT_LT(one.p_values[0], 0.9 * one.p_values[1]);  // the first mode varies more than the fifth
  EXPECT_NEAR(one.p_values[0], other.p_values[1], 1e-3);
  EXPECT_NEAR(one.p_values[1], other.p_values[0], 1e-3);
}

// With so few poses all orders can be counted: of 4! how many explain as much?
TEST(Regress, TheProbabilityIsThatOfAllOrders) {
  const SkinnedBody body = MakeQuadruped(400);
  std::vector<Shape> poses;
  for (int seed = 1; seed <= 4; ++seed) poses.push_back(body.random_pose(seed));
  const PoseModes modes = MakeShapeModel(body.connectivity, poses, {}).modes;
  Eigen::VectorXd values(4);
  values << 1, 2.5, 4, 9;
  const double truth = Regress(modes, {"s"}, values).r_squared;
  std::vector<int> order = {0, 1, 2, 3};
  int as_good = 0;
  PermutationOptions once;
  once.permutations = 1;
  do {
    const double r_squared = Regress(modes, {"s"}, values(order), once).r_squared;
    if (r_squared > truth - 1e-9) ++as_good;
  } while (std::next_permutation(order.begin(), order.end()));
  EXPECT_NEAR(Regress(modes, {"s"}, values).p_value, as_good / 24.0, 0.02);
}

TEST(Regress, RefusesScalarsThatSayNothing) {
  const PoseModes& herd = Herd();
  const auto message = [&](const std::vector<std::string>& names, const Eigen::MatrixXd& values) {
    return MessageOf<InvalidOptions>([&] { Regress(herd, names, values); });
  };
  const Eigen::VectorXd line = Eigen::VectorXd::LinSpaced(8, 1, 5);
  EXPECT_TRUE(Names(message({"age"}, Eigen::VectorXd::Constant(8, 3)), {"scalars:", "age"}));
  Eigen::MatrixXd twice(8, 2);
  twice << line, 2 * line.array() + 1;
  EXPECT_TRUE(Names(message({"a", "b"}, twice), {"scalars:"}));
  EXPECT_NE(message({"a"}, line.head(7)), "");
  EXPECT_NE(message(std::vector<std::string>(7, "a"), Eigen::MatrixXd::Random(8, 7)), "");
}

TEST(CompareGroups, InOneModeItIsTheTTest) {
  const PoseModes one = FirstModes(Herd(), 1);
  const std::vector<std::string> labels = {"a", "b", "a", "b", "b", "a", "b", "a"};
  const std::vector<GroupDifference> differences = CompareGroups(one, labels);
  ASSERT_EQ(differences.size(), 1u);
  // Student's t with pooled variance.
  std::vector<double> groups[2];
  for (int i = 0; i < 8; ++i) groups[labels[i] == "b"].push_back(one.Coordinates()(i, 0));
  double means[2], squares = 0;
  for (int g : {0, 1}) {
    means[g] = (groups[g][0] + groups[g][1] + groups[g][2] + groups[g][3]) / 4;
    for (double value : groups[g]) squares += (value - means[g]) * (value - means[g]);
  }
  const double t = (means[1] - means[0]) / std::sqrt(squares / 6 * (1 / 4.0 + 1 / 4.0));
  EXPECT_NEAR(differences[0].t_squared, t * t, 1e-9);
  EXPECT_NEAR(differences[0].distance, std::abs(means[1] - means[0]) * std::sqrt(one.variances(0)),
              1e-12);
  // In one mode both grow with the difference of the means.
  EXPECT_NEAR(differences[0].t_squared_p, differences[0].distance_p, 1e-12);
  EXPECT_GT(differences[0].t_squared_p, 0);
}

TEST(CompareGroups, FindsADifferenceThatIsThere) {
  const PoseModes& herd = Herd();
  const Eigen::VectorXd first = herd.Coordinates().col(0);
  std::vector<double> sorted(first.begin(), first.end());
  std::sort(sorted.begin(), sorted.end());
  std::vector<std::string> labels;
  for (const double value : first) labels.push_back(value < sorted[4] ? "low" : "high");
  GroupOptions options;
  options.modes = 1;
  const GroupDifference difference = CompareGroups(herd, labels, options)[0];
  // Of the 70 ways to choose four of eight, this one and its opposite are the farthest.
  EXPECT_NEAR(difference.t_squared_p, 2 / 70.0, 0.01);
  for (const std::vector<std::string>& wrong :
       {std::vector<std::string>{"a"}, std::vector<std::string>(8, "a"),
        std::vector<std::string>{"a", "b", "b", "b", "b", "b", "b", "b"}}) {
    EXPECT_EQ(MessageOf<InvalidOptions>([&] { CompareGroups(herd, wrong); }).find("labels: "), 0u);
  }
  options.modes = 7;
  EXPECT_THROW(CompareGroups(herd, labels, options), InvalidOptions);
}

class PoseTableTest : public testing::FilesTest {
 protected:
  std::string Table(const std::string& text) const { return File("t.csv", text); }
  std::string Message(const std::string& text) const {
    const std::string file = Table(text);
    const std::string message = MessageOf<FileError>([&] {
      ReadPoseTable(file).NumbersOf({"sit", "stand"});
    });
    return message.compare(0, file.size(), file) == 0 ? message.substr(file.size()) : message;
  }
};

TEST_F(PoseTableTest, IsReadAsSpreadsheetsWriteIt) {
  const PoseTable table = ReadPoseTable(Table(
      "\xEF\xBB\xBF\"file\",age,\"weight, kg\"\r\nposes/stand.obj, 3 ,4e1\r\n\"sit\",-1.5,\"7\"\r\n"
      "other,1,2\r\n\r\n"));
  EXPECT_EQ(table.columns, (std::vector<std::string>{"age", "weight, kg"}));
  Eigen::Matrix2d wanted;
  wanted << -1.5, 7, 3, 40;
  EXPECT_EQ(table.NumbersOf({"sit", "stand"}), wanted);
  EXPECT_EQ(table.LabelsOf({"other"}), (std::vector<std::string>{"1"}));
}

TEST_F(PoseTableTest, IsReadAsItWasWritten) {
  const Eigen::MatrixXd numbers = Eigen::MatrixXd::Random(2, 2);
  WritePoseTable(Path("w.csv"), {"a \"b\", c", "d"}, {"x", "y"}, numbers);
  EXPECT_EQ(ReadPoseTable(Path("w.csv")).NumbersOf({"a \"b\", c", "d"}), numbers);
}

TEST_F(PoseTableTest, ErrorsNameTheRow) {
  EXPECT_TRUE(Names(Message("f,age\nsit,1\n"), {"'stand'"}));
  EXPECT_TRUE(Names(Message("f,age\nsit,1\nstand,tall\n"), {":3:", "'stand'", "'tall'"}));
  EXPECT_TRUE(Names(Message("f,age\nsit,1\nsit.obj,2\n"), {":3:", "'sit.obj'", "line 2"}));
  EXPECT_TRUE(Names(Message("f,age\nsit,1,2\n"), {":2:", "3", "2"}));
  EXPECT_NE(Message("f,age\nsit,1\nstand,\"1,5\"\n").find("comma"), std::string::npos);
  EXPECT_NE(Message("f;age\nstand;1,5\n").find("semicolons"), std::string::npos);
  EXPECT_TRUE(Names(Message("f,age\n\"sit,1\n"), {":2:"}));
  EXPECT_TRUE(Names(Message("f,age\n\"sit\"x,1\n"), {":2:"}));
  EXPECT_TRUE(Names(Message("f,age\n"), {"pose"}));
  EXPECT_TRUE(Names(Message("f\nsit\n"), {":1:"}));
}

class ModesFileTest : public testing::FilesTest {};

TEST_F(ModesFileTest, IsReadAsItWasWritten) {
  PoseModes modes = Herd();
  modes.provenance = "test";
  modes.size = PoseSize::kRemove;
  WriteModes(Path("m.modes"), modes);
  const PoseModes read = ReadModes(Path("m.modes"));
  EXPECT_EQ(read.names, modes.names);
  EXPECT_EQ(read.size, PoseSize::kRemove);
  EXPECT_EQ(read.provenance, "test");
  EXPECT_EQ(read.mean, modes.mean);
  EXPECT_EQ(read.coefficients, modes.coefficients);
  EXPECT_EQ(read.variances, modes.variances);
  EXPECT_EQ(read.total_variance, modes.total_variance);
  for (int i = 0; i < modes.NumPoses(); ++i) EXPECT_EQ(read.PlacedPose(i), modes.PlacedPose(i));
  for (int k = 0; k < modes.NumModes(); ++k) EXPECT_EQ(read.modes[k], modes.modes[k]);
  const Eigen::Vector2d at(1, -0.5);
  EXPECT_EQ(ShapeModel(read).At(at).shape, ShapeModel(modes).At(at).shape);
}

TEST_F(ModesFileTest, RefusesWhatIsInconsistent) {
  PoseModes modes = Herd();
  modes.variances(1) = -1;
  EXPECT_NE(MessageOf<MeshError>([&] { WriteModes(Path("m.modes"), modes); }).find("variance"),
            std::string::npos);
  modes = Herd();
  modes.weights(0) = 2;
  EXPECT_THROW(modes.Validate(), MeshError);
  modes = Herd();
  modes.modes.pop_back();
  EXPECT_THROW(modes.Validate(), MeshError);
  File("no.modes", "no modes");
  EXPECT_EQ(MessageOf<FileError>([&] { ReadModes(Path("no.modes")); }).find(Path("no.modes")), 0u);
}

}  // namespace
}  // namespace shapespace
