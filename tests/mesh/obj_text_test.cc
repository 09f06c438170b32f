#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/read.h>

#include "mesh/files.h"
#include "support/message_of.h"

// What is said about OBJ files.

namespace shapespace::obj_text_test {
namespace {

using Ints = std::vector<int>;
using Strings = std::vector<std::string>;

const std::string kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

Soup Read(const std::string& content, const std::string& name = "m.obj") {
  return testing::SoupOf(content, name, MeshFormat::kObj);
}

void ExpectRefused(const std::string& content, std::vector<std::string> parts) {
  parts.front() = "m.obj:" + parts.front();
  EXPECT_TRUE(testing::Refuses<FileError>([&] { Read(content); }, parts));
}

TEST(ObjTextTest, OfUnknownStatementsTheFirstFiveKindsAreNamed) {
  std::string content = kThree + "f 1 2 3\nvn 0 0 1\n";
  for (const std::string keyword : {"zz", "ee", "dd", "cc", "aa", "gg", "bb", "dd", "dd"}) {
    content += keyword + " 1 2\n";
  }
  EXPECT_EQ(Read(content + "p 1\ns 1\n").dropped,
            (Strings{"1 statements 'aa' (the first on line 10) not kept",
                     "1 statements 'bb' (the first on line 12) not kept",
                     "1 statements 'cc' (the first on line 9) not kept",
                     "3 statements 'dd' (the first on line 8) not kept",
                     "1 statements 'ee' (the first on line 7) not kept", "1 points (p) not kept",
                     "1 smoothing groups (s) not kept", "1 normals (vn) not kept",
                     "2 further kinds of statement not kept"}));
  EXPECT_EQ(Read(content.substr(0, content.find("bb"))).dropped.back(),
            "1 further kinds of statement not kept");
}

TEST(ObjTextTest, LongKeywordsAreOneKindByTheirFirstFortyBytes) {
  const std::string forty = "abcdefghijklmnopqrstuvwxyzabcdefghijklmn";
  const Soup soup = Read(kThree + "l 1 2\n" + forty + "o 1\n" + forty + "p 1\n" +
                         forty.substr(0, 39) + " 1\n" + forty + "\n");
  EXPECT_EQ(soup.dropped,
            (Strings{"1 statements '" + forty.substr(0, 39) + "' (the first on line 7) not kept",
                     "3 statements '" + forty + "' (the first on line 5) not kept"}));
}

TEST(ObjTextTest, TextureCoordinatesHaveOneToThreeNumbers) {
  const Soup soup = Read(kThree + "vt .5\nvt .25 1 0\nvt 2 3 .5\nvt 4 5 -1 # w\nf 1/4 2/1 3/-2\n");
  EXPECT_EQ(soup.appearance.texture_coordinates,
            (Eigen::MatrixXd(2, 4) << .5, .25, 2, 4, 0, 1, 3, 5).finished());
  EXPECT_EQ(soup.appearance.corner_texture, (Ints{3, 0, 2}));
  EXPECT_EQ(soup.dropped, Strings{"2 third texture coordinates not kept"});
  EXPECT_EQ(Read(kThree + "vt 1 2 inf\nvt 3 4 0 0\nf 1/1 2/2 3/2\n").dropped, soup.dropped);
}

TEST(ObjTextTest, CornersKeepTheTextureCoordinatesThatThereAre) {
  const Soup soup = Read(kThree +
                         "vt 1 2\nvt nan 0\nvt\nvt 0 y\nvt 3 4\nvt 1.#QNAN 0\nvt 0,5 0\n"
                         "f 1/1 2/2 3/3\nf 1/4 2/5 3/6\nf 1/7 2/8 3/-7\nf 1/0 2/x 3/-8/1\n");
  EXPECT_EQ(soup.corners.size(), 12u);
  EXPECT_EQ(soup.appearance.corner_texture, (Ints{0, -1, -1, -1, 4, -1, -1, -1, 0, -1, -1, -1}));
  EXPECT_EQ(soup.appearance.texture_coordinates.col(0), Eigen::Vector2d(1, 2));
  EXPECT_EQ(soup.appearance.texture_coordinates.col(4), Eigen::Vector2d(3, 4));
  EXPECT_TRUE(soup.appearance.texture_coordinates.allFinite());
  EXPECT_EQ(
      soup.dropped,
      (Strings{"5 texture coordinates that are not finite numbers (the first on line 5) not "
               "kept",
               "9 corners' texture coordinates that the file does not have (the first on line "
               "11) not kept"}));
  // Not one is left.
  for (const std::string rest : {"f 1/1/1 2/1/1 3/1/1\n", "vt nan nan\nf 1/1 2/1 3/1\n"}) {
    const Soup plain = Read(kThree + rest);
    EXPECT_EQ(plain.corners, (Ints{0, 1, 2}));
    EXPECT_TRUE(plain.appearance.corner_texture.empty()) << rest;
    EXPECT_EQ(plain.appearance.texture_coordinates.size(), 0) << rest;
    EXPECT_FALSE(plain.dropped.empty()) << rest;
  }
}

TEST(ObjTextTest, NormalsNeedNotExist) {
  const Soup soup = Read(kThree + "vn nan nan nan\nf 1//9 2//0 3//x\n");
  EXPECT_EQ(soup.corners, (Ints{0, 1, 2}));
  EXPECT_EQ(soup.dropped, Strings{"1 normals (vn) not kept"});
}

TEST(ObjTextTest, WhatFollowsAVertexNeedNotBeAColour) {
  const auto dropped = [](const std::string& further) {
    const Soup soup = Read("v 0 0 0 1 1 1\nv 1 2 3 " + further + "\nv 0 1 0 0 0 0\nf 1 2 3\n");
    EXPECT_EQ(soup.vertices.col(1), Eigen::Vector3d(1, 2, 3)) << further;
    return soup.dropped;
  };
  const Strings none = {"3 vertex colours (some number of them is not in 0 .. 1) not kept"};
  for (const std::string further : {"nan nan nan", "1 1 inf", "0 0 0 -nan(ind)", "None None None",
                                    "-1.#IND00 0 0", "0,5 0,5 0,5"}) {
    EXPECT_EQ(dropped(further), none) << further;
  }
  for (const std::string further : {"4 5", "4 5 6 7 8"}) {
    EXPECT_EQ(dropped(further), Strings{"1 vertices' further numbers, which are no colours, (the "
                                        "first on line 2) not kept"});
  }
  EXPECT_EQ(dropped("x"), Strings{"1 vertex weights other than 1 not kept"});
}

TEST(ObjTextTest, VerticesSayWhatIsMissing) {
  ExpectRefused(kThree + "v 1 2\\\n\n", {"4:", "vertex 4", "coordinate z"});
  const Soup soup = Read("v 0 0 0 1\nv 1 0 0 1.5\nv 0 1 0 0\nl 1 2\n");
  EXPECT_EQ(soup.dropped, Strings{"2 vertex weights other than 1 not kept"});
}

TEST(ObjTextTest, CornersSayWhatIsWrongWithThem) {
  const auto refused = [](const std::string& corner, const std::string& part) {
    ExpectRefused(kThree + "vt 0 0\nf 1 2 3\nf 1/1 2/1 " + corner + "\n",
                  {"6:", "polygon 2", part});
  };
  for (const std::string corner :
       {"/1", "3.5", "2147483648", "-2147483648", "-9223372036854775808"}) {
    refused(corner, "'" + corner + "'");
  }
  EXPECT_TRUE(testing::Refuses<FileError>([] { Read(kThree + "f 0 1 2/1\n"); },
                                          {"m.obj:4:", "polygon 1", "'0'", "1"}));
  refused("2147483647", "vertex 2147483647");
  refused("4", "vertex 4");
  refused("-4", "has 3");
  EXPECT_TRUE(testing::Refuses<FileError>([] { Read(kThree + "f 1 2 3/1/1/1\n"); },
                                          {"m.obj:4:", "polygon 1", "'3/1/1/1'"}));
  ExpectRefused(kThree + "f 1 2 3\nf 1 2\n", {"5:", "polygon 2", "2"});
  EXPECT_EQ(Read(kThree + "vt 0 0\nf 1/1/ 2// 3/\n").appearance.corner_texture, (Ints{0, -1, -1}));
}

TEST(ObjTextTest, PolylinesSayWhatIsWrongWithThem) {
  ExpectRefused(kThree + "l 1 2\nl 3\n", {"5:"});
  ExpectRefused(kThree + "l 1 two\n", {"4:", "'two'", "1"});
  ExpectRefused(kThree + "l 1 2 3\nl 3 1\n\nl 5 1\n", {"7:", "segment 4", "vertex 5", "3"});
  ExpectRefused(kThree + "l 1 2 3\nl 3 1\n\nl 1 -4\n", {"7:", "segment 4", "3"});
}

TEST(ObjTextTest, LinesAreCountedThroughContinuedStatements) {
  const std::string continued = "v 0 0 \\\n 0\nv 1 \\\r\n0 \\\r\n 0\nv 0 1 0\n";  // 6 lines
  const Soup soup = Read(continued + "f 1 2 3\nl 1 \\\n 2\nl 2 3");
  EXPECT_EQ(soup.vertex_line, (Ints{1, 3, 6}));
  EXPECT_EQ(soup.polygon_line, (Ints{7}));
  EXPECT_EQ(soup.segment_line, (Ints{8, 10}));
  EXPECT_EQ(soup.vertices.col(1), Eigen::Vector3d(1, 0, 0));
  ExpectRefused(continued + "f 1 2 \\\nx\n", {"7:", "polygon 1", "'x'", "1"});
  ExpectRefused(continued + "f 1 2 \\", {"7:", "polygon 1", "'\\'", "1"});
  EXPECT_TRUE(testing::Refuses<FileError>(
      [&] { Read(continued + "# \\\n" + std::string(2, '\0')); }, {"m.obj:7:", "16"}));
}

TEST(ObjTextTest, NamesAreTheRestOfTheLine) {
  const Soup soup = Read(kThree +
                         "usemtl unused\nusemtl unused\nusemtl red #2 \nmtllib\nmtllib a b.mtl \n"
                         "mtllib c.mtl\ng one two\nf 1 2 3\nusemtl blue\nf 1 2 3\nusemtl red #2\n"
                         "g\nf 1 2 3\nusemtl\nf 1 2 3\ng never\no  \n");
  EXPECT_EQ(soup.appearance.material_libraries, (Strings{"a b.mtl", "c.mtl"}));
  EXPECT_EQ(soup.appearance.materials.names, (Strings{"red #2", "blue"}));
  EXPECT_EQ(soup.appearance.materials.of_polygon, (Ints{0, 1, 0, -1}));
  EXPECT_EQ(soup.appearance.groups.names, Strings{"one two"});
  EXPECT_EQ(soup.appearance.groups.of_polygon, (Ints{0, 0, -1, -1}));
  EXPECT_TRUE(soup.appearance.objects.of_polygon.empty());
  EXPECT_EQ(soup.dropped, (Strings{"1 materials (usemtl) that no polygon has not kept",
                                   "1 group names (g) that no polygon has not kept"}));
}

TEST(ObjTextTest, LibrariesAreLookedForBesideTheFile) {
  const Soup soup = Read(kThree + "l 1 2\n", "some/folder/m.obj");
  EXPECT_EQ(soup.file, "some/folder/m.obj");
  EXPECT_EQ(soup.appearance.folder, "some/folder");
  EXPECT_EQ(soup.appearance.own_folder, "some/folder");
}

}  // namespace
}  // namespace shapespace::obj_text_test
