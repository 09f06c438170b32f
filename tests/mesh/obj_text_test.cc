#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/read.h>

#include "mesh/files.h"
#include "support/message_of.h"

// The whole text of what is said about OBJ files.

namespace shapespace::obj_text_test {
namespace {

using internal::kReexport;
using Ints = std::vector<int>;
using Strings = std::vector<std::string>;

const std::string kThree = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

Soup Read(const std::string& content, const std::string& name = "m.obj") {
  return testing::SoupOf(content, name, MeshFormat::kObj);
}

void ExpectRefused(const std::string& content, const std::string& words) {
  EXPECT_EQ(testing::MessageOf<FileError>([&] { Read(content); }), "m.obj:" + words + kReexport);
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
  ExpectRefused(kThree + "vt 0 0\nvt 0 0 0 0\n",
                "5: texture coordinate 2: more than three numbers");
  ExpectRefused(kThree + "vt 0 0\nvt\n", "5: texture coordinate 2: u is missing");
  ExpectRefused(kThree + "vt 0 y\n", "4: texture coordinate 1: v 'y' is not a number");
  ExpectRefused(kThree + "vt 0 0 inf\n", "4: texture coordinate 1: w 'inf' is not a finite number");
}

TEST(ObjTextTest, VerticesSayWhatIsTooMuch) {
  ExpectRefused(kThree + "v 1 2 3 4 5\n", "4: vertex 4: five numbers instead of three");
  ExpectRefused(kThree + "v 1 2 3 4 5 6 7 8\n", "4: vertex 4: more than seven numbers");
  ExpectRefused(kThree + "v 1 2 3 x\n", "4: vertex 4: what follows x y z, 'x' is not a number");
  ExpectRefused(kThree + "v 1 2\\\n\n", "4: vertex 4: coordinate z is missing");
  const Soup soup = Read("v 0 0 0 1\nv 1 0 0 1.5\nv 0 1 0 0\nl 1 2\n");
  EXPECT_EQ(soup.dropped, Strings{"2 vertex weights other than 1 not kept"});
}

TEST(ObjTextTest, CornersSayWhatIsWrongWithThem) {
  const auto refused = [](const std::string& corner, const std::string& words) {
    ExpectRefused(kThree + "vt 0 0\nf 1 2 3\nf 1/1 2/1 " + corner + "\n", "6: polygon 2: " + words);
  };
  for (const std::string corner :
       {"3/x", "3/0", "0", "3//y", "3/1/0", "/1", "3.5", "2147483648", "-2147483648",
        "-9223372036854775808", "3/9223372036854775807", "3/-9223372036854775808"}) {
    refused(corner, "corner '" + corner + "' is not made of numbers counted from 1");
  }
  refused("2147483647", "vertex 2147483647 does not exist, the file has 3");
  refused("4", "vertex 4 does not exist, the file has 3");
  refused("-4", "a relative index reaches before the first vertex, the file has 3");
  refused("3/2", "texture coordinate 2 does not exist, the file has 1");
  refused("3/-2", "a relative index reaches before the first texture coordinate, the file has 1");
  EXPECT_EQ(testing::MessageOf<FileError>([] { Read(kThree + "f 1 2 3/1/1/1\n"); }),
            "m.obj:4: polygon 1: corner '3/1/1/1' has more than three parts");
  ExpectRefused(kThree + "f 1 2 3\nf 1 2\n", "5: polygon 2: 2 corners, a polygon needs three");
  EXPECT_EQ(Read(kThree + "vt 0 0\nf 1/1/ 2// 3/\n").appearance.corner_texture, (Ints{0, -1, -1}));
}

TEST(ObjTextTest, PolylinesSayWhatIsWrongWithThem) {
  ExpectRefused(kThree + "l 1 2\nl 3\n", "5: polyline on this line: needs two vertices");
  ExpectRefused(kThree + "l 1 two\n",
                "4: polyline on this line: corner 'two' is not made of numbers counted from 1");
  ExpectRefused(kThree + "l 1 2 3\nl 3 1\n\nl 5 1\n",
                "7: segment 4: vertex 5 does not exist, the file has 3");
  ExpectRefused(kThree + "l 1 2 3\nl 3 1\n\nl 1 -4\n",
                "7: segment 4: a relative index reaches before the first vertex, the file has 3");
}

TEST(ObjTextTest, LinesAreCountedThroughContinuedStatements) {
  const std::string continued = "v 0 0 \\\n 0\nv 1 \\\r\n0 \\\r\n 0\nv 0 1 0\n";  // 6 lines
  const Soup soup = Read(continued + "f 1 2 3\nl 1 \\\n 2\nl 2 3");
  EXPECT_EQ(soup.vertex_line, (Ints{1, 3, 6}));
  EXPECT_EQ(soup.polygon_line, (Ints{7}));
  EXPECT_EQ(soup.segment_line, (Ints{8, 10}));
  EXPECT_EQ(soup.vertices.col(1), Eigen::Vector3d(1, 0, 0));
  ExpectRefused(continued + "f 1 2 \\\nx\n",
                "7: polygon 1: corner 'x' is not made of numbers counted from 1");
  ExpectRefused(continued + "f 1 2 \\",
                "7: polygon 1: corner '\\' is not made of numbers counted from 1");
  EXPECT_EQ(
      testing::MessageOf<FileError>([&] { Read(continued + "# \\\n" + std::string(2, '\0')); }),
      "m.obj:7: a zero byte: this is no text file, or it is stored as UTF-16");
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
