// Standing parts of a path whose shapes are given, so that every place can be worked out.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/bodies/bar.h>
#include <shapespace/deformation/standing.h>
#include <shapespace/mesh/rigid_motion.h>

#include "support/message_of.h"
#include "support/motions.h"
#include "support/path_of.h"

namespace shapespace {
namespace {

using testing::Distance;
using testing::Where;

// Three poses of a bar with two shapes in between, whose times are not even.
struct SteppingBar {
  SteppingBar() {
    const Shape rest = bar.pose(0);
    left = Where(rest, [](const auto& p) { return p.x() < -2.9; });
    right = Where(rest, [](const auto& p) { return p.x() > 2.9; });
    std::vector<Shape> shapes;
    for (int k = 0; k < 7; ++k) {
      shapes.push_back((testing::Rotation(3 * k, {1, 2, 3}) * bar.pose(4 * k)).colwise() +
                       Eigen::Vector3d(20 + 0.1 * k, 0.02 * k * k, -5));
    }
    path = testing::PathOf(bar.connectivity, shapes);
    path.poses = {0, 3, 6};
    path.parameters = {0, 0.1, 0.2, 0.4, 0.5, 0.8, 1};
  }
  Shape Of(const std::vector<int>& part, int k) const { return path.Placed(k)(Eigen::all, part); }
  ShapeFamily bar = MakeBar(6, 1, 1, 6, 2, 2);
  std::vector<int> left, right;
  Path path;
};

TEST(Standing, PlacesAreReachedByTheCubicAndOthersKeepTheirCourse) {
  const SteppingBar stepping;
  const std::vector<StandingPart> parts = {{"left", stepping.left, {{0, 1}}},
                                           {"right", stepping.right, {{1, 2}}}};
  struct Recorder : Progress {
    bool Report(const std::string& stage, int done, int total) override {
      if (stage == "standing parts") {
        stages.push_back(std::to_string(done) + "/" + std::to_string(total));
      }
      return true;
    }
    std::vector<std::string> stages;
  } recorder;
  Path held = stepping.path;
  const StandingSummary summary =
      HoldStandingParts(stepping.path, parts, StandingDefaults(), &held, &recorder);
  EXPECT_EQ(recorder.stages,
            (std::vector<std::string>{"0/7", "1/7", "2/7", "3/7", "4/7", "5/7", "6/7"}));
  EXPECT_TRUE(summary.Converged());
  EXPECT_TRUE(held.converged);
  EXPECT_EQ(summary.parts, 2);
  EXPECT_EQ(summary.shapes, 4);
  const double diagonal = testing::Diameter(stepping.path.Placed(0));
  double slide = 0;
  const double shares[] = {0, 0.25, 0.5, 0, 1 / 6., 4 / 6., 0};
  for (const int k : {1, 2, 4, 5}) {
    const double s = shares[k], cubic = 3 * s * s - 2 * s * s * s;
    const bool first = k < 3;
    const std::vector<int>&stands = first ? stepping.left : stepping.right,
          &free = first ? stepping.right : stepping.left;
    const int begin = first ? 0 : 3;
    const Shape place =
        (1 - cubic) * stepping.Of(stands, begin) + cubic * stepping.Of(stands, begin + 3);
    EXPECT_LT(Distance(held.Placed(k)(Eigen::all, stands), place), 1e-9) << k;
    EXPECT_LT(Distance(held.Placed(k)(Eigen::all, free), stepping.Of(free, k)), 1e-9) << k;
    slide = std::max(slide, Distance(stepping.Of(stands, k), place));
    // Shapes remain centred, and are turned as before.
    EXPECT_LT(Centroid(held.shapes[k], held.metric->vertex_area).norm(), 1e-9);
    EXPECT_EQ(held.motions[k].rotation, stepping.path.motions[k].rotation);
  }
  for (const int k : {0, 3, 6}) {
    EXPECT_EQ(held.shapes[k], stepping.path.shapes[k]);
    EXPECT_EQ(held.motions[k].translation, stepping.path.motions[k].translation);
  }
  EXPECT_NEAR(summary.slide_before, slide / diagonal, 1e-12);
  EXPECT_LT(summary.slide, 1e-12);
  const double left_drift = Distance(stepping.Of(stepping.left, 0), stepping.Of(stepping.left, 3));
  const double right_drift =
      Distance(stepping.Of(stepping.right, 3), stepping.Of(stepping.right, 6));
  EXPECT_NEAR(summary.drift, std::max(left_drift, right_drift) / diagonal, 1e-12);
  EXPECT_GT(summary.edge_rms, 0);
  EXPECT_LT(summary.edge_rms, 0.1);
  EXPECT_TRUE(summary.warnings.empty());
  // Only what stands counts for the drift.
  const std::vector<StandingPart> one = {{"left", stepping.left, {{0, 1}}}};
  held = stepping.path;
  const StandingSummary alone = HoldStandingParts(stepping.path, one, StandingDefaults(), &held);
  EXPECT_NEAR(alone.drift, left_drift / diagonal, 1e-12);
  EXPECT_EQ(alone.parts, 1);
  EXPECT_EQ(alone.shapes, 2);
  for (const int k : {4, 5}) EXPECT_EQ(held.shapes[k], stepping.path.shapes[k]);
}

TEST(Standing, AWarningIsGivenOnceAndThePathSaysThatItHasNotConverged) {
  const SteppingBar stepping;
  const std::vector<StandingPart> parts = {{"left", stepping.left, {{0, 2}}},
                                           {"right", stepping.right, {{0, 1}}}};
  DeformationOptions options = StandingDefaults();
  options.tolerance = 1e-14;
  options.max_iterations = 1;
  Path held = stepping.path;
  const StandingSummary summary = HoldStandingParts(stepping.path, parts, options, &held);
  EXPECT_EQ(summary.termination, Termination::kMaxIterations);
  EXPECT_EQ(summary.shapes, 4);
  EXPECT_TRUE(testing::EachNames(summary.warnings, {{"max_iterations"}}));
  EXPECT_FALSE(held.converged);
  held = stepping.path;
  held.converged = false;
  EXPECT_TRUE(HoldStandingParts(stepping.path, parts, StandingDefaults(), &held).Converged());
  EXPECT_FALSE(held.converged);
  struct Stops : Progress {
    bool Report(const std::string&, int done, int) override { return done < 2; }
  } stops;
  const StandingSummary stopped =
      HoldStandingParts(stepping.path, parts, StandingDefaults(), &held, &stops);
  EXPECT_EQ(stopped.parts, 2);
  EXPECT_EQ(stopped.shapes, 0);
  EXPECT_TRUE(testing::EachNames(stopped.warnings, {{"stopped"}}));
}

}  // namespace
}  // namespace shapespace
