#include <shapespace/output/detail/materials.h>

#include "mesh/files.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

class ReadMaterialsTest : public testing::FilesTest {
 protected:
  std::vector<std::optional<internal::Material>> Read(const std::vector<std::string>& libraries,
                                                      const std::vector<std::string>& names) {
    Appearance appearance;
    appearance.material_libraries = libraries;
    appearance.folder = appearance.own_folder = Path("");
    appearance.materials.names = names;
    return internal::ReadMaterials(appearance, /*allow_outside_files=*/false, &warnings_);
  }

  std::vector<std::string> warnings_;
};

TEST_F(ReadMaterialsTest, ReadsColourOpacityAndTexture) {
  File(
      "a b.mtl",
      "# made by hand\r\nnewmtl red paint\r\nKa 1 1 1\r\nKd 0.5 0.25 1\r\nd 0.75\r\nillum 2\r\n\r\n"
      "newmtl glass\nTr 0.9\nKd 2 -1 0\nnewmtl wood\nmap_Kd maps\\oak plank.png\n");
  const auto materials = Read({"a b.mtl"}, {"wood", "red paint", "glass"});
  ASSERT_EQ(materials.size(), 3u);
  EXPECT_EQ(materials[0]->texture, Path("maps/oak plank.png"));
  EXPECT_EQ(materials[0]->opacity, 1);
  EXPECT_EQ(materials[1]->colour, Eigen::Vector3d(0.5, 0.25, 1));
  EXPECT_EQ(materials[1]->opacity, 0.75);
  EXPECT_EQ(materials[1]->texture, "");
  EXPECT_NEAR(materials[2]->opacity, 0.1, 1e-15);
  EXPECT_EQ(materials[2]->colour, Eigen::Vector3d(1, 0, 0));
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(ReadMaterialsTest, TakesSeveralLibrariesOfOneStatement) {
  File("a.mtl", "newmtl a\nd 0.5\n");
  File("b.mtl", "newmtl b\nd 0.25\n");
  const auto materials = Read({"a.mtl b.mtl"}, {"a", "b"});
  EXPECT_EQ(materials[0]->opacity, 0.5);
  EXPECT_EQ(materials[1]->opacity, 0.25);
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(ReadMaterialsTest, WarnsOfWhatIsMissing) {
  File("a.mtl", "newmtl a\nKd 0 0 nan\nKd 1\nmap_Kd\nmap_Kd -s 2 2 2 a.png\nd\n");
  const auto materials = Read({"none.mtl", "a.mtl"}, {"a", "b", "c"});
  ASSERT_TRUE(materials[0]);
  EXPECT_EQ(materials[0]->colour, Eigen::Vector3d::Ones());
  EXPECT_EQ(materials[0]->texture, Path("a.png"));
  EXPECT_FALSE(materials[1]);
  ASSERT_EQ(warnings_.size(), 7u);
  EXPECT_TRUE(testing::Names(warnings_[0], {Path("none.mtl"), "No such file"}));
  EXPECT_TRUE(testing::Names(warnings_[1], {Path("a.mtl") + ":2:", "'Kd 0 0 nan'"}));
  EXPECT_TRUE(testing::Names(warnings_[2], {Path("a.mtl") + ":3:", "'Kd 1'"}));
  EXPECT_TRUE(testing::Names(warnings_[3], {Path("a.mtl") + ":4:", "'map_Kd'"}));
  EXPECT_TRUE(testing::Names(warnings_[4], {Path("a.mtl") + ":5:", "'map_Kd -s 2 2 2 a.png'"}));
  EXPECT_TRUE(testing::Names(warnings_[5], {Path("a.mtl") + ":6:", "'d'"}));
  EXPECT_TRUE(testing::Names(warnings_[6], {"'b'", "'c'"}));
}

TEST_F(ReadMaterialsTest, StatementsBelongToTheLastMaterialNamed) {
  File("a.mtl",
       "Kd 1 0 0\nnonsense\nnewmtl a\nd 0.5\nTr x\nnewmtl b\nKd 0 0.5 0\nnewmtl a\nKd 0 0 1\n"
       "map_Kd\t-clamp on sub\\b.png\n");
  const auto materials = Read({"a.mtl"}, {"a", "b"});
  EXPECT_EQ(materials[0]->colour, Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(materials[0]->opacity, 0.5);
  EXPECT_EQ(materials[0]->texture, Path("sub/b.png"));
  EXPECT_EQ(materials[1]->colour, Eigen::Vector3d(0, 0.5, 0));
  EXPECT_EQ(materials[1]->opacity, 1);
  ASSERT_EQ(warnings_.size(), 2u);
  EXPECT_TRUE(testing::Names(warnings_[0], {Path("a.mtl") + ":5:", "'Tr x'"}));
}

TEST_F(ReadMaterialsTest, WithoutMaterialsNoLibraryIsRead) {
  EXPECT_TRUE(Read({"none.mtl"}, {}).empty());
  EXPECT_TRUE(warnings_.empty());
}

}  // namespace
}  // namespace shapespace
