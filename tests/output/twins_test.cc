#include <vector>

#include <gtest/gtest.h>

#include <shapespace/bodies/bar.h>
#include <shapespace/output/detail/seams.h>
#include <shapespace/output/frames.h>

#include "support/cut_body.h"

namespace shapespace {
namespace {

// Vertices that are joined for solvers still have the texture coordinates of their own, for which
// the file has them several times.
TEST(OutputOfTwins, HasTheirOwnCornersAndTextures) {
  const ShapeFamily bar = MakeBar(2, 1, 1, 2, 1, 1);
  const testing::CutBody cut = testing::CutIntoPolygons(*bar.connectivity);
  const auto joined = testing::Joined(cut, *bar.connectivity);
  Appearance appearance;
  const auto corners = static_cast<Eigen::Index>(cut.corners.size());
  appearance.texture_coordinates.resize(2, corners);
  for (int k = 0; k < corners; ++k) {
    appearance.texture_coordinates.col(k) << k, -k;
    appearance.corner_texture.push_back(k);
  }
  const internal::CutMesh mesh = internal::CutAtSeams(*joined, appearance);
  EXPECT_EQ(mesh.source.size(), cut.source.size());  // no vertex has two textures
  EXPECT_EQ(mesh.triangles, cut.triangles);
  for (int k = 0; k < corners; ++k) EXPECT_EQ(mesh.texture(0, cut.corners[k]), k);
  EXPECT_EQ(FrameSoup(*joined).triangles, cut.triangles);
  EXPECT_EQ(FrameSoup(*joined).corners, cut.corners);
}

}  // namespace
}  // namespace shapespace
