#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/internal/read_file.h>
#include <shapespace/bodies/bar.h>
#include <shapespace/output/detail/page_textures.h>
#include <shapespace/output/page.h>

#include "output/painted_cube.h"
#include "output/read_page.h"
#include "support/cut_body.h"

namespace shapespace {
namespace {

class PageTexturesTest : public PaintedCubeTest {
 protected:
  DecodedScene Write() {
    warnings_.clear();
    WritePage(Path("page.html"), "<p><!-- scenes --></p>", {PagePath{&path_, "cube"}}, {},
              &warnings_);
    return DecodedScene(ReadPage(Path("page.html"))[0].bytes);
  }

  std::vector<std::string> warnings_;
};

TEST_F(PageTexturesTest, EveryCornerOfEveryPartHasItsTextureCoordinate) {
  const DecodedScene scene = Write();
  const auto& parts = scene.header["textures"]["parts"];
  const std::vector<std::set<int>> polygons = {{0, 1, 3}, {2}, {4}, {5}};
  ASSERT_EQ(parts.size(), polygons.size());
  auto corner = scene.drawn_corners.begin();
  for (size_t i = 0; i < polygons.size(); ++i) {
    EXPECT_EQ(parts[i]["triangles"], 2 * polygons[i].size());
    for (const int p : polygons[i]) {
      for (int f = 2 * p; f < 2 * p + 2; ++f) {
        for (int k = 0; k < 3; ++k, ++corner) {
          const int v = connectivity_->Triangles()(k, f);
          EXPECT_EQ(scene.drawn_source[*corner], v);
          const int t = path_.appearance.corner_texture[CornerOf(p, v)];
          if (t < 0) continue;
          const Eigen::Vector2d uv = path_.appearance.texture_coordinates.col(t);
          EXPECT_EQ(scene.texture_coordinates.col(*corner),
                    Eigen::Vector2d(uv.x(), 1 - uv.y()).cast<float>());
        }
      }
    }
  }
  EXPECT_TRUE(corner == scene.drawn_corners.end());
  // One vertex for each pair of a vertex and its texture coordinate.
  EXPECT_EQ(scene.drawn_source.size(), 21u);
}

TEST_F(PageTexturesTest, ImagesAreAsInTheirFilesAndOtherMaterialsHaveTheirColour) {
  const DecodedScene scene = Write();
  const auto& textures = scene.header["textures"];
  ASSERT_EQ(scene.images.size(), 1u);
  EXPECT_EQ(scene.images[0], internal::ReadFile(Path("maps/checks.png")));
  EXPECT_EQ(textures["images"][0]["type"], "image/png");
  EXPECT_EQ(textures["parts"][0]["image"], 0);
  EXPECT_TRUE(textures["parts"][0]["colour"].is_null());
  EXPECT_EQ(textures["parts"][1]["colour"], (std::vector<double>{0.5, 0.25, 1}));
  EXPECT_TRUE(textures["parts"][2]["colour"].is_null());
  ASSERT_EQ(warnings_.size(), 1u);
  EXPECT_NE(warnings_[0].find("'unknown'"), std::string::npos);
}

TEST_F(PageTexturesTest, AVertexThatIsStoredTwiceIsDrawnWhereTheSurfaceHasIt) {
  const ShapeFamily bar = MakeBar(2, 1, 1, 2, 1, 1);
  const testing::CutBody cut = testing::CutIntoPolygons(*bar.connectivity);
  const auto joined = testing::Joined(cut, *bar.connectivity);
  Appearance appearance = path_.appearance;
  appearance.materials = {{"painted"}, std::vector<int>(joined->NumPolygons(), 0)};
  appearance.texture_coordinates.setZero(2, 1);
  appearance.corner_texture.assign(cut.corners.size(), 0);
  const auto textures = internal::FindPageTextures(*joined, appearance, false, &warnings_);
  ASSERT_TRUE(textures);
  ASSERT_EQ(textures->corners.size(), cut.triangles.size());
  EXPECT_EQ(Eigen::Map<const Eigen::Matrix3Xi>(textures->corners.data(), 3, cut.triangles.cols()),
            cut.triangles)
      << "with the textures of their own";
  for (Eigen::Index k = 0; k < joined->Triangles().size(); ++k) {
    EXPECT_EQ(textures->source[textures->corners[k]], joined->Triangles().data()[k]);
  }
}

TEST_F(PageTexturesTest, WhatCannotBeShownIsTold) {
  File("maps/checks.png", "no image");
  EXPECT_TRUE(Write().header["textures"].is_null());
  ASSERT_EQ(warnings_.size(), 2u);
  EXPECT_NE(warnings_[1].find("checks.png"), std::string::npos);

  // From outside of the folder only if that is permitted.
  path_.appearance.own_folder = Path("maps");
  EXPECT_TRUE(Write().header["textures"].is_null());
  EXPECT_NE(warnings_[0].find("cube.mtl"), std::string::npos);

  path_.appearance.corner_texture.clear();
  path_.appearance.texture_coordinates.resize(2, 0);
  EXPECT_TRUE(Write().header["textures"].is_null());
  EXPECT_TRUE(warnings_.empty()) << "nothing to show, nothing to tell";
}

}  // namespace
}  // namespace shapespace
