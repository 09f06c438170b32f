#include <cmath>
#include <limits>
#include <sstream>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/bytes.h>
#include <shapespace/files/read.h>
#include <shapespace/files/write.h>

#include "mesh/bodies.h"
#include "mesh/files.h"
#include "support/message_of.h"

// The whole content of small files of every format.

namespace shapespace::written_bytes_test {
namespace {

using internal::AppendLittleEndian;
using Strings = std::vector<std::string>;

/// A quadrilateral, a triangle, and a line, with every kind of appearance.
class WrittenBytesTest : public testing::FilesTest {
 protected:
  WrittenBytesTest() {
    Shape vertices(3, 6);
    vertices << 0, 2, 2, 0, 1, 5, 0, 0, 1, 1, 2.5, 6, 0.5, 0.5, 0.5, 0.5, 0.5, -7;
    soup_ = testing::MakeSoup(vertices, {{0, 1, 2, 3}, {3, 2, 4}});
    soup_.segments = {{4, 5}, {5, 0}};
    Appearance& appearance = soup_.appearance;
    appearance.texture_coordinates.resize(2, 3);
    appearance.texture_coordinates << 0, 1, 0.25, 0, -2, 0.75;
    appearance.corner_texture = {2, 1, 0, 1, -1, 2, 0};
    appearance.material_libraries = {"one.mtl", "my two.mtl"};
    appearance.materials = {{"red", "blue"}, {1, 0}};
    appearance.groups = {{"arm"}, {0, -1}};
    appearance.objects = {{"body"}, {0, 0}};
    appearance.vertex_colours.resize(3, 6);
    appearance.vertex_colours << 0, 1, 0.5, 0.25, 0, 0.2,  //
        1, 0, 0.498, 0.5, 0, 0.4,                          //
        0.11, 0.31, 1, 0.75, 0, 0.6;
  }

  std::string Written(const std::string& name) const {
    WriteMesh(Path(name), soup_.vertices, soup_);
    return testing::Content(Path(name));
  }

  /// What is said behind the folder.
  std::string Refusal(const std::string& name, const Shape& vertices, const Soup& soup) const {
    return testing::MessageOf<MeshError>([&] { WriteMesh(Path(name), vertices, soup); })
        .substr(Path("").size());
  }

  Soup soup_;
};

TEST_F(WrittenBytesTest, Obj) {
  EXPECT_EQ(Written("a.OBJ"),
            "mtllib one.mtl\nmtllib my two.mtl\n"
            "v 0 0 0.5 0 1 0.11\nv 2 0 0.5 1 0 0.31\nv 2 1 0.5 0.5 0.498 1\n"
            "v 0 1 0.5 0.25 0.5 0.75\nv 1 2.5 0.5 0 0 0\nv 5 6 -7 0.2 0.4 0.6\n"
            "vt 0 0\nvt 1 -2\nvt 0.25 0.75\n"
            "o body\ng arm\nusemtl blue\nf 1/3 2/2 3/1 4/2\ng\nusemtl red\nf 4 3/3 5/1\n"
            "l 5 6\nl 6 1\n");
}

TEST_F(WrittenBytesTest, Off) {
  EXPECT_EQ(Written("a.off"),
            "OFF\n6 2 0\n0 0 0.5\n2 0 0.5\n2 1 0.5\n0 1 0.5\n1 2.5 0.5\n5 6 -7\n"
            "4 0 1 2 3\n3 3 2 4\n");
}

TEST_F(WrittenBytesTest, Ply) {
  std::string expected =
      "ply\nformat binary_little_endian 1.0\nelement vertex 6\nproperty double x\n"
      "property double y\nproperty double z\nproperty uchar red\nproperty uchar green\n"
      "property uchar blue\nelement face 2\nproperty list uchar int vertex_indices\n"
      "property list uchar float texcoord\nelement edge 2\nproperty int vertex1\n"
      "property int vertex2\nend_header\n";
  // The nearest bytes; half a byte is rounded up.
  const unsigned char colours[6][3] = {{0, 255, 28},   {255, 0, 79}, {128, 127, 255},
                                       {64, 128, 191}, {0, 0, 0},    {51, 102, 153}};
  for (int v = 0; v < 6; ++v) {
    for (int axis = 0; axis < 3; ++axis) AppendLittleEndian(soup_.vertices(axis, v), &expected);
    for (const unsigned char colour : colours[v]) expected += static_cast<char>(colour);
  }
  expected += '\4';
  for (const int v : {0, 1, 2, 3}) AppendLittleEndian(v, &expected);
  expected += '\10';
  for (const float t : {.25f, .75f, 1.f, -2.f, 0.f, 0.f, 1.f, -2.f}) {
    AppendLittleEndian(t, &expected);
  }
  expected += '\3';
  for (const int v : {3, 2, 4}) AppendLittleEndian(v, &expected);
  expected += '\0';  // since one of its corners has none
  for (const int v : {4, 5, 5, 0}) AppendLittleEndian(v, &expected);
  const std::string written = Written("a.ply");
  EXPECT_EQ(written.size(), expected.size());
  EXPECT_TRUE(written == expected);
  std::ostringstream stream;
  WritePly(stream, "socket", soup_.vertices, soup_);
  EXPECT_TRUE(stream.str() == expected);
}

TEST_F(WrittenBytesTest, PlyWithOpacityAlone) {
  soup_ = testing::MakeSoup(Shape::Identity(3, 3), {{0, 2, 1}});
  soup_.appearance.vertex_colours.setOnes(4, 3);
  soup_.appearance.vertex_colours(3, 1) = 0.2;
  const std::string written = Written("a.ply");
  EXPECT_NE(written.find("property uchar blue\nproperty uchar alpha\nelement face 1\nproperty list "
                         "uchar int vertex_indices\nend_header\n"),
            std::string::npos);
  EXPECT_EQ(written.size(), written.find("end_header\n") + 11 + 3 * (24 + 4) + 1 + 12);
}

TEST_F(WrittenBytesTest, Stl) {
  soup_.vertices.row(2).setConstant(0.5);
  soup_.triangles.resize(3, 3);
  soup_.triangles << 0, 0, 3, 1, 2, 4, 2, 3, 2;  // the last one turned over
  std::string expected = "binary STL of shapespace";
  expected.resize(80, ' ');
  AppendLittleEndian(std::uint32_t{3}, &expected);
  for (int f = 0; f < 3; ++f) {
    for (const float x : {0.f, 0.f, f == 2 ? -1.f : 1.f}) AppendLittleEndian(x, &expected);
    for (const int v : soup_.triangles.col(f)) {
      for (int axis = 0; axis < 3; ++axis) {
        AppendLittleEndian(static_cast<float>(soup_.vertices(axis, v)), &expected);
      }
    }
    expected += std::string(2, '\0');
  }
  EXPECT_EQ(expected.size(), 84u + 3 * 50);
  std::string written = Written("a.stl");
  ASSERT_EQ(written.size(), expected.size());
  for (int f = 0; f < 3; ++f) {
    // The normals' zeros may have a sign.
    for (int axis = 0; axis < 3; ++axis) {
      const size_t at = 84 + 50 * f + 4 * axis;
      EXPECT_EQ(internal::ReadLittleEndian<float>(&written[at]),
                internal::ReadLittleEndian<float>(&expected[at]));
      written.replace(at, 4, expected, at, 4);
    }
  }
  EXPECT_TRUE(written == expected);
  // Without triangles, it cuts the polygons itself: two and one.
  soup_.triangles.resize(3, 0);
  const Soup read = ReadSoup(File("b.stl", Written("b.stl")));
  EXPECT_EQ(read.NumPolygons(), 3);
  EXPECT_EQ(read.NumVertices(), 5);
}

TEST_F(WrittenBytesTest, EachFormatTellsAllThatItDrops) {
  const std::string names = "materials, groups, objects";
  const std::string end = " are dropped; OBJ keeps them";
  for (const char* file : {"a.off", "b.STL"}) {
    EXPECT_EQ(NotKept(file, soup_),
              Strings{names + ", texture coordinates, vertex colours, segments" + end});
  }
  EXPECT_EQ(NotKept("a.ply", soup_),
            (Strings{names + end,
                     "texture coordinates of 1 polygons are dropped, since some of their corners "
                     "have none"}));
  EXPECT_TRUE(NotKept("a.Obj", soup_).empty());
  soup_.appearance.corner_texture = {-1, -1, -1, -1, 2, 1, 0};  // none, and all
  EXPECT_EQ(NotKept("a.ply", soup_), Strings{names + end});
  soup_.appearance.corner_texture = {-1, -1, -1, 2, 2, 1, -1};
  soup_.appearance.materials = soup_.appearance.groups = soup_.appearance.objects = {};
  EXPECT_EQ(NotKept("a.ply", soup_),
            Strings{"texture coordinates of 2 polygons are dropped, since some of their corners "
                    "have none"});
  soup_.appearance.corner_texture = {-1, 0, -1, -1, -1, -1, -1};  // the first one of all
  EXPECT_EQ(NotKept("a.ply", soup_).size(), 1u);
  soup_.appearance = {};
  soup_.segments.clear();
  for (const char* file : {"a.off", "a.stl", "a.ply"}) EXPECT_TRUE(NotKept(file, soup_).empty());
}

TEST_F(WrittenBytesTest, FormatsThatAreWritten) {
  for (const char* file : {"a.obj", "a.PLY", "b/a.off", "a.b.stl"}) {
    EXPECT_TRUE(IsWritableMesh(file)) << file;
  }
  for (const char* file : {"a.glb", "a.gltf", "a.vtk", "a.vtp", "obj", "a.obj/b", ""}) {
    EXPECT_FALSE(IsWritableMesh(file)) << file;
  }
  EXPECT_TRUE(testing::Refuses<FileError>([&] { WriteMesh("a.glb", soup_.vertices, soup_); },
                                          {"a.glb:", "'.glb'", ".obj", ".ply", ".off", ".stl"}));
}

TEST_F(WrittenBytesTest, WritingToAStreamThatFailsIsAnError) {
  std::ostringstream stream;
  stream.setstate(std::ios::badbit);
  EXPECT_TRUE(testing::Refuses<FileError>(
      [&] { WritePly(stream, "socket", soup_.vertices, soup_); }, {"socket:"}));
}

TEST_F(WrittenBytesTest, RefusalsSayWhatIsWrong) {
  Shape broken = soup_.vertices;
  broken(2, 5) = std::numeric_limits<double>::infinity();
  for (const std::string name : {"a.obj", "a.ply", "a.off", "a.stl"}) {
    EXPECT_TRUE(testing::Names(Refusal(name, broken, soup_), {name, "vertex 6"}));
    EXPECT_TRUE(testing::Names(Refusal(name, soup_.vertices.leftCols(5), soup_), {name, "5", "6"}));
  }
  Soup graph;
  graph.vertices = soup_.vertices;
  graph.segments = soup_.segments;
  for (const std::string name : {"a.off", "a.stl"}) {
    EXPECT_TRUE(testing::Names(Refusal(name, graph.vertices, graph), {name, ".obj", ".ply"}));
  }
  soup_.appearance.texture_coordinates(1, 2) = -1e39;
  EXPECT_TRUE(testing::Names(Refusal("a.ply", soup_.vertices, soup_), {"a.ply:"}));
  EXPECT_NO_THROW(Written("a.obj"));
  EXPECT_NO_THROW(Written("a.off"));
}

// At 2^24 single precision has even numbers only.
TEST_F(WrittenBytesTest, StlMayRoundByATenThousandthOfTheSize) {
  const double far = 16777216;
  const auto sized = [&](double size) {
    Shape vertices(3, 4);
    vertices << far + 0.5, far - 0.5, far, far, 0, size, 0, size, 0, 0, 0, 0;
    return vertices;
  };
  const Soup soup = testing::MakeSoup(sized(1), {{0, 1, 2}, {1, 3, 2}});
  EXPECT_NO_THROW(WriteMesh(Path("a.stl"), sized(5200), soup));
  EXPECT_TRUE(testing::Names(Refusal("a.stl", sized(4800), soup),
                             {"a.stl:", "4800", "0.5", ".obj", ".ply"}));
}

}  // namespace
}  // namespace shapespace::written_bytes_test
