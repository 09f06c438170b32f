#ifndef SHAPESPACE_TESTS_SUPPORT_SAME_APPEARANCE_H_
#define SHAPESPACE_TESTS_SUPPORT_SAME_APPEARANCE_H_

#include <gtest/gtest.h>

#include <shapespace/mesh/appearance.h>

namespace shapespace::testing {

inline void ExpectSame(const PolygonNames& a, const PolygonNames& b) {
  EXPECT_EQ(a.names, b.names);
  EXPECT_EQ(a.of_polygon, b.of_polygon);
}

/// Expects equality to the last bit, except for the folder.
inline void ExpectSame(const Appearance& a, const Appearance& b) {
  EXPECT_EQ(a.texture_coordinates, b.texture_coordinates);
  EXPECT_EQ(a.corner_texture, b.corner_texture);
  EXPECT_EQ(a.material_libraries, b.material_libraries);
  ExpectSame(a.materials, b.materials);
  ExpectSame(a.groups, b.groups);
  ExpectSame(a.objects, b.objects);
  EXPECT_EQ(a.vertex_colours, b.vertex_colours);
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_SAME_APPEARANCE_H_
