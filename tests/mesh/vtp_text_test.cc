#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/read.h>
#include <shapespace/files/vertex_field.h>

#include "mesh/files.h"
#include "support/message_of.h"

// VTK's XML files: pieces, data of points, and what is said about them.

namespace shapespace::vtp_text_test {
namespace {

using Ints = std::vector<int>;
using Strings = std::vector<std::string>;

const std::string kReexport = internal::kReexport;

std::string Array(const std::string& attributes, const std::string& inside) {
  return "<DataArray " + attributes + " format='ascii'>" + inside + "</DataArray>\n";
}

/// The points' line is the first.
std::string Points(const std::string& numbers) {
  return "<Points>" + Array("type='Float64' Name='p' NumberOfComponents='3'", numbers) +
         "</Points>\n";
}

std::string Cells(const std::string& section, const std::string& connectivity,
                  const std::string& offsets) {
  return "<" + section + ">\n" + Array("type='Int32' Name='connectivity'", connectivity) +
         Array("type='Int32' Name='offsets'", offsets) + "</" + section + ">\n";
}

/// The pieces begin on line 2.
std::string Document(const std::string& pieces, const std::string& attributes = "") {
  return "<VTKFile type='PolyData'" + attributes + "><PolyData>\n" + pieces +
         "</PolyData></VTKFile>\n";
}

std::string Piece(const std::string& counts, const std::string& inside) {
  return "<Piece " + counts + ">\n" + inside + "</Piece>\n";
}

const std::string kThree = Points("0 0 0 1 0 0 0 1 0");
const std::string kPolygon = Cells("Polys", "0 1 2", "3");
const std::string kCounts = "NumberOfPoints='3' NumberOfPolys='1'";

class VtpTextTest : public testing::FilesTest {
 protected:
  static Soup Read(const std::string& content) {
    return testing::SoupOf(content, "m.vtp", MeshFormat::kVtp);
  }

  static void Refused(const std::string& content, const std::vector<std::string>& parts) {
    const std::string message = testing::MessageOf<FileError>([&] { Read(content); });
    EXPECT_EQ(message.find("m.vtp:"), 0u) << message;
    EXPECT_TRUE(testing::Names(message, parts)) << content;
  }
};

TEST_F(VtpTextTest, CellsOfLaterPiecesHaveTheirOwnPoints) {
  const std::string one =
      Piece("NumberOfPoints='2' NumberOfLines='1' NumberOfVerts='2'",
            Points("9 8 7\n6 5 4") + Cells("Lines", "1 0", "2") + Cells("Verts", "0 1", "1 2"));
  const std::string two =
      Piece(kCounts + " NumberOfStrips='1'", kThree + kPolygon + Cells("Strips", "2 0 1 2", "4"));
  const Soup soup = Read(Document(one + two + Piece("NumberOfPoints='0'", "") + two + one));
  EXPECT_EQ(soup.NumVertices(), 10);
  EXPECT_EQ(soup.vertices.col(0), Eigen::Vector3d(9, 8, 7));
  EXPECT_EQ(soup.vertices.col(9), Eigen::Vector3d(6, 5, 4));
  EXPECT_EQ(soup.segments, (std::vector<std::pair<int, int>>{{1, 0}, {9, 8}}));
  EXPECT_EQ(soup.corners, (Ints{4, 2, 3, 3, 2, 4, 2, 3, 4, 7, 5, 6, 6, 5, 7, 5, 6, 7}));
  EXPECT_EQ(soup.dropped, Strings{"4 vertex cells not kept"});
  Refused(Document(two + Piece("NumberOfPoints='3'", Points("0 0 0 1 0 0 0 inf 0"))),
          {"vertex 6", "coordinate y"});
  Refused(Document(two + Piece(kCounts, kThree + Cells("Polys", "0 1 3", "3"))),
          {"polygon 4", "0", "2"});
}

TEST_F(VtpTextTest, DataThatNotAllPiecesHave) {
  const std::string data =
      "<PointData TCoords='uv'>\n" +
      Array("type='UInt8' Name='c' NumberOfComponents='3'", "0 51 255 1 2 3 4 5 6") +
      Array("type='Float32' Name='uv' NumberOfComponents='2'", "1 2 3 4 5 6") +
      "</PointData>\n<CellData>\n" + Array("type='Int8' Name='n'", "7") +
      "</CellData>\n<CellData>" + Array("type='Int8' Name='m'", "7") + "</CellData>\n";
  const std::string with = Piece(kCounts, kThree + kPolygon + data);
  const std::string without = Piece(kCounts, kThree + kPolygon);
  const Soup both = Read(Document(with + with));
  EXPECT_EQ(both.appearance.vertex_colours.cols(), 6);
  EXPECT_EQ(both.appearance.vertex_colours.col(3), Eigen::Vector3d(0, 0.2, 1));
  EXPECT_EQ(both.appearance.texture_coordinates.col(5), Eigen::Vector2d(5, 6));
  EXPECT_EQ(both.appearance.corner_texture, (Ints{0, 1, 2, 3, 4, 5}));
  EXPECT_EQ(both.dropped, Strings{"4 arrays of cell data not kept"});
  const Soup first = Read(Document(with + without));
  EXPECT_EQ(first.dropped, (Strings{"2 arrays of cell data not kept",
                                    "vertex colours, which not all pieces have, not kept",
                                    "texture coordinates, which not all pieces have, not kept"}));
  EXPECT_EQ(first.appearance.vertex_colours.size(), 0);
  EXPECT_TRUE(first.appearance.corner_texture.empty());
  EXPECT_EQ(
      Read(Document(without + with)).dropped,
      (Strings{"2 arrays of cell data not kept",
               "vertex colours, which not all pieces have, not kept", "point data not kept: uv"}));
  const Soup field = Read(
      Document("<FieldData>\n" + Array("type='Int8' Name='t'", "1") + "</FieldData>\n" + without));
  EXPECT_EQ(field.dropped, Strings{"field data not kept"});
}

TEST_F(VtpTextTest, ColoursAndTextureCoordinatesThatAreDamagedAreDropped) {
  const auto with = [](const std::string& colours, const std::string& texture) {
    return Document(
        Piece(kCounts, kThree + kPolygon + "<PointData TCoords='uv'>\n" +
                           Array("type='UInt8' Name='c' NumberOfComponents='3'", colours) +
                           Array("type='Float32' Name='uv' NumberOfComponents='2'", texture) +
                           "</PointData>"));
  };
  for (const std::string& document :
       {with("1 2 3 4 5 6 7 8 x", "0 0 1 0 1 x"), with("1 2 3", "0 0 1 0"),
        with("1 2 3 4 5 6 7 8 nan", "0 0 1 0 1 1.#INF")}) {
    const Soup soup = Read(document);
    EXPECT_EQ(soup.corners.size(), 3u);
    EXPECT_EQ(soup.appearance.vertex_colours.size(), 0);
    EXPECT_TRUE(soup.appearance.corner_texture.empty());
    EXPECT_EQ(soup.dropped.size(), 2u);
  }
}

TEST_F(VtpTextTest, LinesOfProblems) {
  Refused(Document(Piece(kCounts, kPolygon)), {"m.vtp:2:"});
  // The points' element is on line 3.
  Refused(Document(Piece(kCounts, Points("0 0 0\n1 0 0 0 1") + kPolygon)),
          {"m.vtp:3:", "'p'", "8", "3"});
  Refused(Document(Piece(kCounts, Points("0 0 0\n1 0 0\n0 one 0") + kPolygon)),
          {"m.vtp:5:", "'p'", "'one'"});
  Refused(Document(Piece(
              kCounts, "\n<Points>" + Array("type='Half' Name='p'", "") + "</Points>" + kPolygon)),
          {"m.vtp:4:", "'p'", "'Half'"});
  // Polys begin on line 5, and their offsets are on line 7.
  Refused(Document(Piece("NumberOfPoints='3' NumberOfPolys='2'", kThree + kPolygon)),
          {"m.vtp:7:", "'offsets'", "1", "2"});
  Refused(Document(Piece("NumberOfPoints='3' NumberOfLines='2'", kThree + kPolygon)),
          {"m.vtp:2:", "'offsets'"});
  Refused(Document(Piece(kCounts, kThree + "<Polys>" + Array("type='Int32' Name='offsets'", "3") +
                                      "</Polys>")),
          {"m.vtp:2:", "'connectivity'"});
  for (const std::string count : {"x", "-1", "2147483648", "1.5"}) {
    Refused(Document("\n" + Piece("NumberOfPoints='" + count + "'", kThree)), {"m.vtp:3:", count});
  }
  const auto components = [](const std::string& number) {
    return Document(Piece(
        kCounts, kThree + kPolygon + "<PointData>\n" +
                     Array("type='Int8' Name='d' NumberOfComponents='" + number + "'", "1 2 3") +
                     "</PointData>"));
  };
  for (const std::string number : {"0", "1001", "x"}) {
    Refused(components(number), {"m.vtp:10:", "'d'", number});
  }
  EXPECT_EQ(Read(components("1")).dropped, Strings{"point data not kept: d"});
  EXPECT_EQ(Read(components("")).dropped, Strings{"point data not kept: d"});
}

TEST_F(VtpTextTest, FilesOfOtherKinds) {
  Refused("\n<vtkfile type='PolyData'/>", {"m.vtp:2:", ".vtp"});
  Refused("<VTKFile type='ImageData'/>", {"m.vtp:1:", "'ImageData'", ".vtp"});
  Refused("<VTKFile type='PolyData'>\n<PolyData>\n</VTKFile>", {"m.vtp:3:"});
  Refused("<VTKFile type='PolyData'>\n\n<AppendedData encoding='raw'> no", {"m.vtp:3:"});
  Refused("\n<!DOCTYPE a><VTKFile type='PolyData'/>", {"m.vtp:2:", ".vtp"});
  Refused(Document(Piece(kCounts, kThree + kPolygon), " compressor='vtkLZMADataCompressor'"),
          {"'vtkLZMADataCompressor'"});
  Refused(Document(""), {"point"});
}

// 3 x 3 bytes behind a header of four: 9, and 0 0 0 1 0 0 0 1 0.
TEST_F(VtpTextTest, Base64WithBlanksAndPadding) {
  const auto with = [](const std::string& attributes, const std::string& inside) {
    return Document(Piece(kCounts, "<Points><DataArray type='Int8' Name='p' " + attributes + ">" +
                                       inside + "</DataArray></Points>\n" + kPolygon));
  };
  Shape expected(3, 3);
  expected << 0, 1, 0, 0, 0, 1, 0, 0, 0;
  EXPECT_EQ(Read(with("format='binary'", "CQAAAAAAAAEAAAABAA==")).vertices, expected);
  EXPECT_EQ(Read(with("format='binary'", " CQAA\n\tAAAA AAEAAA\r\nABAA == ")).vertices, expected);
  // The header alone, padded, and then the data.
  EXPECT_EQ(Read(with("format='binary'", "CQAAAA==AAAAAQAAAAEA")).vertices, expected);
  const std::string array = "3: array 'p': ";
  Refused(with("format='binary'", "CQAAAAAAAAEAAAABAA="), {array, "file"});
  Refused(with("format='binary'", "CQAAAAAAAAEAAAAB=A=="), {array, "base64"});
  Refused(with("format='binary'", "CQAAAAAAAAEAAAABA==="), {array, "base64"});
  Refused(with("format='binary'", "CQAAAAAAAAEAAAAB-A=="), {array, "base64"});
  Refused(with("format='hex'", "00"), {array, "'hex'"});
  Refused(with("format='appended' offset='1'", ""), {array, "'1'"});
  Refused(with("format='appended' offset='x'", ""), {array, "'x'"});
}

TEST_F(VtpTextTest, Base64OfEveryDigit) {
  // 48 bytes, whose base64 is all digits in their order.
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  const std::string content =
      Document(Piece("NumberOfPoints='16' NumberOfLines='1'",
                     "<Points><DataArray type='UInt8' Name='p' format='binary'>MAAAAA==" + digits +
                         "</DataArray></Points>\n" + Cells("Lines", "0 15", "2")));
  const Soup soup = Read(content);
  ASSERT_EQ(soup.NumVertices(), 16);
  for (int v = 0; v < 16; ++v) {
    int bits = 0;
    for (int axis = 0; axis < 3; ++axis) {
      bits = bits * 256 + static_cast<int>(soup.vertices(axis, v));
    }
    for (int k = 0; k < 4; ++k) EXPECT_EQ(bits >> (18 - 6 * k) & 63, 4 * v + k);
  }
}

TEST_F(VtpTextTest, FieldsOfAllPieces) {
  const auto piece = [](const std::string& type, const std::string& numbers) {
    return Piece(kCounts, kThree + kPolygon + "<PointData>\n" +
                              Array("type='" + type + "' Name='a'", numbers) + "</PointData>\n");
  };
  const std::string file =
      File("m.vtp", Document(piece("Int16", "1 -2 3") + piece("Float64", "4 5 .5")));
  Eigen::VectorXd expected(6);
  expected << 1, -2, 3, 4, 5, .5;
  EXPECT_EQ(ReadVertexField(file + ":a"), expected);
  File("m.vtp", Document(piece("Int16", "1 2 3") + piece("Int16", "4 5")));
  EXPECT_TRUE(testing::Refuses<FileError>([&] { ReadVertexField(file + ":a"); },
                                          {file, "'a'", "2", "3", "1"}));
  EXPECT_TRUE(testing::Refuses<FileError>([&] { ReadVertexField(file + ":b"); }, {file, "'b'"}));
}

}  // namespace
}  // namespace shapespace::vtp_text_test
