// Files of every version that is read (README.md) still hold what they were made of.

#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/bodies/body.h>
#include <shapespace/exploration/space_file.h>
#include <shapespace/path/path_file.h>
#include <shapespace/statistics/modes_file.h>

#include "support/temporary_file.h"

namespace shapespace {
namespace {

const double kAngles[] = {-12.5, 2, 12.5};

std::string Kept(const std::string& name) { return std::string(KEPT_FILES "/") + name; }

// Vertex by vertex, as far as rounding and the digits of the poses' files allow.
void ExpectPose(const Shape& shape, int pose) {
  const Shape expected = MakeBody("steffen").pose(kAngles[pose]);
  ASSERT_EQ(shape.cols(), expected.cols());
  EXPECT_LT((shape - expected).cwiseAbs().maxCoeff(), 1e-11) << "pose " << pose;
}

void ExpectSteffen(const Metric& metric) {
  EXPECT_EQ(metric.connectivity->NumTriangles(), 14);
  EXPECT_EQ(metric.options.strain, 1);
  EXPECT_EQ(metric.options.bending, 1e-5);
  EXPECT_TRUE(metric.options.features.empty());
}

class KeptPath : public ::testing::TestWithParam<const char*> {};

TEST_P(KeptPath, HoldsItsPosesAndItsStiffness) {
  const Path path = ReadPath(Kept(GetParam()));
  ExpectSteffen(*path.metric);
  EXPECT_EQ(path.poses, (std::vector<int>{0, 2, 4}));
  EXPECT_EQ(path.parameters, (std::vector<double>{0, .25, .5, .75, 1}));
  for (int pose = 0; pose < 3; ++pose) ExpectPose(path.Placed(path.poses[pose]), pose);
  EXPECT_TRUE(path.converged);
  EXPECT_FALSE(path.smooth);
  EXPECT_EQ(path.extrapolated, 0);
  EXPECT_EQ(path.provenance, "shape-interpolate 0.1.0: steffen0.obj steffen1.obj steffen2.obj");
  const MetricOptions& options = path.metric->options;
  EXPECT_EQ(options.stiffness_on, StiffnessOn::kVertices);
  ASSERT_EQ(options.stretching_stiffness.size(), 9);
  for (int i = 0; i < 9; ++i) EXPECT_EQ(options.stretching_stiffness[i], (i + 1) % 3 + 1);
}

TEST_P(KeptPath, WrittenByTodaysLibraryHoldsTheSame) {
  const Path path = ReadPath(Kept(GetParam()));
  const std::string file = testing::TemporaryFile(std::string("again-") + GetParam());
  WritePath(file, path);
  const Path again = ReadPath(file);
  EXPECT_EQ(again.shapes, path.shapes);
  EXPECT_EQ(again.metric->options.stretching_stiffness, path.metric->options.stretching_stiffness);
}

INSTANTIATE_TEST_SUITE_P(Version1, KeptPath, ::testing::Values("path-1.path", "path-1-later.path"));

TEST(KeptSpace, Version1HoldsItsPosesAndWhatIsBetween) {
  const PoseSpace space = ReadSpace(Kept("space-1.space"));
  ExpectSteffen(*space.metric);
  EXPECT_EQ(space.names, (std::vector<std::string>{"steffen0", "steffen1", "steffen2"}));
  ExpectPose(space.Placed(0), 0);  // the others are turned onto the first
  EXPECT_EQ(space.NumNodes(), 5);
  EXPECT_EQ(space.segments.cols(), 4);  // its motion is a line
  EXPECT_EQ(space.parents.size(), 2u);
  EXPECT_EQ(space.distances, space.distances.transpose());
  EXPECT_GT(space.distances(0, 2), space.distances(0, 1));
}

TEST(KeptModes, Version1HoldsItsPosesAndItsModes) {
  const PoseModes modes = ReadModes(Kept("modes-1.modes"));
  ExpectSteffen(*modes.metric);
  EXPECT_EQ(modes.names, (std::vector<std::string>{"steffen0", "steffen1", "steffen2"}));
  ASSERT_EQ(modes.NumPoses(), 3);
  for (int pose = 0; pose < 3; ++pose) ExpectPose(modes.PlacedPose(pose), pose);
  EXPECT_EQ(modes.NumModes(), 2);
  EXPECT_EQ(modes.size, PoseSize::kKeep);
  EXPECT_GT(modes.variances[0], modes.variances[1]);
  EXPECT_NEAR(modes.Coordinates().colwise().sum().norm(), 0, 1e-9);  // of mean 0
}

}  // namespace
}  // namespace shapespace
