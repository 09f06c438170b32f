#include <shapespace/mesh/appearance.h>

#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>

#include "support/message_of.h"

namespace shapespace {
namespace {

/// Of a mesh of 5 vertices and two polygons, which have 7 corners.
Appearance Whole() {
  Appearance appearance;
  appearance.texture_coordinates = Eigen::Matrix2Xd::Constant(2, 3, 1.5);
  appearance.corner_texture = {0, 1, 2, -1, 2, 1, 0};
  appearance.material_libraries = {"a.mtl"};
  appearance.materials = {{"skin", "fur"}, {1, -1}};
  appearance.groups = {{"leg"}, {0, 0}};
  appearance.objects = {{"cat"}, {-1, 0}};
  appearance.vertex_colours = Eigen::MatrixXd::Constant(4, 5, 1);
  appearance.vertex_colours(2, 3) = 0;
  return appearance;
}

std::string Message(const std::function<void(Appearance*)>& change) {
  Appearance appearance = Whole();
  change(&appearance);
  return testing::MessageOf<MeshError>([&] { appearance.Validate(5, 2, 7); });
}

TEST(AppearanceTest, AnyPartMayBeEmpty) {
  const std::string none = "nothing was thrown";
  EXPECT_EQ(Message([](Appearance*) {}), none);
  EXPECT_EQ(Message([](Appearance* a) { *a = {}; }), none);
  EXPECT_EQ(Message([](Appearance* a) { a->materials.of_polygon.clear(); }), none);
  EXPECT_EQ(Message([](Appearance* a) { a->vertex_colours.resize(0, 0); }), none);
  EXPECT_EQ(Message([](Appearance* a) { a->vertex_colours.conservativeResize(3, 5); }), none);
}

TEST(AppearanceTest, WhatDoesNotFitTheMeshIsNamed) {
  const std::string neither =
      "texture coordinates and their indices must both be there, or neither";
  EXPECT_EQ(Message([](Appearance* a) { a->corner_texture.clear(); }), neither);
  EXPECT_EQ(Message([](Appearance* a) { a->texture_coordinates.resize(2, 0); }), neither);
  for (const double bad : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    EXPECT_TRUE(testing::Names(Message([&](Appearance* a) { a->texture_coordinates(1, 2) = bad; }),
                               {"texture coordinate"}));
  }
  EXPECT_TRUE(testing::Names(Message([](Appearance* a) { a->corner_texture.pop_back(); }),
                             {"texture coordinates of corners:", "6", "7"}));
  EXPECT_TRUE(testing::Names(Message([](Appearance* a) { a->corner_texture[6] = 3; }),
                             {"texture coordinates of corners:", "index 3", "-1", "2"}));
  EXPECT_TRUE(testing::Names(Message([](Appearance* a) { a->corner_texture[0] = -2; }),
                             {"texture coordinates of corners:", "index -2", "-1", "2"}));
  EXPECT_TRUE(testing::Names(Message([](Appearance* a) { a->materials.of_polygon.push_back(0); }),
                             {"materials of polygons:", "3", "2"}));
  EXPECT_TRUE(testing::Names(Message([](Appearance* a) { a->materials.of_polygon[1] = 2; }),
                             {"materials of polygons:", "index 2", "-1", "1"}));
  EXPECT_TRUE(testing::Names(Message([](Appearance* a) { a->groups.of_polygon[1] = 1; }),
                             {"groups of polygons:", "index 1", "-1", "0"}));
  EXPECT_TRUE(testing::Names(Message([](Appearance* a) { a->objects.of_polygon = {0}; }),
                             {"objects of polygons:", "1", "2"}));
}

TEST(AppearanceTest, NamesAreTheRestOfALine) {
  const auto bad = [](const std::string& quoted) {
    return "name " + quoted + " is empty or holds a line end";
  };
  EXPECT_EQ(Message([](Appearance* a) { a->material_libraries.emplace_back(); }), bad("''"));
  EXPECT_EQ(Message([](Appearance* a) { a->materials.names[1] = "a\nb"; }), bad("'a?b'"));
  EXPECT_EQ(Message([](Appearance* a) { a->groups.names[0] = "c\r"; }), bad("'c?'"));
  EXPECT_EQ(Message([](Appearance* a) { a->objects.names[0] = std::string("d\0e", 3); }),
            bad("'d?e'"));
  EXPECT_EQ(Message([](Appearance* a) { a->objects.names[0] = "d e\t"; }), "nothing was thrown");
}

TEST(AppearanceTest, ColoursAreOfThreeOrFourNumbersFromZeroToOne) {
  const auto sized = [](int rows, int cols) {
    return Message([&](Appearance* a) { a->vertex_colours.setZero(rows, cols); });
  };
  EXPECT_EQ(sized(4, 6), "vertex colours: 4 x 6 instead of 3 or 4 x 5");
  EXPECT_EQ(sized(2, 5), "vertex colours: 2 x 5 instead of 3 or 4 x 5");
  EXPECT_EQ(sized(5, 5), "vertex colours: 5 x 5 instead of 3 or 4 x 5");
  EXPECT_EQ(sized(3, 5), "nothing was thrown");
  for (const double bad : {-1e-9, 1 + 1e-9, std::nan("")}) {
    EXPECT_TRUE(testing::Names(Message([&](Appearance* a) { a->vertex_colours(3, 4) = bad; }),
                               {"vertex colours:", "0", "1"}));
  }
}

}  // namespace
}  // namespace shapespace
