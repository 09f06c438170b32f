#include <shapespace/files/read.h>
#include <shapespace/output/frames.h>
#include <shapespace/output/gltf.h>

#include "mesh/bodies.h"
#include "mesh/files.h"
#include "support/path_of.h"

namespace shapespace {
namespace {

class GltfReadTest : public testing::FilesTest {
 protected:
  GltfReadTest() {
    const Soup torus = testing::Torus(12, 8);
    connectivity_ = testing::Connected(torus);
    const Eigen::Vector3d stretch(1, 1.5, 0.75);
    const Shape end = stretch.asDiagonal() * torus.vertices;
    shapes_ = {torus.vertices, (torus.vertices + end) / 2, end};
  }

  /// Writes the path and expects its shapes, transformed as the options say, to be read.
  void ExpectReadBack(const shapespace::Path& path, const GltfOptions& options) {
    WriteGltf(Path("a.glb"), path, options);
    const std::vector<Soup> soups = ReadSoups(Path("a.glb"));
    ASSERT_EQ(soups.size(), shapes_.size());
    const Eigen::Matrix3Xi& triangles = connectivity_->Triangles();
    for (size_t i = 0; i < soups.size(); ++i) {
      ASSERT_EQ(soups[i].NumVertices(), connectivity_->NumVertices());
      Shape wanted = options.unit * path.Placed(static_cast<int>(i));
      if (options.up == 'z') {
        wanted.row(1).swap(wanted.row(2));
        wanted.row(2) *= -1;
      }
      EXPECT_LT((soups[i].vertices - wanted).cwiseAbs().maxCoeff(), 2e-6 * options.unit) << i;
      EXPECT_EQ(soups[i].corners,
                std::vector<int>(triangles.data(), triangles.data() + triangles.size()));
    }
  }

  std::shared_ptr<const Connectivity> connectivity_;
  std::vector<Shape> shapes_;
};

TEST_F(GltfReadTest, AnimationsThatWereWrittenAreReadBack) {
  ExpectReadBack(testing::PathOf(connectivity_, shapes_), {});
  GltfOptions millimetres;
  millimetres.unit = 0.001;
  millimetres.up = 'z';
  ExpectReadBack(testing::PathOf(connectivity_, shapes_), millimetres);
  for (Shape& shape : shapes_) shape.array() += 1e6;
  ExpectReadBack(testing::PathOf(connectivity_, shapes_), {});
}

// Where the texture has seams, the file has copies of vertices.
TEST_F(GltfReadTest, SeamsAreClosedAndKeepTheirTexture) {
  shapespace::Path path = testing::PathOf(connectivity_, shapes_);
  Appearance& appearance = path.appearance;
  const auto corners = static_cast<int>(connectivity_->Corners().size());
  appearance.texture_coordinates.resize(2, corners);
  for (int k = 0; k < corners; ++k) {
    appearance.corner_texture.push_back(k);
    appearance.texture_coordinates.col(k) << k % 7 / 8.0, k % 5 / 8.0;
  }
  ExpectReadBack(path, {});
  const Soup read = ReadSoup(Path("a.glb"));
  // Of each corner of a triangle, the texture coordinates of the polygon's corner.
  for (size_t k = 0; k < read.corners.size(); ++k) {
    const size_t polygon = k / 6;
    size_t corner = 4 * polygon;
    while (connectivity_->Corners()[corner] != read.corners[k]) ++corner;
    EXPECT_EQ(read.appearance.texture_coordinates.col(read.appearance.corner_texture[k]),
              appearance.texture_coordinates.col(static_cast<Eigen::Index>(corner)));
  }
}

}  // namespace
}  // namespace shapespace
