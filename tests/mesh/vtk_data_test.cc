#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/bytes.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/read.h>
#include <shapespace/files/vertex_field.h>

#include "mesh/files.h"
#include "support/message_of.h"

// Data of points and cells in VTK's legacy files.

namespace shapespace::vtk_data_test {
namespace {

using Strings = std::vector<std::string>;

const std::string kTriangle =
    "# vtk DataFile Version 3.0\na title\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n"
    "0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\n";

/// Three points in bytes, and the word before data of them.
const std::string kBinary =
    "# vtk DataFile Version 3.0\na title\nBINARY\nDATASET POLYDATA\nPOINTS 3 char\n" +
    std::string("\1\0\0\0\1\0\0\0\1", 9) + "\nPOINT_DATA 3\n";

class VtkDataTest : public testing::FilesTest {
 protected:
  static Soup Read(const std::string& content) {
    return testing::SoupOf(content, "m.vtk", MeshFormat::kVtk);
  }

  static std::string Refusal(const std::string& content) {
    return testing::MessageOf<FileError>([&] { Read(content); });
  }

  Eigen::VectorXd Field(const std::string& content, const std::string& name) const {
    return ReadVertexField(File("m.vtk", content) + ":" + name);
  }

  /// What is said behind the file's name.
  std::string FieldRefusal(const std::string& content, const std::string& name) const {
    const std::string message = testing::MessageOf<FileError>([&] { Field(content, name); });
    const std::string file = Path("m.vtk");
    return message.substr(0, file.size()) == file ? message.substr(file.size()) : message;
  }
};

const Eigen::Vector3d kLast(7, 8, 9);
constexpr char kLastText[] = "SCALARS last float\nLOOKUP_TABLE default\n7 8 9\n";
const std::string kLastBytes = std::string("SCALARS last char\nLOOKUP_TABLE default\n\7\10\11\n");

// Each would otherwise be read on from the middle of its numbers.
TEST_F(VtkDataTest, DataOfEveryKindArePassedAsLongAsTheyAre) {
  const std::string text =
      kTriangle + "POINT_DATA 3\nTENSORS t float\n" +
      "1 2 3 4 5 6 7 8 9\n1 2 3 4 5 6 7 8 9\n1 2 3 4 5 6 7 8 9\n" +
      "TENSORS6 s float\n1 2 3 4 5 6\n1 2 3 4 5 6\n1 2 3 4 5 6\nVECTORS v double\n1 2 3 1 2 3 1 2 "
      "3\nNORMALS n float\n1 2 3 1 2 3 1 2 3\nGLOBAL_IDS g vtkIdType\n1 2 3\nPEDIGREE_IDS p int\n"
      "1 2 3\nEDGE_FLAGS e int\n1 0 1\nSCALARS two short 2\nLOOKUP_TABLE mine\n1 2 3 4 5 6\n"
      "LOOKUP_TABLE mine 2\n0 0 0 1\n.5 1 1 1\nCOLOR_SCALARS five 5\n" +
      "1 2 3 4 5 1 2 3 4 5 1 2 3 4 5\nTEXTURE_COORDINATES uvw 3 float\n1 2 3 1 2 3 1 2 3\n" +
      "SCALARS flags bit\n1 0 1\n" + kLastText;
  EXPECT_EQ(Field(text, "last"), kLast);
  EXPECT_EQ(Field(text, "g"), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(Field(text, "flags"), Eigen::Vector3d(1, 0, 1));
  const Soup soup = Read(text);
  EXPECT_EQ(soup.dropped,
            Strings{"point data not kept: t, s, v, n, g, p, e, two, five, uvw, flags, "
                    "last"});
  EXPECT_EQ(soup.appearance.vertex_colours.size(), 0);
  EXPECT_EQ(soup.appearance.texture_coordinates.size(), 0);
}

TEST_F(VtkDataTest, InBinaryFilesColoursAreBytesAndBitsAreEightInOne) {
  const std::string colours("\xff\x33\0\0\0\xff\x66\0\0", 9);
  const std::string tables = "LOOKUP_TABLE mine 2\n" + std::string(8, 'x') + "\n";
  Eigen::Matrix3d expected;
  expected << 1, 0, .4, .2, 0, 0, 0, 1, 0;
  const std::string content =
      kBinary + "COLOR_SCALARS c 3\n" + colours + "\n" + tables + kLastBytes;
  EXPECT_EQ(Read(content).appearance.vertex_colours, expected);
  EXPECT_EQ(Field(content, "last"), kLast);
  // Three bits are one byte, 3 x 8 are three, 3 x 3 are two.
  const std::string bits = kBinary + "SCALARS b bit\nLOOKUP_TABLE default\nx\n" +
                           "SCALARS c bit 8\nLOOKUP_TABLE default\nxyz\n" + "VECTORS d bit\nxy\n" +
                           kLastBytes;
  EXPECT_EQ(Field(bits, "last"), kLast);
  EXPECT_EQ(FieldRefusal(bits, "b"), ": no point data has the name 'b'");
}

TEST_F(VtkDataTest, BytesAreColoursByTheirNumberOfComponents) {
  const auto of = [](int components, const std::string& type) {
    std::string numbers;
    for (int i = 0; i < 3 * components; ++i) numbers += " " + std::to_string(i);
    return kTriangle + "POINT_DATA 3\nSCALARS paint " + type + " " + std::to_string(components) +
           "\nLOOKUP_TABLE default\n" + numbers + "\n";
  };
  for (const int components : {3, 4}) {
    const Soup soup = Read(of(components, "unsigned_char"));
    EXPECT_TRUE(soup.dropped.empty());
    EXPECT_EQ(soup.appearance.vertex_colours.rows(), components);
    EXPECT_EQ(soup.appearance.vertex_colours(1, 2), (2 * components + 1) / 255.0);
  }
  const Strings dropped = {"point data not kept: paint"};
  EXPECT_EQ(Read(of(2, "unsigned_char")).dropped, dropped);
  EXPECT_EQ(Read(of(5, "unsigned_char")).dropped, dropped);
  EXPECT_EQ(Read(of(3, "char")).dropped, dropped);
  EXPECT_EQ(Read(of(4, "unsigned_short")).dropped, dropped);
  // The second colours, though of the same number of channels, are not kept.
  const Soup twice = Read(of(3, "unsigned_char") + "COLOR_SCALARS more 3\n1 1 1 1 1 1 1 1 1\n");
  EXPECT_EQ(twice.dropped, Strings{"point data not kept: more"});
  EXPECT_EQ(twice.appearance.vertex_colours.col(2), Eigen::Vector3d(6, 7, 8) / 255);
}

TEST_F(VtkDataTest, ColoursOutOfRangeAreCounted) {
  const std::string words = "3 vertex colours (some number of them is not in 0 .. 1) not kept";
  const std::string begin = kTriangle + "POINT_DATA 3\nCOLOR_SCALARS c 3\n";
  EXPECT_EQ(Read(begin + "0 0 0 0 0 0 0 0 1.01\n").dropped, Strings{words});
  EXPECT_EQ(Read(begin + "0 0 0 0 -.01 0 0 0 1\n").dropped, Strings{words});
  EXPECT_EQ(Read(begin + "0 0 0 0 nan 0 0 0 1\n").dropped, Strings{words});
  EXPECT_TRUE(Read(begin + "0 0 0 0 1 0 0 0 1\n").dropped.empty());
}

TEST_F(VtkDataTest, TextureCoordinatesAreTwoFiniteNumbersOfPolygons) {
  const std::string begin = kTriangle + "POINT_DATA 3\nTEXTURE_COORDINATES uv ";
  const Soup soup = Read(begin + "2 double\n.5 1 2 -3 4 5\n");
  EXPECT_EQ(soup.appearance.texture_coordinates,
            (Eigen::MatrixXd(2, 3) << .5, 2, 4, 1, -3, 5).finished());
  EXPECT_EQ(Read(begin + "1 double\n1 2 3\n").dropped, Strings{"point data not kept: uv"});
  EXPECT_EQ(Read(begin + "3 double\n1 2 3 4 5 6 7 8 9\n").dropped,
            Strings{"point data not kept: uv"});
  const Strings unfit = {
      "texture coordinates that are not finite, or that no polygon has, not kept"};
  const Soup infinite = Read(begin + "2 double\n.5 1 2 inf 4 5\n");
  EXPECT_EQ(infinite.dropped, unfit);
  EXPECT_EQ(infinite.appearance.texture_coordinates.size(), 0);
  EXPECT_TRUE(infinite.appearance.corner_texture.empty());
  std::string points = kTriangle.substr(0, kTriangle.find("POLYGONS")) + "LINES 1 3\n2 0 1\n";
  EXPECT_EQ(Read(points + "POINT_DATA 3\nTEXTURE_COORDINATES uv 2 float\n1 2 3 4 5 6\n").dropped,
            unfit);
}

TEST_F(VtkDataTest, OnlyTheFirstTwentyNamesAreListed) {
  const auto with = [](int count) {
    std::string content = kTriangle + "POINT_DATA 3\nFIELD f " + std::to_string(count + 1) + "\n";
    for (int i = 1; i <= count; ++i) {
      content += "a" + std::to_string(i) + " 1 3 int\n1 2 3\n";
    }
    return content + "a1 1 3 int\n1 2 3\n";  // not counted again
  };
  std::string twenty = "point data not kept: a1";
  for (int i = 2; i <= 20; ++i) twenty += ", a" + std::to_string(i);
  EXPECT_EQ(Read(with(20)).dropped, Strings{twenty});
  EXPECT_EQ(Read(with(23)).dropped, Strings{twenty + " and 3 more"});
}

TEST_F(VtkDataTest, NamesKeepWhatIsNoCode) {
  const std::string begin = kTriangle + "POINT_DATA 3\nFIELD f 1\n";
  const auto name = [&](const std::string& word) {
    return Read(begin + word + " 1 3 int\n1 2 3\n").dropped;
  };
  EXPECT_EQ(name("a%2Cb%2cc"), Strings{"point data not kept: a,b,c"});
  EXPECT_EQ(name("%41%"), Strings{"point data not kept: A%"});
  EXPECT_EQ(name("a%4"), Strings{"point data not kept: a%4"});
  EXPECT_EQ(name("a%zz"), Strings{"point data not kept: a%zz"});
  EXPECT_EQ(name("a%4z"), Strings{"point data not kept: a%4z"});
  EXPECT_EQ(name("%25%2541"), Strings{"point data not kept: %%41"});
}

TEST_F(VtkDataTest, DescriptionsInsideFieldsArePassed) {
  const std::string content = kTriangle +
                              "POINT_DATA 3\nFIELD f 2\nfirst 1 3 int\n1 2 3\n"
                              "METADATA\nINFORMATION 1\nNAME UNITS LOCATION x\nDATA mm\n\n"
                              "second 1 3 int\n4 5 6\n" +
                              kLastText;
  EXPECT_EQ(Field(content, "first"), Eigen::Vector3d(1, 2, 3));
  EXPECT_EQ(Field(content, "second"), Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(Field(content, "last"), kLast);
  EXPECT_TRUE(testing::Names(Refusal(kTriangle + "POINT_DATA 3\nFIELD f 2\nfirst 1 3 int\n1 2 3\n"),
                             {"m.vtk:13:"}));
}

TEST_F(VtkDataTest, CellDataAreCountedAndPointDataNamed) {
  const Soup soup =
      Read(kTriangle +
           "CELL_DATA 1\nSCALARS a int\nLOOKUP_TABLE default\n7\nNORMALS b float\n"
           "0 0 1\nFIELD f 2\nc 1 1 int\n7\nd 2 1 int\n7 8\nCOLOR_SCALARS e 3\n1 1 1\n"
           "POINT_DATA 3\nFIELD f 2\nnames 1 3 string\nx\ny\nz\nnumbers 1 3 int\n1 2 3\n"
           "CELL_DATA 1\nSCALARS g int\n7\n");
  EXPECT_EQ(soup.dropped,
            (Strings{"6 arrays of cell data not kept", "point data not kept: names, numbers"}));
  EXPECT_EQ(soup.appearance.vertex_colours.size(), 0);
}

// The mesh does not need them.
TEST_F(VtkDataTest, ThatAreDamagedAreDropped) {
  for (const std::string bad : {"nan", "x", "1.#QNAN", "0,5"}) {
    const std::string data = "COLOR_SCALARS c 3\n1 0 0 0 1 0 0 0 " + bad +
                             "\nTEXTURE_COORDINATES t 2 float\n0 0 1 0 1 " + bad + "\n";
    const Soup soup = Read(kTriangle + "POINT_DATA 3\n" + data);
    EXPECT_EQ(soup.corners, (std::vector<int>{0, 1, 2}));
    EXPECT_EQ(soup.appearance.vertex_colours.size(), 0) << bad;
    EXPECT_TRUE(soup.appearance.corner_texture.empty()) << bad;
    EXPECT_EQ(soup.dropped.size(), 2u) << bad;
    EXPECT_NE(FieldRefusal(kTriangle + "POINT_DATA 3\nSCALARS s float\nLOOKUP_TABLE default\n1 2 " +
                               bad + "\n",
                           "s")
                  .find("not a finite number"),
              std::string::npos);
  }
  const Soup few = Read(kTriangle + "POINT_DATA 3\nFIELD f 1\na 3 2 unsigned_char\n1 2 3 4 5 6\n");
  EXPECT_EQ(few.appearance.vertex_colours.size(), 0);
  EXPECT_EQ(few.dropped,
            Strings{"the point data 'a' has 6 numbers; 3 points of 3 are expected; not "
                    "kept"});
}

TEST_F(VtkDataTest, SayWhatIsWrongWithData) {
  const auto refused = [](const std::string& data, const std::vector<std::string>& parts) {
    EXPECT_TRUE(testing::Names(Refusal(kTriangle + "POINT_DATA 3\n" + data), parts));
  };
  refused("SCALARS s int 0\n", {"m.vtk:10:", "'s'", "'0'"});
  refused("SCALARS s int 1001\n", {"m.vtk:10:", "'s'", "'1001'"});
  refused("COLOR_SCALARS s x\n", {"m.vtk:10:", "'s'", "'x'"});
  refused("FIELD f x\n", {"m.vtk:10:", "'x'"});
  refused("FIELD f 1\na 1 -3 int\n", {"m.vtk:11:", "'-3'"});
  refused("FIELD f 1\nthe%20age 1 3 complex\n", {"m.vtk:11:", "'the age'", "'complex'", ".vtp"});
  refused("LOOKUP_TABLE t x\n", {"m.vtk:10:", "'x'"});
  refused("FIELD f 1\nnames 1 3 string\na\nb\n", {"m.vtk:13:", "'names'"});
  EXPECT_TRUE(testing::Names(Refusal(kTriangle + "CELL_DATA x\n"), {"m.vtk:9:", "'x'"}));
  EXPECT_TRUE(testing::Names(Refusal(kTriangle + "POINT_DATA x\n"), {"m.vtk:9:", "'x'"}));
}

TEST_F(VtkDataTest, SayWhatIsWrongWithTheWantedData) {
  const std::string content = kTriangle +
                              "POINT_DATA 3\nSCALARS two float 2\nLOOKUP_TABLE default\n"
                              "1 2 3 4 5 6\nSCALARS odd float\nLOOKUP_TABLE default\n1 nan 3\n" +
                              kLastText;
  EXPECT_EQ(FieldRefusal(content, "two"),
            ": the point data 'two' has 2 components; name data with one number a point");
  EXPECT_EQ(FieldRefusal(content, "odd"), ": property odd of vertex 2 is not a finite number");
  EXPECT_EQ(FieldRefusal(content, "none"), ": no point data has the name 'none'");
  EXPECT_EQ(FieldRefusal(content, ""), ":: name a property behind the colon");
  EXPECT_EQ(FieldRefusal(content + kLastText, "last"),
            ": the point data 'last' is not that of all pieces");
  // Colours and texture coordinates are data like others when they are wanted.
  const std::string bytes = kTriangle + "POINT_DATA 3\nCOLOR_SCALARS c 1\n.5 .25 1\n";
  EXPECT_EQ(Field(bytes, "c"), Eigen::Vector3d(.5, .25, 1));
}

}  // namespace
}  // namespace shapespace::vtk_data_test
