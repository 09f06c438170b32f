#include <shapespace/deformation/repair.h>

#include <cmath>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/bodies/tube.h>

#include "support/message_of.h"
#include "support/motions.h"

namespace shapespace {
namespace {

using testing::Diameter;
using testing::MessageOf;
using testing::Rotation;

// Half way on straight lines between two poses of a finger, with dents.
struct Finger {
  ShapeFamily body = MakeTube(3000);
  Shape rest = body.pose(0);
  Shape bent = body.pose(140);
  Shape distorted = 0.5 * (rest + bent);

  Finger() {
    for (int k = 0; k < 6; ++k) {
      const Eigen::Vector3d centre = rest.col(k * 217 + 40);
      for (int v = 0; v < rest.cols(); ++v) {
        const double share = (rest.col(v) - centre).norm() / 0.8;
        if (share < 1) distorted.col(v).z() -= 0.3 * std::pow(1 - share * share, 2);
      }
    }
  }
};

TEST(Repair, RestoresVolumeAndLengthsAndKeepsThePose) {
  const Finger finger;
  const RepairSummary summary =
      Repair(finger.body.connectivity, finger.rest, finger.distorted).summary;
  EXPECT_TRUE(summary.Converged());
  EXPECT_LT(summary.before.volume, -0.2);
  EXPECT_LT(std::abs(summary.after.volume), 0.036 / 0.25 * -summary.before.volume);
  EXPECT_LT(summary.after.edge_rms, 0.25 * summary.before.edge_rms);
  EXPECT_EQ(summary.after.inverted_hinges, 0);
  EXPECT_LT(summary.moved, 0.1 * Diameter(finger.rest));
}

TEST(Repair, LeavesAMovedCopyOfTheReferenceAsItIs) {
  const Finger finger;
  const Shape copy = (Rotation(70, {1, 2, 3}) * finger.rest).colwise() + Eigen::Vector3d(3, -20, 1);
  const RepairResult result = Repair(finger.body.connectivity, finger.rest, copy);
  EXPECT_LT(result.summary.moved, 1e-9);
  // The path to it begins with the reference, aligned with it.
  for (const Shape& shape : result.path.Placed()) {
    EXPECT_LT((shape - copy).cwiseAbs().maxCoeff(), 1e-9);
  }
}

TEST(Repair, TheBalanceTradesPoseForGeometry) {
  const Finger finger;
  double error = 1, moved = 0;
  for (double balance : {0.01, 0.1, 0.5, 0.9}) {
    RepairOptions options;
    options.deformation.balance = balance;
    const RepairSummary summary =
        Repair(finger.body.connectivity, finger.rest, finger.distorted, options).summary;
    EXPECT_LT(summary.after.edge_rms, error);
    EXPECT_GT(summary.moved, moved);
    error = summary.after.edge_rms;
    moved = summary.moved;
  }
}

// A lost leg is not selected; the rest of the body determines its position.
TEST(Repair, KeepsOnlyTheVerticesThatAreNamed) {
  const Finger finger;
  Shape broken = finger.rest;
  std::vector<int> sound;
  for (int v = 0; v < broken.cols(); ++v) {
    if (finger.rest(0, v) < 4) {
      sound.push_back(v);
    } else {
      broken.col(v) *= 0.2;
    }
  }
  RepairOptions options;
  options.vertices = sound;
  const RepairResult result = Repair(finger.body.connectivity, finger.rest, broken, options);
  EXPECT_LT((result.path.Placed(1) - finger.rest).cwiseAbs().maxCoeff(),
            0.02 * Diameter(finger.rest));
}

TEST(Repair, MakesAPathOfAsManyShapesAsAreAskedFor) {
  const Finger finger;
  RepairOptions options;
  options.deformation.shapes = 4;
  const RepairResult result =
      Repair(finger.body.connectivity, finger.rest, finger.distorted, options);
  ASSERT_EQ(result.path.NumShapes(), 5);
  EXPECT_TRUE(result.summary.Converged());
  // A path with steps of equal length, slightly longer than the chord.
  const RepairResult chord = Repair(finger.body.connectivity, finger.rest, finger.distorted);
  EXPECT_LT(std::abs(result.summary.after.edge_rms - chord.summary.after.edge_rms), 0.01);
}

TEST(Repair, RefusesWhatMakesNoSense) {
  const Finger finger;
  RepairOptions options;
  options.vertices = {-1};
  EXPECT_EQ(MessageOf<InvalidOptions>([&] {
              Repair(finger.body.connectivity, finger.rest, finger.distorted, options);
            }).find("vertices: -1"),
            0u);
}

}  // namespace
}  // namespace shapespace
