#include <algorithm>
#include <sstream>

#include <shapespace/base/error.h>
#include <shapespace/files/read.h>
#include <shapespace/files/write.h>

#include "mesh/bodies.h"
#include "mesh/files.h"

namespace shapespace {
namespace {

using testing::Content;
using testing::ExpectError;

class ReadStlTest : public testing::FilesTest {
 protected:
  /// A text with a facet for each three of `corners`.
  static std::string Text(const std::vector<std::string>& corners) {
    std::ostringstream text;
    text << "solid a name of several words\n";
    for (size_t i = 0; i < corners.size(); i += 3) {
      text << "  facet normal 0 0 1\n    outer loop\n";
      for (size_t k = i; k < i + 3; ++k) text << "      vertex " << corners[k] << "\n";
      text << "    endloop\n  endfacet\n";
    }
    return text.str() + "endsolid\n";
  }

  void ExpectRefused(const std::string& content, const std::vector<std::string>& parts) {
    ExpectError<FileError>([&] { ReadSoup(File("bad.stl", content)); }, parts);
  }
};

// Two triangles of a square: the shared corners are written in different ways, and one coordinate
// as minus zero.
TEST_F(ReadStlTest, EqualCornersAreOneVertexInTheOrderOfTheFile) {
  const Soup soup =
      ReadSoup(File("a.STL", Text({"0 0 0", "1e0 0 0", "1 1 .5", "0 0 -0", "1.0 1 0.5", "0 1 0"})));
  Shape square(3, 4);
  square << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0.5, 0;
  EXPECT_EQ(soup.vertices, square);
  EXPECT_EQ(soup.corners, (std::vector<int>{0, 1, 2, 0, 2, 3}));
  EXPECT_EQ(soup.polygon_begin, (std::vector<int>{0, 3, 6}));
  EXPECT_EQ(soup.vertex_line, (std::vector<int>{4, 5, 6, 13}));
  EXPECT_EQ(soup.polygon_line, (std::vector<int>{4, 11}));
}

TEST_F(ReadStlTest, CornersThatDifferInTheLastBitAreTwoVertices) {
  const Soup soup = ReadSoup(
      File("a.stl", Text({"0 0 0", "1 0 0", "1 1 0", "0 0 0", "1.0000000000000002 1 0", "0 1 0"})));
  EXPECT_EQ(soup.NumVertices(), 5);
}

TEST_F(ReadStlTest, BinaryGivesTheMeshThatWasWritten) {
  const Soup torus = testing::Torus(12, 8);
  WriteMesh(Path("a.stl"), torus.vertices, torus);
  const Soup read = ReadSoup(Path("a.stl"));
  EXPECT_EQ(read.NumVertices(), torus.NumVertices());
  EXPECT_EQ(read.NumPolygons(), 2 * torus.NumPolygons());
  EXPECT_TRUE(read.polygon_line.empty());
  // Every vertex is there, rounded.
  for (const auto& vertex : torus.vertices.cast<float>().colwise()) {
    EXPECT_EQ((read.vertices.colwise() - vertex.cast<double>()).colwise().norm().minCoeff(), 0);
  }
}

// Writers of binary files put the name "solid ..." into the header too.
TEST_F(ReadStlTest, BinaryIsKnownByItsSize) {
  const Soup cube = testing::Cube();
  WriteMesh(Path("a.stl"), cube.vertices, cube);
  std::string bytes = Content(Path("a.stl"));
  bytes.replace(0, 10, "solid cube");
  EXPECT_EQ(ReadSoup(File("b.stl", bytes)).corners, ReadSoup(Path("a.stl")).corners);
  for (const std::string begin : {"solid", "bytes"}) {
    bytes.replace(0, 5, begin);
    ExpectRefused(bytes.substr(0, bytes.size() - 1), {"bad.stl: ", "'solid'"});
  }
  // An empty list of triangles tells nothing.
  ExpectRefused(std::string(84 + 20, '\0'), {"bad.stl: ", "'solid'"});
}

TEST_F(ReadStlTest, BytesAfterTheLastTriangleAreLeftOut) {
  const Soup torus = testing::Torus(12, 8);
  WriteMesh(Path("a.stl"), torus.vertices, torus);
  const Soup read = ReadSoup(Path("a.stl"));
  std::string bytes = Content(Path("a.stl"));
  for (const std::string begin : {"solid", "\n sOLID ", "other"}) {
    bytes.replace(0, begin.size(), begin);
    for (const std::string& end :
         {std::string("x"), std::string("0123456789"), std::string(50, 'x'),
          std::string(4096, '\0'), std::string("made by a scanner\r\n")}) {
      const Soup soup = ReadSoup(File("b.stl", bytes + end));
      EXPECT_EQ(soup.vertices, read.vertices);
      EXPECT_EQ(soup.corners, read.corners);
      EXPECT_EQ(soup.dropped, std::vector<std::string>{std::to_string(end.size()) +
                                                       " bytes after the last triangle not kept"});
    }
  }
  // Further triangles: the number of them is wrong.
  std::string fewer = bytes;
  fewer[80] = static_cast<char>(fewer[80] - 2);
  ExpectRefused(fewer, {"bad.stl: ", "190 triangles", "damaged"});
  // As where line ends were changed in transit: all that follows is not in its place.
  for (const size_t at : {size_t{84}, size_t{84 + 50 * 90 + 7}, bytes.size() - 40}) {
    std::string shifted = bytes;
    shifted.insert(at, "\r");
    EXPECT_THROW(ReadSoup(File("c.stl", shifted)), FileError) << at;
  }
}

TEST_F(ReadStlTest, PosesWhoseCornersFallTogetherDifferentlyAreRefused) {
  const std::vector<std::string> square = {"0 0 0", "1 0 0", "1 1 0", "0 0 0", "1 1 0", "0 1 0"};
  std::vector<std::string> moved = {"0 0 1", "1 0 1", "1 1 1", "0 0 1", "1 1 1", "0 1 1"};
  const std::string first = File("first.stl", Text(square));
  const Poses poses = ReadPoses({first, File("moved.stl", Text(moved))});
  EXPECT_EQ(poses.shapes[1].row(2), Eigen::RowVector4d::Ones());
  moved[5] = moved[1];
  ExpectError<MismatchError>(
      [&] {
        ReadPoses({first, File("folded.stl", Text(moved))});
      },
      {"folded.stl", "3 vertices", "4"});
}

}  // namespace
}  // namespace shapespace
