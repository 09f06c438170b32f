// Paths whose shapes slide where they would pass through themselves.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/exponential/exponential.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/transfer/transfer.h>

#include "support/cut_ring.h"

namespace shapespace {
namespace {

using testing::CutRing;
using testing::MostIntersections;

TEST(SlideTest, AStoutBodyDoesNotPassThroughItselfAsTheSlimOneMoves) {
  const CutRing slim(1, 0.5), stout(1, 2);
  GeodesicOptions geodesic;
  geodesic.shapes = 7;
  // The slim one becomes more than a full ring.
  const std::vector<Shape> poses = {slim.Bent(0.7), slim.Bent(1.05)};
  const Path source = Interpolate(slim.connectivity, poses, geodesic).path;
  TransferOptions options;
  const TransferResult through = Transfer(source, stout.Bent(0.7), options);
  EXPECT_GT(MostIntersections(through.path), 0);
  EXPECT_EQ(through.summary.uncertified_segments, -1);
  options.avoid_contact = true;
  const TransferResult past = Transfer(source, stout.Bent(0.7), options);
  EXPECT_EQ(past.summary.uncertified_segments, 0) << past.summary.FullReport();
  EXPECT_EQ(MostIntersections(past.path), 0);
  EXPECT_GT(past.summary.contact_distance, 0);
  // It makes the motion but for contact.
  EXPECT_LT(past.summary.angle_rms, 2 * through.summary.angle_rms + 3);
  EXPECT_LT((past.path.Placed(2) - through.path.Placed(2)).norm(), 1e-9);
}

TEST(SlideTest, WithoutContactATransferIsTheSame) {
  const CutRing slim(1, 0.5), stout(1, 2);
  GeodesicOptions geodesic;
  geodesic.shapes = 3;
  const Path source =
      Interpolate(slim.connectivity, {slim.Bent(0.6), slim.Bent(0.8)}, geodesic).path;
  TransferOptions options;
  const TransferResult free = Transfer(source, stout.Bent(0.6), options);
  options.avoid_contact = true;
  const TransferResult past = Transfer(source, stout.Bent(0.6), options);
  EXPECT_EQ(past.path.shapes, free.path.shapes);
  EXPECT_EQ(past.summary.uncertified_segments, 0);
  EXPECT_TRUE(std::isnan(past.summary.contact_distance));
}

TEST(SlideTest, AnExtrapolationSlidesWhereItWouldPassThroughItself) {
  const CutRing ring;
  const Path path = testing::ClosingPath(ring);
  const ExponentialResult through = Extrapolate(path, 8);
  EXPECT_GT(MostIntersections(through.path), 0);
  EXPECT_EQ(through.summary.uncertified_segments, -1);
  ExponentialOptions options;
  options.slide_at_contact = true;
  const ExponentialResult past = Extrapolate(path, 8, options);
  EXPECT_TRUE(past.summary.Converged());
  ASSERT_EQ(past.path.NumShapes(), 11);
  for (const std::int64_t count : CountIntersections(*ring.connectivity, past.path.shapes)) {
    EXPECT_EQ(count, 0);
  }
  // Between two shapes an end may slide round the other on no straight way, which is said.
  EXPECT_LE(past.summary.uncertified_segments, 1);
  EXPECT_EQ(past.summary.warnings.empty(), past.summary.uncertified_segments == 0);
  EXPECT_GT(past.summary.contact_distance, 0);
  for (int i = 0; i < 8; ++i) EXPECT_EQ(past.path.shapes[i], through.path.shapes[i]) << i;
  EXPECT_GT((past.path.shapes[10] - through.path.shapes[10]).norm(), 1e-3);

  options.stop_at_contact = true;
  EXPECT_THROW(options.Validate(), InvalidOptions);
}

}  // namespace
}  // namespace shapespace
