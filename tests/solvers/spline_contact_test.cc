// Smooth motion that does not pass through itself.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/spline/spline.h>

#include "support/cut_ring.h"

namespace shapespace {
namespace {

using testing::CutRing;
using testing::MostIntersections;

SplineOptions Loose(SplineEnds ends = SplineEnds::kNatural) {
  SplineOptions options;
  options.ends = ends;
  options.hold_limit = 0;  // so that the spline swings far
  options.geodesic.shapes = 7;
  options.geodesic.tolerance = 1e-6;
  return options;
}

SplineResult Avoiding(const CutRing& ring, const std::vector<Shape>& poses, SplineOptions options) {
  options.geodesic.avoid_contact = true;
  return Spline(ring.connectivity, poses, options);
}

// Closes fast, and then hardly any more.
std::vector<Shape> Closing(const CutRing& ring) {
  return {ring.Bent(0.5), ring.Bent(0.93), ring.Bent(0.95)};
}

TEST(SplineContactTest, IsLedRoundWhereItWouldSwingIntoContact) {
  const CutRing ring;
  const std::vector<Shape> poses = Closing(ring);
  const SplineResult swinging = Spline(ring.connectivity, poses, Loose());
  EXPECT_GT(MostIntersections(swinging.path), 0);
  EXPECT_EQ(swinging.summary.uncertified_segments, -1);
  const auto [path, summary] = Avoiding(ring, poses, Loose());
  EXPECT_EQ(MostIntersections(path), 0);
  EXPECT_EQ(summary.uncertified_segments, 0) << summary.FullReport();
  EXPECT_GT(summary.contact_distance, 0);
  EXPECT_TRUE(summary.smooth);
  EXPECT_LT(summary.jump_after, 0.2 * summary.jump_before);
  for (int pose = 0; pose < 3; ++pose) {
    EXPECT_EQ(path.shapes[path.poses[pose]], swinging.path.shapes[swinging.path.poses[pose]]);
  }
}

TEST(SplineContactTest, WithoutContactTheMotionIsTheSame) {
  const CutRing ring;
  const std::vector<Shape> poses = {ring.Bent(0.4), ring.Bent(0.6), ring.Bent(0.7)};
  const auto [path, summary] = Avoiding(ring, poses, Loose());
  EXPECT_EQ(path.shapes, Spline(ring.connectivity, poses, Loose()).path.shapes);
  EXPECT_EQ(summary.uncertified_segments, 0);
  EXPECT_TRUE(std::isnan(summary.contact_distance));
}

TEST(SplineContactTest, ScalesWithTheBody) {
  const CutRing ring, large(1000);
  const SplineResult one = Avoiding(ring, Closing(ring), Loose());
  const SplineResult other = Avoiding(large, Closing(large), Loose());
  for (int k = 0; k < one.path.NumShapes(); ++k) {
    EXPECT_LT((1000 * one.path.Placed(k) - other.path.Placed(k)).norm(),
              1e-3 * other.path.Placed(k).norm());
  }
  EXPECT_NEAR(other.summary.contact_distance, 1000 * one.summary.contact_distance,
              0.1 * other.summary.contact_distance);
}

TEST(SplineContactTest, WhenStoppedItIsTheChain) {
  struct StopPastContacts : Progress {
    bool Report(const std::string& stage, int, int) override {
      return stage != "smoothing past contacts";
    }
  } progress;
  const CutRing ring;
  SplineOptions options = Loose();
  options.geodesic.avoid_contact = true;
  const auto [path, summary] = Spline(ring.connectivity, Closing(ring), options, &progress);
  EXPECT_FALSE(summary.smooth);
  EXPECT_FALSE(summary.Converged());
  EXPECT_EQ(summary.uncertified_segments, 0);  // of the chain
  EXPECT_EQ(path.shapes,
            Interpolate(ring.connectivity, Closing(ring), options.geodesic).path.shapes);
}

}  // namespace
}  // namespace shapespace
