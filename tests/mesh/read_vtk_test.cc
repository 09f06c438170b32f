#include <cmath>
#include <cstdint>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/bytes.h>
#include <shapespace/files/read.h>
#include <shapespace/files/vertex_field.h>

#include "mesh/files.h"

namespace shapespace {
namespace {

using internal::AppendBigEndian;
using testing::ExpectError;

const std::string kAscii = "# vtk DataFile Version 3.0\na title\nASCII\nDATASET POLYDATA\n";

class ReadVtkTest : public testing::FilesTest {
 protected:
  Soup Read(const std::string& content) const { return ReadSoup(File("m.vtk", content)); }

  void Refused(const std::string& content, const std::vector<std::string>& parts) const {
    ExpectError<FileError>([&] { Read(content); }, parts);
  }
};

std::string BinaryDoubles(const std::vector<double>& numbers) {
  std::string bytes;
  for (const double number : numbers) AppendBigEndian(number, &bytes);
  return bytes;
}

template <typename Int>
std::string BinaryInts(const std::vector<int>& numbers) {
  std::string bytes;
  for (const int number : numbers) AppendBigEndian(static_cast<Int>(number), &bytes);
  return bytes;
}

TEST_F(ReadVtkTest, TextWithCellsOfAllKinds) {
  const Soup soup = Read(kAscii +
                         "POINTS 6 float\n0 0 0 1 0 0\n1 1 0 0 1 0\n2 0 .125 2 1 0\n"
                         "VERTICES 1 2\n1 5\nLINES 1 4\n3 0 1 4\nPOLYGONS 2 9\n4 0 1 2 3\n3 1 4 2\n"
                         "TRIANGLE_STRIPS 1 5\n4 1 4 2 5\n");
  ASSERT_EQ(soup.NumVertices(), 6);
  EXPECT_EQ(soup.vertices.col(4), Eigen::Vector3d(2, 0, 0.125));
  EXPECT_EQ(soup.segments, (std::vector<std::pair<int, int>>{{0, 1}, {1, 4}}));
  EXPECT_EQ(soup.polygon_begin, (std::vector<int>{0, 4, 7, 10, 13}));
  // Both triangles of the strip have the orientation of its first one.
  EXPECT_EQ(soup.corners, (std::vector<int>{0, 1, 2, 3, 1, 4, 2, 1, 4, 2, 2, 4, 5}));
  EXPECT_EQ(soup.dropped, std::vector<std::string>{"1 vertex cells not kept"});
}

TEST_F(ReadVtkTest, BinaryIsBigEndianAndTheVersionSaysHowCellsAreStored) {
  const std::vector<double> points = {0, 0, 0, 1, 0, 0, 1, 1, 0.1, 0, 1, 0};
  const std::string begin = "\nanything\nBINARY\nDATASET POLYDATA\nPOINTS 4 double\n";
  const Soup old = Read("# vtk DataFile Version 4.2" + begin + BinaryDoubles(points) +
                        "\nPOLYGONS 2 8\n" + BinaryInts<std::int32_t>({3, 0, 1, 2, 3, 0, 2, 3}) +
                        "\nCELL_DATA 2\nSCALARS area float 1\nLOOKUP_TABLE default\n" +
                        std::string(8, '\0') + "\n");
  const Soup now = Read("# vtk DataFile Version 5.1" + begin + BinaryDoubles(points) +
                        "\nMETADATA\nINFORMATION 0\n\nPOLYGONS 3 6\nOFFSETS vtktypeint64\n" +
                        BinaryInts<std::int64_t>({0, 3, 6}) + "\nCONNECTIVITY vtktypeint64\n" +
                        BinaryInts<std::int64_t>({0, 1, 2, 0, 2, 3}) + "\n");
  EXPECT_EQ(old.vertices, Eigen::Map<const Shape>(points.data(), 3, 4));
  EXPECT_EQ(now.vertices, old.vertices);
  for (const Soup& soup : {old, now}) {
    EXPECT_EQ(soup.corners, (std::vector<int>{0, 1, 2, 0, 2, 3}));
    EXPECT_EQ(soup.polygon_begin, (std::vector<int>{0, 3, 6}));
  }
  EXPECT_EQ(old.dropped, std::vector<std::string>{"1 arrays of cell data not kept"});
}

/// The bytes of numbers as this writes them, in either order.
template <typename Number>
std::string Ordered(const std::vector<double>& numbers, bool little_endian) {
  std::string bytes;
  for (const double number : numbers) {
    little_endian ? internal::AppendLittleEndian(static_cast<Number>(number), &bytes)
                  : AppendBigEndian(static_cast<Number>(number), &bytes);
  }
  return bytes;
}

/// A square of two triangles in a binary file of any of the three kinds, with data.
std::string BinarySquare(int kind, bool little, double last_index = 3) {
  const std::string head = "# vtk DataFile Version " + std::string(kind == 1 ? "5.1" : "3.0") +
                           "\nx\nBINARY\nDATASET " +
                           (kind == 2 ? "UNSTRUCTURED_GRID" : "POLYDATA") + "\nPOINTS 4 float\n" +
                           Ordered<float>({0, 0, 0, 1, 0, 0, 1, 1, 0.125, 0, 1, 0}, little) + "\n";
  const std::string cells = Ordered<std::int32_t>({3, 0, 1, 2, 3, 0, 2, last_index}, little);
  const std::string data = "\nPOINT_DATA 4\nTEXTURE_COORDINATES t 2 float\n" +
                           Ordered<float>({0, 0, 1, 0, 1, 1, 0, 0.5}, little) +
                           "\nSCALARS s double\nLOOKUP_TABLE default\n" +
                           Ordered<double>({1, 2, 3, 4.5}, little) + "\n";
  if (kind == 0) return head + "POLYGONS 2 8\n" + cells + data;
  if (kind == 2) {
    return head + "CELLS 2 8\n" + cells + "\nCELL_TYPES 2\n" +
           Ordered<std::int32_t>({5, 5}, little) + data;
  }
  return head + "POLYGONS 3 6\nOFFSETS vtktypeint64\n" + Ordered<std::int64_t>({0, 3, 6}, little) +
         "\nCONNECTIVITY vtktypeint64\n" +
         Ordered<std::int64_t>({0, 1, 2, 0, 2, last_index}, little) + data;
}

TEST_F(ReadVtkTest, LittleEndianNumbersAreRecognisedByTheCells) {
  for (const int kind : {0, 1, 2}) {
    const Soup defined = Read(BinarySquare(kind, false));
    EXPECT_TRUE(defined.dropped.size() == 1 && defined.dropped[0] == "point data not kept: s");
    const Soup soup = Read(BinarySquare(kind, true));
    EXPECT_EQ(soup.vertices, defined.vertices) << kind;
    EXPECT_EQ(soup.vertices(2, 2), 0.125);
    EXPECT_EQ(soup.corners, (std::vector<int>{0, 1, 2, 0, 2, 3})) << kind;
    EXPECT_EQ(soup.appearance.texture_coordinates, defined.appearance.texture_coordinates);
    ASSERT_EQ(soup.dropped.size(), 2u);
    EXPECT_NE(soup.dropped[0].find("little-endian"), std::string::npos);
    const std::string file = File("field.vtk", BinarySquare(kind, true));
    EXPECT_EQ(ReadVertexField(file + ":s"), Eigen::Vector4d(1, 2, 3, 4.5)) << kind;
    // What is wrong is told as that of little-endian numbers.
    Refused(BinarySquare(kind, true, 4), {"polygon 2", "0 to 3", "little-endian"});
    const std::string refused = [&] {
      try {
        Read(BinarySquare(kind, false, 4));
      } catch (const FileError& error) {
        return std::string(error.what());
      }
      return std::string();
    }();
    EXPECT_NE(refused.find("polygon 2"), std::string::npos) << refused;
    EXPECT_EQ(refused.find("endian"), std::string::npos) << refused;
  }
}

// Where no cell tells the order, it is that of the format.
TEST_F(ReadVtkTest, PointsAloneDoNotTellTheByteOrder) {
  const std::string begin = "# vtk DataFile Version 3.0\nx\nBINARY\nDATASET POLYDATA\n";
  Refused(begin + "POINTS 2 double\n" + BinaryDoubles({0, 0, 0, 1, std::nan(""), 0}) + "\n",
          {"vertex 2", "finite"});
  // Offsets of one byte are the same in both orders.
  Refused("# vtk DataFile Version 5.1\nx\nBINARY\nDATASET POLYDATA\nPOINTS 3 double\n" +
              BinaryDoubles({0, 0, 0, 1, 0, 0, 0, std::nan(""), 0}) +
              std::string("\nPOLYGONS 2 3\nOFFSETS char\n\0\3\nCONNECTIVITY char\n\0\1\2\n", 52),
          {"vertex 3", "finite"});
}

TEST_F(ReadVtkTest, UnstructuredGridsOfSurfaceCells) {
  const std::string points =
      "# vtk DataFile Version 2.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 int\n"
      "0 0 0 1 0 0 0 1 0 1 1 0 2 0 0 2 1 0\n";
  const Soup soup =
      Read(points + "CELLS 4 17\n4 0 1 2 3\n4 1 4 5 3\n3 1 4 5\n2 0 5\nCELL_TYPES 4\n8 9 5 3\n");
  // The points of a pixel (type 8) are in rows.
  EXPECT_EQ(soup.corners, (std::vector<int>{0, 1, 3, 2, 1, 4, 5, 3, 1, 4, 5}));
  EXPECT_EQ(soup.segments.size(), 1u);
  Refused(points + "CELLS 1 5\n4 0 1 2 3\nCELL_TYPES 1\n10\n",
          {"m.vtk", "cell 1", "type 10", "volume", "Extract Surface"});
  Refused(points + "CELLS 1 5\n4 0 1 2 3\n", {"CELL_TYPES"});
  Refused(points + "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\n8\n", {"cell 1", "pixel", "four"});
  Refused(points + "CELLS 1 4\n3 0 1 2\nCELL_TYPES 1\nnan\n", {"cell 1", "type nan"});
}

TEST_F(ReadVtkTest, ColoursAndTextureCoordinatesAreKept) {
  const std::string begin = kAscii + "POINTS 3 float\n0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\n";
  const Soup soup = Read(begin +
                         "POINT_DATA 3\nSCALARS paint unsigned_char 3\nLOOKUP_TABLE default\n"
                         "255 0 0 0 51 0 0 0 255\nNORMALS n float\n0 0 1 0 0 1 0 0 1\n"
                         "TEXTURE_COORDINATES uv 2 float\n0 0 1 0 0 .5\n");
  Eigen::Matrix3d colours;
  colours << 1, 0, 0, 0, 0.2, 0, 0, 0, 1;
  EXPECT_EQ(soup.appearance.vertex_colours, colours);
  EXPECT_EQ(soup.appearance.texture_coordinates.col(2), Eigen::Vector2d(0, 0.5));
  EXPECT_EQ(soup.appearance.corner_texture, soup.corners);
  EXPECT_EQ(soup.dropped, std::vector<std::string>{"point data not kept: n"});
  // In text, COLOR_SCALARS are from 0 to 1.
  const Soup shares = Read(begin + "POINT_DATA 3\nCOLOR_SCALARS c 4\n1 0 0 .5 0 1 0 1 0 0 1 0\n");
  EXPECT_EQ(shares.appearance.vertex_colours.col(0), Eigen::Vector4d(1, 0, 0, 0.5));
  const Soup outside = Read(begin + "POINT_DATA 3\nCOLOR_SCALARS c 3\n9 0 0 0 1 0 0 0 1\n");
  EXPECT_EQ(outside.appearance.vertex_colours.size(), 0);
  EXPECT_EQ(outside.dropped.size(), 1u);
}

TEST_F(ReadVtkTest, NumbersOfVerticesAreFoundByTheirName) {
  const std::string file =
      File("m.vtk", kAscii +
                        "FIELD FieldData 1\nTimeValue 1 1 double\n0.5\nPOINTS 3 float\n"
                        "0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\nCELL_DATA 1\n"
                        "SCALARS bone int\nLOOKUP_TABLE default\n7\nPOINT_DATA 3\n"
                        "SCALARS bone double\nLOOKUP_TABLE own\n1 2.5 3\nLOOKUP_TABLE own 1\n"
                        "1 1 1 1\nVECTORS v float\n1 2 3 4 5 6 7 8 9\nFIELD more 2\n"
                        "bone%20age%21 1 3 long\n10 20 30\npair 2 3 float\n1 2 3 4 5 6\n");
  EXPECT_EQ(ReadVertexField(file + ":bone"), Eigen::Vector3d(1, 2.5, 3));
  EXPECT_EQ(ReadVertexField(file + ":bone age!"), Eigen::Vector3d(10, 20, 30));
  ExpectError<FileError>([&] { ReadVertexField(file + ":v"); }, {"m.vtk", "'v'", "3 components"});
  ExpectError<FileError>([&] { ReadVertexField(file + ":none"); }, {"m.vtk", "'none'"});
  ExpectError<FileError>([&] { ReadVertexField(file); }, {"m.vtk", ":name"});
  EXPECT_EQ(ReadSoup(file).dropped,
            (std::vector<std::string>{"1 arrays of cell data not kept",
                                      "point data not kept: bone, v, bone age!, pair"}));
}

TEST_F(ReadVtkTest, TextsArePassed) {
  const std::string rest = "POINTS 1 short\n";
  EXPECT_EQ(
      Read(kAscii + "FIELD f 2\nnames 1 3 string\na%20b\n\nc\nage 1 1 int\n7\n" + rest + "1 2 3\n")
          .vertices.col(0),
      Eigen::Vector3d(1, 2, 3));
  // Lengths in one, two, four and eight bytes.
  std::string texts(
      "\xc3"
      "abc"
      "\x80\x03"
      "abc",
      9);
  texts += std::string(
      "\x40\0\0\x03"
      "abc"
      "\0\0\0\0\0\0\0\x03"
      "abc",
      18);
  const std::string begin = "# vtk DataFile Version 5.1\n\nBINARY\nDATASET POLYDATA\nFIELD f 1\n";
  const std::string point = BinaryInts<std::int16_t>({1, 2, 3});
  EXPECT_EQ(Read(begin + "names 1 4 string\n" + texts + "\n" + rest + point).vertices.col(0),
            Eigen::Vector3d(1, 2, 3));
  Refused(begin + "names 1 99 string\n" + texts, {"'names'", "the file ends"});
  Refused(begin +
              "names 1 1 string\n\xff"
              "abc",
          {"'names'", "text 1", "longer"});
  Refused(begin + std::string("names 1 1 string\n\x3f\xff\xff\xff\xff\xff\xff\xff", 25),
          {"'names'", "text 1", "longer"});
}

TEST_F(ReadVtkTest, WhatIsWrongIsNamed) {
  Refused("solid x\n", {"m.vtk:1", "# vtk DataFile Version"});
  Refused("# vtk DataFile Version 6.0\n\nASCII\n", {"m.vtk:1", "version"});
  Refused("# vtk DataFile Version 3.0\n\nEBCDIC\n", {"m.vtk:3", "BINARY"});
  Refused("# vtk DataFile Version 3.0\n\nASCII\nDATASET STRUCTURED_GRID\n",
          {"m.vtk:4", "STRUCTURED_GRID", "Extract Surface"});
  Refused(kAscii, {"m.vtk", "no point"});
  Refused(kAscii + "POINTS 2 float\n0 0 0\n1 0 x\n", {"m.vtk:7", "points", "'x'"});
  Refused(kAscii + "POINTS 2 float\n0 0 0\n1 0 nan\n", {"vertex 2", "coordinate z", "finite"});
  Refused(kAscii + "POINTS 3 float\n0 0 0 1 0 0\n", {"points", "no room"});
  Refused(kAscii + "POINTS 3 complex\n", {"m.vtk:5", "complex"});
  Refused(kAscii + "POINTS -3 float\n", {"m.vtk:5", "'-3'"});
  const std::string points = kAscii + "POINTS 3 float\n0 0 0 1 0 0 0 1 0\n";
  Refused(points + "POLYGONS 1 4\n3 0 1 3\n", {"polygon 1", "0 to 2"});
  Refused(points + "POLYGONS 1 4\n3 0 1 1.5\n", {"polygon 1", "0 to 2"});
  Refused(points + "POLYGONS 1 3\n2 0 1\n", {"polygon 1", "2 points", "needs 3"});
  Refused(points + "POLYGONS 2 4\n3 0 1 2\n", {"cell 2"});
  Refused(points + "POLYGONS 1 4\n-1 0 1 2\n", {"cell 1"});
  Refused(points + "POLYGONS 1 5\n3 0 1 2 0\n", {"longer than its 1 cells"});
  Refused(points + "POINT_DATA 4\n", {"data of 4 points", "3"});
  Refused(points + "SPHERES 1 4\n", {"m.vtk:7", "'SPHERES'"});
  Refused(points + "POINT_DATA 3\nSCALARS s variant\n", {"'s'", "'variant'", ".vtp"});
}

TEST_F(ReadVtkTest, CountsBeyondTheFileAllocateNothing) {
  Refused(kAscii + "POINTS 999999999999 float\n0 0 0\n", {"points"});
  Refused(kAscii + "POINTS 9223372036854775807 float\n0 0 0\n", {"points"});
  const std::string points = kAscii + "POINTS 3 float\n0 0 0 1 0 0 0 1 0\n";
  Refused(points + "POLYGONS 1 999999999999\n3 0 1 2\n", {"room"});
  Refused(points + "POLYGONS 999999999999 4\n3 0 1 2\n", {"cell 2"});
  const std::string binary =
      "# vtk DataFile Version 5.1\n\nBINARY\nDATASET POLYDATA\nPOINTS 1 double\n" +
      BinaryDoubles({0, 0, 0});
  Refused(binary + "\nPOLYGONS 999999999 3\nOFFSETS vtktypeint64\n", {"OFFSETS", "room"});
  Refused(binary + "\nPOLYGONS 2 3\nOFFSETS vtktypeint64\n" + BinaryInts<std::int64_t>({0, 5}) +
              "\nCONNECTIVITY vtktypeint64\n" + BinaryInts<std::int64_t>({0, 0, 0}),
          {"polygon 1", "0 to 3"});
}

}  // namespace
}  // namespace shapespace
