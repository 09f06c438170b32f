#include <shapespace/analysis/path_intersections.h>

#include <cmath>

#include <gtest/gtest.h>

#include <shapespace/analysis/intersections.h>

#include "support/path_of.h"

namespace shapespace {
namespace {

using testing::PathOf;

// Two triangles, one above the other, or intersecting.
const auto kTwo =
    Connectivity::FromTriangles(6, (Eigen::Matrix3Xi(3, 2) << 0, 3, 1, 4, 2, 5).finished());

Shape Two(double height) {
  Shape shape(3, 6);
  shape << 0, 3, 0, 0.5, 1, 0.5,  //
      0, 0, 3, 0.5, 0.5, 1,       //
      0, 0, 0, height, height + 1, height + 1;
  return shape;
}

TEST(MeasureIntersections, TellsThePathsFromThePoses) {
  const Shape apart = Two(0.5), through = Two(-0.5);
  ASSERT_EQ(CountIntersections(*kTwo, apart), 0);
  ASSERT_EQ(CountIntersections(*kTwo, through), 1);

  PathIntersections figures = MeasureIntersections(PathOf(kTwo, {apart, through, apart, apart}));
  EXPECT_EQ(figures.pairs, (std::vector<std::int64_t>{0, 1, 0, 0}));
  EXPECT_EQ(figures.poses_max, 0);
  EXPECT_EQ(figures.inner_max, 1);
  EXPECT_EQ(figures.inner_mean, 0.5);
  EXPECT_EQ(figures.beyond_poses, 0.5);

  figures = MeasureIntersections(PathOf(kTwo, {apart, through, apart, through}));
  EXPECT_EQ(figures.poses_max, 1);
  EXPECT_EQ(figures.inner_mean, 0.5);
  EXPECT_EQ(figures.beyond_poses, 0);

  figures = MeasureIntersections(PathOf(kTwo, {through, apart}));
  EXPECT_EQ(figures.poses_max, 1);
  EXPECT_EQ(figures.inner_max, -1);
  EXPECT_TRUE(std::isnan(figures.inner_mean));
  EXPECT_TRUE(std::isnan(figures.beyond_poses));
}

TEST(MeasureIntersections, LooksAtThePosesAroundEachShape) {
  const Shape apart = Two(0.5), through = Two(-0.5);
  Path path = PathOf(kTwo, {through, through, apart, through, apart});
  path.poses = {0, 2, 4};
  EXPECT_EQ(MeasureIntersections(path).beyond_poses, 0.5);  // shape 3, not shape 1
  path.poses = {2};                                         // continued beyond its poses
  EXPECT_EQ(MeasureIntersections(path).beyond_poses, 0.75);
}

}  // namespace
}  // namespace shapespace
