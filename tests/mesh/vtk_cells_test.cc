#include <limits>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/bytes.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/read.h>

#include "mesh/files.h"
#include "support/message_of.h"

// Cells and points of VTK's legacy files, and the whole text of what is said about them.

namespace shapespace::vtk_cells_test {
namespace {

using internal::AppendBigEndian;
using internal::kReexport;
using Ints = std::vector<int>;
using Strings = std::vector<std::string>;
using Segments = std::vector<std::pair<int, int>>;

constexpr char kSurface[] =
    "; in ParaView, apply the filter Extract Surface and save the result as .vtp or .vtk";

const std::string kPolyData = "# vtk DataFile Version 3.0\na title\nASCII\nDATASET POLYDATA\n";
const std::string kThree = kPolyData + "POINTS 3 float\n0 0 0 1 0 0 0 1 0\n";
const std::string kGrid =
    "# vtk DataFile Version 1.0\na title\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 6 float\n"
    "0 0 0 1 0 0 2 0 0\n0 1 0 1 1 0 2 1 0\n";

Soup Read(const std::string& content) {
  return testing::SoupOf(content, "m.vtk", MeshFormat::kVtk);
}

std::string Refusal(const std::string& content) {
  return testing::MessageOf<FileError>([&] { Read(content); });
}

TEST(VtkCellsTest, EveryTypeOfCellThatIsReadBecomesWhatItIs) {
  // Vertex, polyvertex, line, polyline, triangle, strip, polygon, pixel, quadrilateral.
  const Soup soup = Read(kGrid +
                         "CELLS 9 37\n1 3\n2 4 5\n2 0 4\n3 5 1 0\n3 0 1 3\n4 3 4 0 1\n5 0 1 2 5 4\n"
                         "4 1 2 4 5\n4 0 1 4 3\nCELL_TYPES 9\n1\n2\n3\n4\n5\n6\n7\n8\n9\n");
  EXPECT_EQ(soup.segments, (Segments{{0, 4}, {5, 1}, {1, 0}}));
  EXPECT_EQ(soup.polygon_begin, (Ints{0, 3, 6, 9, 14, 18, 22}));
  EXPECT_EQ(soup.corners, (Ints{0, 1, 3, 3, 4, 0, 0, 4, 1, 0, 1, 2, 5, 4, 1, 2, 5, 4, 0, 1, 4, 3}));
  EXPECT_EQ(soup.dropped, Strings{"2 vertex cells not kept"});
  EXPECT_EQ(soup.file, "m.vtk");
}

TEST(VtkCellsTest, OtherTypesOfCellsAreNamedWithTheRemedy) {
  const auto refused = [](const std::string& type, const std::string& words) {
    EXPECT_EQ(Refusal(kGrid + "CELLS 2 8\n3 0 1 3\n3 1 4 3\nCELL_TYPES 2\n5 " + type + "\n"),
              "m.vtk:12: cell 2 is of VTK's type " + words +
                  "; only points, lines, triangles, quadrilaterals, polygons and strips are read" +
                  kSurface);
  };
  refused("0", "0");
  refused("10", "10, a volume");
  refused("14", "14, a volume");
  refused("15", "15");
  refused("22", "22");
  refused("261", "261");  // 5, a triangle, in the last byte
  refused("-5", "-5");
}

TEST(VtkCellsTest, PixelsNeedFourPoints) {
  const std::string words = ": a pixel needs four points";
  EXPECT_EQ(Refusal(kGrid + "CELLS 2 9\n3 0 1 3\n4 1 4 3 0\nCELL_TYPES 2\n8 8\n"),
            "m.vtk:12: cell 1" + words + kReexport);
  EXPECT_EQ(Refusal(kGrid + "CELLS 2 8\n3 0 1 3\n3 1 4 3\nCELL_TYPES 2\n5 8\n"),
            "m.vtk:12: cell 2" + words + kReexport);
  EXPECT_EQ(Refusal(kGrid + "CELLS 2 10\n3 0 1 3\n5 1 4 3 0 2\nCELL_TYPES 2\n5 8\n"),
            "m.vtk:12: cell 2" + words + kReexport);
}

TEST(VtkCellsTest, SayWhatDoesNotFit) {
  EXPECT_EQ(Refusal(kGrid + "CELLS 1 4\n3 0 1 3\nCELL_TYPES 2\n5 5\n"),
            std::string("m.vtk:10: 2 cell types follow, there are 1 cells") + kReexport);
  EXPECT_EQ(Refusal(kGrid + "CELLS 1 4\n3 0 1 3\n"),
            std::string("m.vtk:10: CELLS have no CELL_TYPES") + kReexport);
  EXPECT_EQ(Refusal(kThree + "POINTS 3 float\n0 0 0 1 0 0 0 1 0\n"),
            std::string("m.vtk:7: POINTS occur twice") + kReexport);
  EXPECT_EQ(Refusal(kThree + "POLYGONS 2 8\n3 0 1 2\n4 0 1 2\n"),
            std::string("m.vtk:9: POLYGONS: cell 2 has more points than the list of cells has "
                        "room for") +
                kReexport);
  EXPECT_EQ(
      Refusal(kThree + "LINES 1 4\n2 0 1 2\n"),
      std::string("m.vtk:8: LINES: the list of cells is longer than its 1 cells") + kReexport);
  EXPECT_EQ(Refusal(kThree + "POLYGONS x 4\n"),
            std::string("m.vtk:7: the number of cells 'x' is not a count") + kReexport);
  EXPECT_EQ(
      Refusal(kThree + "POLYGONS 1 -4\n"),
      std::string("m.vtk:7: the number of numbers of the cells '-4' is not a count") + kReexport);
  EXPECT_EQ(Refusal(kThree + "\n\nSPHERES 1 4\n"),
            std::string("m.vtk:9: 'SPHERES' is not a keyword of a mesh") + kReexport);
  EXPECT_EQ(Refusal(kThree + "CELL_DATA 1\nSPHERES 1 float\n"),
            std::string("m.vtk:8: 'SPHERES' is not a keyword of data") + kReexport);
  EXPECT_EQ(Refusal(kThree + "POINT_DATA 4\n"),
            std::string("m.vtk:7: data of 4 points follow, there are 3") + kReexport);
}

// Of each kind the third cell; before it there are cells of the other kinds.
TEST(VtkCellsTest, EachKindOfCellIsCountedForItself) {
  const std::string before =
      "VERTICES 2 4\n1 0\n1 1\nLINES 2 6\n2 0 1\n2 1 2\nPOLYGONS 2 8\n3 0 1 2\n3 2 1 0\n"
      "TRIANGLE_STRIPS 2 8\n3 0 1 2\n3 2 1 0\n";
  const auto refused = [&](const std::string& cells, const std::string& words) {
    EXPECT_EQ(Refusal(kThree + before + cells), "m.vtk: " + words + kReexport);
  };
  const std::string index = ": a point's index is not one of 0 to 2";
  refused("VERTICES 1 2\n1 3\n", "vertex cell 3" + index);
  refused("LINES 1 3\n2 0 -1\n", "line 3" + index);
  refused("TRIANGLE_STRIPS 1 4\n3 0 0.5 1\n", "triangle strip 3" + index);
  refused("VERTICES 1 1\n0\n", "vertex cell 3: 0 points, it needs 1");
  refused("LINES 1 2\n1 0\n", "line 3: 1 points, it needs 2");
  refused("TRIANGLE_STRIPS 1 3\n2 0 1\n", "triangle strip 3: 2 points, it needs 3");
  // Strips have become two polygons.
  refused("POLYGONS 1 3\n2 0 1\n", "polygon 5: 2 points, it needs 3");
}

TEST(VtkCellsTest, OffsetsAreChecked) {
  const std::string begin =
      "# vtk DataFile Version 5.1\n\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n"
      "0 0 0 1 0 0 0 1 0\n";
  const Soup soup = Read(begin +
                         "VERTICES 0 0\nLINES 2 3\nOFFSETS vtktypeint64\n0 3\n"
                         "CONNECTIVITY vtktypeint64\n2 0 1\n");
  EXPECT_EQ(soup.segments, (Segments{{2, 0}, {0, 1}}));
  EXPECT_TRUE(soup.dropped.empty());
  EXPECT_EQ(Refusal(begin + "LINES 2 3\nOFFSETS int\n1 3\nCONNECTIVITY int\n2 0 1\n"),
            std::string("m.vtk:9: LINES: the first offset is not 0") + kReexport);
  EXPECT_EQ(Refusal(begin + "LINES 2 3\nOFFSETS int\n0 3\nPOLYGONS 0 0\n"),
            std::string("m.vtk:10: LINES is not followed by CONNECTIVITY") + kReexport);
  EXPECT_EQ(Refusal(begin + "LINES 2 3\n2 0 1\n"),
            std::string("m.vtk:8: LINES is not followed by OFFSETS") + kReexport);
  EXPECT_EQ(Refusal(begin + "LINES 2 3\nOFFSETS int\n0 x\n"),
            std::string("m.vtk:9: LINES, OFFSETS: 'x' is not a number") + kReexport);
  EXPECT_EQ(Refusal(begin + "LINES 3 5\nOFFSETS int\n0 2 1\nCONNECTIVITY int\n0 1 1 2 0\n"),
            std::string("m.vtk: line 2: where its points end in the connectivity is not a number "
                        "from 2 to 5") +
                kReexport);
  EXPECT_EQ(Refusal(begin + "LINES 3 5\nOFFSETS int\n0 2 6\nCONNECTIVITY int\n0 1 1 2 0\n"),
            std::string("m.vtk: line 2: where its points end in the connectivity is not a number "
                        "from 2 to 5") +
                kReexport);
  EXPECT_EQ(Refusal(begin + "LINES 3 5\nOFFSETS int\n0 2 4\nCONNECTIVITY int\n0 1 1 2 0\n"),
            std::string("m.vtk: the cells have 4 points, the connectivity has 5") + kReexport);
}

TEST(VtkCellsTest, OffsetsAreWholeNumbers) {
  EXPECT_EQ(Refusal("# vtk DataFile Version 5.0\n\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n"
                    "0 0 0 1 0 0 0 1 0\nLINES 3 5\nOFFSETS float\n0 2.5 5\nCONNECTIVITY int\n"
                    "0 1 1 2 0\n"),
            std::string("m.vtk: line 1: where its points end in the connectivity is not a number "
                        "from 0 to 5") +
                kReexport);
}

TEST(VtkCellsTest, HeadersOfAllVersions) {
  const auto with = [](const std::string& version, const std::string& format) {
    return "# vtk DataFile Version " + version + "\n\n" + format +
           "\ndataset PolyData\npoints 1 float\n1 2 3\n";
  };
  for (const char* version : {"1.0", "2.0", "3.0 ", "4.2", "5.1", "5.9"}) {
    EXPECT_EQ(Read(with(version, "ascii")).vertices.col(0), Eigen::Vector3d(1, 2, 3)) << version;
  }
  for (const char* version : {"0.9", "6.0", "x", "nan"}) {
    EXPECT_EQ(Refusal(with(version, "ASCII")),
              "m.vtk:1: the version of the format is not one of 1.0 to 5.1; save the mesh as .vtp")
        << version;
  }
  EXPECT_EQ(Refusal(with("3.0", "TEXT")),
            std::string("m.vtk:3: the third line is neither ASCII nor BINARY") + kReexport);
  EXPECT_EQ(Refusal("# VTK DataFile Version 3.0\n"),
            "m.vtk:1: does not begin with '# vtk DataFile Version'; is this a VTK file of the "
            "legacy format?");
  EXPECT_EQ(Refusal("# vtk DataFile Version 3.0\n\nASCII\nDATASET FIELD\n"),
            std::string("m.vtk:4: the data set is of the kind 'FIELD', only POLYDATA and "
                        "UNSTRUCTURED_GRID are read") +
                kSurface);
}

// Of integers, the third is too large for the type of the other sign, or of less bytes.
TEST(VtkCellsTest, NumbersOfEveryType) {
  const auto points = [](const std::string& type, auto largest) {
    using T = decltype(largest);
    std::string bytes;
    for (const T number : {static_cast<T>(1), static_cast<T>(2), largest}) {
      AppendBigEndian(number, &bytes);
    }
    const Soup soup = Read("# vtk DataFile Version 3.0\n\nBINARY\nDATASET POLYDATA\nPOINTS 1 " +
                           type + "\n" + bytes);
    EXPECT_EQ(soup.vertices.col(0), Eigen::Vector3d(1, 2, static_cast<double>(largest))) << type;
  };
  points("char", std::int8_t{-100});
  points("signed_char", std::int8_t{-100});
  points("unsigned_char", std::uint8_t{200});
  points("short", std::int16_t{-30000});
  points("unsigned_short", std::uint16_t{60000});
  points("int", std::int32_t{-2000000000});
  points("unsigned_int", std::uint32_t{4000000000});
  points("long", std::int64_t{-4000000000000});
  points("unsigned_long", std::uint64_t{1} << 63);
  points("vtktypeint64", std::int64_t{-4000000000000});
  points("vtktypeuint64", std::uint64_t{1} << 63);
  points("vtkidtype", std::int32_t{-2000000000});
  points("vtkIdType", std::int32_t{-2000000000});  // as VTK writes it
  points("UNSIGNED_CHAR", std::uint8_t{200});
  points("float", 0.1f);
  points("double", 0.1);
}

TEST(VtkCellsTest, PointsThatEndEarlyOrAreNotFinite) {
  EXPECT_EQ(Refusal(kPolyData + "POINTS 2 float\n0 0 0\n1 0"),
            std::string("m.vtk:5: points: 6 numbers are promised, which the file has no room for") +
                kReexport);
  EXPECT_EQ(Refusal(kPolyData + "POINTS 2 float\n0.0 0 0\n1 0"),
            std::string("m.vtk:7: points: the file ends before its last number") + kReexport);
  EXPECT_EQ(Read(kPolyData + "POINTS 2 float\n0 0 0\n1 0 4").vertices.col(1),
            Eigen::Vector3d(1, 0, 4));
  EXPECT_EQ(Refusal(kPolyData + "POINTS 2 float\n0 0 0\n1 inf 0\n"),
            std::string("m.vtk: vertex 2: coordinate y is not a finite number") + kReexport);
  EXPECT_EQ(Refusal(kPolyData + "POINTS 2 quad\n"),
            "m.vtk:5: points: arrays of type 'quad' are not read; save the mesh as .vtp, or "
            "without this array");
  EXPECT_EQ(Refusal(kPolyData), std::string("m.vtk: there is no point in it") + kReexport);
  // Behind the first numbers of a binary file there are no lines.
  const std::string binary =
      "# vtk DataFile Version 3.0\n\nBINARY\nDATASET POLYDATA\nPOINTS 1 char\nabc\nSPHERES 1\n";
  EXPECT_EQ(Refusal(binary),
            std::string("m.vtk: 'SPHERES' is not a keyword of a mesh") + kReexport);
  EXPECT_EQ(
      Refusal("# vtk DataFile Version 3.0\n\nBINARY\nDATASET POLYDATA\nPOINTS 1 short\nabcde"),
      std::string("m.vtk: points: 3 numbers are promised, which the file has no room for") +
          kReexport);
}

}  // namespace
}  // namespace shapespace::vtk_cells_test
