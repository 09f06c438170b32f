#include <shapespace/files/display_names.h>

#include <gtest/gtest.h>

namespace shapespace {
namespace {

using ListOfNames = std::vector<std::string>;

TEST(DisplayNamesTest, FilesLoseFolderAndExtensionOthersNothing) {
  EXPECT_EQ(DisplayNames({"/home/anna/cat/sit.obj", "../stand.002.GLB", "sit.001", "mouth/open"}),
            (ListOfNames{"sit", "stand.002", "sit.001", "mouth/open"}));
}

TEST(DisplayNamesTest, NoTwoAreEqual) {
  EXPECT_EQ(DisplayNames({"a/sit.obj", "b/sit.obj", "sit 2", "sit"}),
            (ListOfNames{"sit", "sit 2", "sit 2 2", "sit 3"}));
}

TEST(DisplayNamesTest, EveryFormatOfMeshesIsKnownInAnyCase) {
  EXPECT_EQ(DisplayNames({"f.d/a.obj", "f.d/b.PLY", "f.d/c.off", "f.d/d.stl", "f.d/e.glb",
                          "f.d/f.gltf", "f.d/g.vtk", "f.d/h.vtp", "f.d/i.txt", "f.d/j"}),
            (ListOfNames{"a", "b", "c", "d", "e", "f", "g", "h", "f.d/i.txt", "f.d/j"}));
}

TEST(DisplayNamesTest, EqualNamesAreNumberedFromTheSecondOn) {
  EXPECT_EQ(DisplayNames({"sit", "lie", "a/sit.ply", "sit", "lie.obj", "sit.off"}),
            (ListOfNames{"sit", "lie", "sit 2", "sit 3", "lie 2", "sit 4"}));
  EXPECT_EQ(DisplayNames({}), ListOfNames());
}

}  // namespace
}  // namespace shapespace
