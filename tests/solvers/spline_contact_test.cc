// Smooth motion that does not pass through itself.

#include <cmath>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/spline/spline.h>

#include "support/contact_bodies.h"
#include "support/cut_ring.h"

namespace shapespace {
namespace {

using testing::CubeAndBox;
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

// Of poses without symmetry: where two ways round are mirror images, rounding takes one of them.
TEST(SplineContactTest, ScalesWithTheBody) {
  const auto skew = [](std::vector<Shape> poses) {
    Eigen::Matrix3d matrix;
    matrix << 1, 0.1, 0.05, 0, 1, 0.1, 0.07, 0, 1;
    for (Shape& pose : poses) pose = (matrix * pose).eval();
    return poses;
  };
  const CutRing ring, large(1000);
  const SplineResult one = Avoiding(ring, skew(Closing(ring)), Loose());
  const SplineResult other = Avoiding(large, skew(Closing(large)), Loose());
  for (int k = 0; k < one.path.NumShapes(); ++k) {
    EXPECT_LT((1000 * one.path.Placed(k) - other.path.Placed(k)).norm(),
              1e-3 * other.path.Placed(k).norm());
  }
  EXPECT_NEAR(other.summary.contact_distance, 1000 * one.summary.contact_distance,
              0.1 * other.summary.contact_distance);
}

// A rod that comes down steeply, and rises slowly, bent: in between it would swing through the
// floor.
struct LandingRod {
  explicit LandingRod(double unit = 1, const Eigen::Vector3d& of_origin = Eigen::Vector3d::Zero())
      : ring(unit), origin(of_origin) {
    poses = {At(ring.Rod(), 3), At(ring.Rod(), 0.1), At(ring.Bent(0.1), 0.2)};
    floor = testing::Rectangle({-20, -20}, {20, 20}, 0);
    floor.shape = (unit * floor.shape).colwise() + origin;
  }
  // With its lowest vertex so high above the floor.
  Shape At(Shape shape, double height) const {
    shape.row(2).array() += height * ring.unit - shape.row(2).minCoeff();
    return shape.colwise() + origin;
  }
  SplineResult Land(bool past_floor) const {
    SplineOptions options = Loose();
    if (past_floor) {
      options.geodesic.avoid_contact = true;
      options.geodesic.obstacle = floor;
    }
    return Spline(ring.connectivity, poses, options);
  }
  CutRing ring;
  Eigen::Vector3d origin;
  std::vector<Shape> poses;
  Obstacle floor;
};

TEST(SplineContactTest, IsLedPastAnObstacle) {
  const LandingRod rod;
  const SplineResult through = rod.Land(false);
  EXPECT_GT(MostIntersections(through.path, rod.floor), 0);
  const auto [path, summary] = rod.Land(true);
  EXPECT_EQ(MostIntersections(path, rod.floor), 0);
  EXPECT_EQ(summary.uncertified_segments, 0) << summary.FullReport();
  EXPECT_GT(summary.contact_distance, 0);
  EXPECT_LT(summary.jump_after, 0.3 * summary.jump_before);
  for (int pose = 0; pose < 3; ++pose) {
    EXPECT_LT((path.Placed(path.poses[pose]) - rod.poses[pose]).norm(), 1e-9);
  }
  // Where the floor is far, in the first half of the fall, it is the spline without one.
  EXPECT_LT((path.Placed(3) - through.path.Placed(3)).colwise().norm().maxCoeff(), 0.05);
}

TEST(SplineContactTest, PastAnObstacleUnitAndPlaceDoNotMatter) {
  const LandingRod rod, other(1000, {1e6, -2e6, 5e5});
  const SplineResult one = rod.Land(true), two = other.Land(true);
  for (int k = 0; k < one.path.NumShapes(); ++k) {
    const Shape moved = (1000 * one.path.Placed(k)).colwise() + other.origin;
    EXPECT_LT((moved - two.path.Placed(k)).colwise().norm().maxCoeff(), 10);
  }
}

TEST(SplineContactTest, SegmentsWithContactOfAllIntervalsCount) {
  // A cube goes out of a closed box, and in again.
  const CubeAndBox body(6);
  const std::vector<Shape> poses = {body.At(1), body.At(5), body.At(1.5)};
  SplineOptions options = Loose();
  options.geodesic.shapes = 3;
  options.geodesic.avoid_contact = true;
  const auto [path, summary] = Spline(body.connectivity, poses, options);
  int touching[2] = {0, 0};
  for (int k = 0; k + 1 < path.NumShapes(); ++k) {
    if (MostIntersections(SelectShapes(path, {k, k + 1})) > 0)
      ++touching[k < path.poses[1] ? 0 : 1];
  }
  EXPECT_GT(touching[0], 0);
  EXPECT_GT(touching[1], 0);
  EXPECT_GE(summary.uncertified_segments, touching[0] + touching[1]);
  EXPECT_LE(summary.uncertified_segments, path.NumShapes() - 1);
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
