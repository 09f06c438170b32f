// What paths that avoid contact say of themselves.

#include <algorithm>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/analysis/intersections.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/geodesic/geodesic.h>

#include "support/contact_bodies.h"
#include "support/cut_ring.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

GeodesicOptions RoundContacts(int shapes) {
  GeodesicOptions options;
  options.shapes = shapes;
  options.avoid_contact = true;
  return options;
}

// A cube moves beside a closed box, and then into it.
TEST(GeodesicContactFigures, NamesThePieceInWhichNoWayWasFound) {
  const testing::CubeAndBox body(3);
  const auto [path, summary] =
      Interpolate(body.connectivity, {body.At(6), body.At(5), body.At(1)}, RoundContacts(3));
  ASSERT_EQ(path.NumShapes(), 9);
  ASSERT_GE(summary.warnings.size(), 2u);
  EXPECT_TRUE(testing::Names(summary.warnings[0], {"piece 1:"}));
  EXPECT_GT(summary.uncertified_segments, 0);
  EXPECT_LE(summary.uncertified_segments, 4);
  EXPECT_TRUE(testing::Names(summary.warnings[1],
                             {std::to_string(summary.uncertified_segments), "contact"}));
  EXPECT_GT(summary.contact_seconds, 0);
  EXPECT_GT(summary.solve_seconds, summary.contact_seconds);

  // No pose intersects itself; the greatest number in the middle of a segment counts.
  std::vector<Shape> middles;
  for (int i = 0; i < 8; ++i) middles.push_back(0.5 * (path.shapes[i] + path.shapes[i + 1]));
  const std::vector<std::int64_t> pairs = CountIntersections(*body.connectivity, middles);
  const std::int64_t most = *std::max_element(pairs.begin(), pairs.end());
  EXPECT_GT(most, 0);
  EXPECT_EQ(summary.crossings_between, static_cast<double>(most));
}

TEST(GeodesicContactFigures, NamesThePieceWhosePosesIntersect) {
  const testing::CutRing ring;
  const Shape wound = ring.Wound(0.25, 0.15);
  const std::string pairs = std::to_string(CountIntersections(*ring.connectivity, wound));
  ASSERT_NE(pairs, "0");
  const GeodesicSummary summary =
      Interpolate(ring.connectivity, {ring.poses[0], ring.poses[0], wound}, RoundContacts(1))
          .summary;
  ASSERT_FALSE(summary.warnings.empty());
  EXPECT_TRUE(testing::Names(summary.warnings[0], {"piece 1:", pairs}));

  // The same where a path begins.
  const auto metric = FreezeMetric({}, ring.connectivity, {wound});
  ExponentialOptions stop;
  stop.stop_at_contact = true;
  const Tangent rest = Tangent::Zero(3, wound.cols());
  const ExponentialSummary shot = Extrapolate(metric, wound, rest, 1, stop).summary;
  ASSERT_FALSE(shot.warnings.empty());
  EXPECT_TRUE(testing::Names(shot.warnings[0], {pairs, "intersects itself"}));
}

TEST(GeodesicContactFigures, SaysAtWhichStepPartsTouch) {
  const testing::CutRing ring;
  ExponentialOptions stop;
  stop.stop_at_contact = true;
  const ExponentialSummary summary = Extrapolate(testing::ClosingPath(ring), 8, stop).summary;
  EXPECT_TRUE(testing::Names(summary.stopped, {"step 6:"}));
  EXPECT_EQ(summary.steps.size(), 5u);
  EXPECT_EQ(summary.requested_steps, 8);
  EXPECT_TRUE(summary.warnings.empty());
}

}  // namespace
}  // namespace shapespace
