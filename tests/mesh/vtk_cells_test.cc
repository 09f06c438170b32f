#include <limits>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/bytes.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/read.h>

#include "mesh/files.h"
#include "support/message_of.h"

// Cells and points of VTK's legacy files, and what is said about them.

namespace shapespace::vtk_cells_test {
namespace {

using internal::AppendBigEndian;
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
  // 261 has 5, a triangle, in its last byte.
  for (const std::string type : {"0", "10", "14", "15", "22", "261", "-5"}) {
    const std::string cells = "CELLS 2 8\n3 0 1 3\n3 1 4 3\nCELL_TYPES 2\n5 " + type + "\n";
    EXPECT_TRUE(testing::Names(Refusal(kGrid + cells), {"m.vtk:12:", "cell 2", type}));
  }
}

TEST(VtkCellsTest, PixelsNeedFourPoints) {
  EXPECT_TRUE(testing::Names(Refusal(kGrid + "CELLS 2 9\n3 0 1 3\n4 1 4 3 0\nCELL_TYPES 2\n8 8\n"),
                             {"m.vtk:12:", "cell 1", "pixel"}));
  EXPECT_TRUE(testing::Names(Refusal(kGrid + "CELLS 2 8\n3 0 1 3\n3 1 4 3\nCELL_TYPES 2\n5 8\n"),
                             {"m.vtk:12:", "cell 2", "pixel"}));
  EXPECT_TRUE(
      testing::Names(Refusal(kGrid + "CELLS 2 10\n3 0 1 3\n5 1 4 3 0 2\nCELL_TYPES 2\n5 8\n"),
                     {"m.vtk:12:", "cell 2", "pixel"}));
}

TEST(VtkCellsTest, SayWhatDoesNotFit) {
  EXPECT_TRUE(testing::Names(Refusal(kGrid + "CELLS 1 4\n3 0 1 3\nCELL_TYPES 2\n5 5\n"),
                             {"m.vtk:10:", "2", "1"}));
  EXPECT_TRUE(testing::Names(Refusal(kGrid + "CELLS 1 4\n3 0 1 3\n"),
                             {"m.vtk:10:", "CELLS", "CELL_TYPES"}));
  EXPECT_TRUE(testing::Names(Refusal(kThree + "POINTS 3 float\n0 0 0 1 0 0 0 1 0\n"),
                             {"m.vtk:7:", "POINTS"}));
  EXPECT_TRUE(testing::Names(Refusal(kThree + "POLYGONS 2 8\n3 0 1 2\n4 0 1 2\n"),
                             {"m.vtk:9:", "POLYGONS", "cell 2"}));
  EXPECT_TRUE(testing::Names(Refusal(kThree + "LINES 1 4\n2 0 1 2\n"), {"m.vtk:8:", "LINES", "1"}));
  EXPECT_TRUE(testing::Names(Refusal(kThree + "POLYGONS x 4\n"), {"m.vtk:7:", "'x'"}));
  EXPECT_TRUE(testing::Names(Refusal(kThree + "POLYGONS 1 -4\n"), {"m.vtk:7:", "'-4'"}));
  EXPECT_TRUE(testing::Names(Refusal(kThree + "\n\nSPHERES 1 4\n"), {"m.vtk:9:", "'SPHERES'"}));
  EXPECT_TRUE(testing::Names(Refusal(kThree + "CELL_DATA 1\nSPHERES 1 float\n"),
                             {"m.vtk:8:", "'SPHERES'"}));
  EXPECT_TRUE(testing::Names(Refusal(kThree + "POINT_DATA 4\n"), {"m.vtk:7:", "4", "3"}));
}

// Of each kind the third cell; before it there are cells of the other kinds.
TEST(VtkCellsTest, EachKindOfCellIsCountedForItself) {
  const std::string before =
      "VERTICES 2 4\n1 0\n1 1\nLINES 2 6\n2 0 1\n2 1 2\nPOLYGONS 2 8\n3 0 1 2\n3 2 1 0\n"
      "TRIANGLE_STRIPS 2 8\n3 0 1 2\n3 2 1 0\n";
  const auto refused = [&](const std::string& cells, const std::vector<std::string>& parts) {
    EXPECT_TRUE(testing::Names(Refusal(kThree + before + cells), parts));
  };
  refused("VERTICES 1 2\n1 3\n", {"vertex cell 3:", "0 to 2"});
  refused("LINES 1 3\n2 0 -1\n", {"line 3:", "0 to 2"});
  refused("TRIANGLE_STRIPS 1 4\n3 0 0.5 1\n", {"triangle strip 3:", "0 to 2"});
  refused("VERTICES 1 1\n0\n", {"vertex cell 3:", "0", "1"});
  refused("LINES 1 2\n1 0\n", {"line 3:", "1", "2"});
  refused("TRIANGLE_STRIPS 1 3\n2 0 1\n", {"triangle strip 3:", "2", "3"});
  // Strips have become two polygons.
  refused("POLYGONS 1 3\n2 0 1\n", {"polygon 5:", "2", "3"});
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
  EXPECT_TRUE(
      testing::Names(Refusal(begin + "LINES 2 3\nOFFSETS int\n1 3\nCONNECTIVITY int\n2 0 1\n"),
                     {"m.vtk:9:", "LINES", "0"}));
  EXPECT_TRUE(testing::Names(Refusal(begin + "LINES 2 3\nOFFSETS int\n0 3\nPOLYGONS 0 0\n"),
                             {"m.vtk:10:", "LINES", "CONNECTIVITY"}));
  EXPECT_TRUE(
      testing::Names(Refusal(begin + "LINES 2 3\n2 0 1\n"), {"m.vtk:8:", "LINES", "OFFSETS"}));
  EXPECT_TRUE(testing::Names(Refusal(begin + "LINES 2 3\nOFFSETS int\n0 x\n"),
                             {"m.vtk:9:", "LINES", "OFFSETS", "'x'"}));
  EXPECT_TRUE(testing::Names(
      Refusal(begin + "LINES 3 5\nOFFSETS int\n0 2 1\nCONNECTIVITY int\n0 1 1 2 0\n"),
      {"m.vtk:", "line 2", "2", "5"}));
  EXPECT_TRUE(testing::Names(
      Refusal(begin + "LINES 3 5\nOFFSETS int\n0 2 6\nCONNECTIVITY int\n0 1 1 2 0\n"),
      {"m.vtk:", "line 2", "2", "5"}));
  EXPECT_TRUE(testing::Names(
      Refusal(begin + "LINES 3 5\nOFFSETS int\n0 2 4\nCONNECTIVITY int\n0 1 1 2 0\n"),
      {"m.vtk:", "4", "5"}));
}

TEST(VtkCellsTest, OffsetsAreWholeNumbers) {
  EXPECT_TRUE(testing::Names(
      Refusal("# vtk DataFile Version 5.0\n\nASCII\nDATASET POLYDATA\nPOINTS 3 float\n"
              "0 0 0 1 0 0 0 1 0\nLINES 3 5\nOFFSETS float\n0 2.5 5\nCONNECTIVITY int\n"
              "0 1 1 2 0\n"),
      {"m.vtk:", "line 1", "0", "5"}));
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
    EXPECT_TRUE(testing::Names(Refusal(with(version, "ASCII")), {"m.vtk:1:", "1.0", "5.1", ".vtp"}))
        << version;
  }
  EXPECT_TRUE(testing::Names(Refusal(with("3.0", "TEXT")), {"m.vtk:3:", "BINARY"}));
  EXPECT_TRUE(testing::Names(Refusal("# VTK DataFile Version 3.0\n"),
                             {"m.vtk:1:", "'# vtk DataFile Version'"}));
  EXPECT_TRUE(testing::Names(Refusal("# vtk DataFile Version 3.0\n\nASCII\nDATASET FIELD\n"),
                             {"m.vtk:4:", "'FIELD'", "POLYDATA", "UNSTRUCTURED_GRID"}));
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
  EXPECT_TRUE(testing::Names(Refusal(kPolyData + "POINTS 2 float\n0 0 0\n1 0"), {"m.vtk:5:", "6"}));
  EXPECT_TRUE(testing::Names(Refusal(kPolyData + "POINTS 2 float\n0.0 0 0\n1 0"), {"m.vtk:7:"}));
  EXPECT_EQ(Read(kPolyData + "POINTS 2 float\n0 0 0\n1 0 4").vertices.col(1),
            Eigen::Vector3d(1, 0, 4));
  EXPECT_TRUE(testing::Names(Refusal(kPolyData + "POINTS 2 float\n0 0 0\n1 inf 0\n"),
                             {"m.vtk:", "vertex 2", "coordinate y"}));
  EXPECT_TRUE(
      testing::Names(Refusal(kPolyData + "POINTS 2 quad\n"), {"m.vtk:5:", "'quad'", ".vtp"}));
  EXPECT_TRUE(testing::Names(Refusal(kPolyData), {"m.vtk:", "point"}));
  // Behind the first numbers of a binary file there are no lines.
  const std::string binary =
      "# vtk DataFile Version 3.0\n\nBINARY\nDATASET POLYDATA\nPOINTS 1 char\nabc\nSPHERES 1\n";
  EXPECT_TRUE(testing::Names(Refusal(binary), {"m.vtk:", "'SPHERES'"}));
  EXPECT_TRUE(testing::Names(
      Refusal("# vtk DataFile Version 3.0\n\nBINARY\nDATASET POLYDATA\nPOINTS 1 short\nabcde"),
      {"m.vtk:", "3"}));
}

}  // namespace
}  // namespace shapespace::vtk_cells_test
