#include <cmath>
#include <cstdint>
#include <cstring>
#include <functional>
#include <limits>
#include <random>

#include <shapespace/base/error.h>
#include <shapespace/files/read.h>
#include <shapespace/files/write.h>
#include <shapespace/mesh/triangulate.h>

#include "mesh/bodies.h"
#include "mesh/files.h"
#include "support/same_appearance.h"

namespace shapespace {
namespace {

using testing::ExpectError;

class WriteTest : public testing::FilesTest {
 protected:
  WriteTest() : soup_(testing::Cube()) {
    // Numbers of all magnitudes, to detect lost digits.
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> mantissa(-1, 1), exponent(-20, 20);
    for (int i = 0; i < soup_.vertices.size(); ++i) {
      soup_.vertices.data()[i] = mantissa(random) * std::pow(10.0, exponent(random));
    }
    soup_.segments = {{0, 7}, {3, 4}};
  }

  Soup soup_;
};

TEST_F(WriteTest, PlyIsExact) {
  WriteMesh(Path("a.ply"), soup_.vertices, soup_);
  const Soup read = ReadSoup(Path("a.ply"));
  EXPECT_EQ(read.vertices, soup_.vertices);
  EXPECT_EQ(read.polygon_begin, soup_.polygon_begin);
  EXPECT_EQ(read.corners, soup_.corners);
  EXPECT_EQ(read.segments, soup_.segments);
  EXPECT_TRUE(read.dropped.empty());
}

TEST_F(WriteTest, PlyKeepsTextureCoordinatesAndColours) {
  Appearance& appearance = soup_.appearance;
  appearance.texture_coordinates = Eigen::Matrix2Xf::Random(2, 7).cast<double>();
  for (size_t k = 0; k < soup_.corners.size(); ++k) {
    appearance.corner_texture.push_back(static_cast<int>(k) % 7);
  }
  appearance.corner_texture[5] = -1;  // in polygon 1
  Eigen::MatrixXi bytes = (Eigen::MatrixXd::Random(4, 8).array() * 127.9 + 128).cast<int>();
  appearance.vertex_colours = bytes.cast<double>() / 255;
  WriteMesh(Path("a.ply"), soup_.vertices, soup_);
  const Soup read = ReadSoup(Path("a.ply"));
  EXPECT_EQ(read.vertices, soup_.vertices);
  EXPECT_EQ(read.segments, soup_.segments);
  EXPECT_EQ(read.appearance.vertex_colours, appearance.vertex_colours);
  ASSERT_EQ(read.appearance.corner_texture.size(), soup_.corners.size());
  for (size_t k = 0; k < soup_.corners.size(); ++k) {
    const int index = read.appearance.corner_texture[k];
    if (k >= 4 && k < 8) {
      EXPECT_EQ(index, -1);
      continue;
    }
    EXPECT_EQ(read.appearance.texture_coordinates.col(index),
              appearance.texture_coordinates.col(appearance.corner_texture[k]));
  }
  EXPECT_EQ(read.appearance.texture_coordinates.cols(), 7) << "one each, however often used";
  EXPECT_TRUE(read.dropped.empty());

  appearance.materials = {{"a"}, std::vector<int>(6, 0)};
  appearance.objects = appearance.materials;
  EXPECT_EQ(NotKept("a.PLY", soup_),
            (std::vector<std::string>{"materials, objects are dropped; OBJ keeps them",
                                      "texture coordinates of 1 polygons are dropped, since some "
                                      "of their corners have none"}));
  EXPECT_TRUE(NotKept("a.obj", soup_).empty());
  appearance.texture_coordinates(0, 0) = 1e39;
  ExpectError<MeshError>([&] { WriteMesh(Path("b.ply"), soup_.vertices, soup_); },
                         {"b.ply: a texture coordinate is too large"});
}

TEST_F(WriteTest, ObjIsExactAndKeepsTheAppearance) {
  Appearance& appearance = soup_.appearance;
  appearance.texture_coordinates = Eigen::Matrix2Xd::Random(2, 5);
  for (size_t k = 0; k < soup_.corners.size(); ++k) {
    appearance.corner_texture.push_back(static_cast<int>(k) % 6 - 1);
  }
  appearance.material_libraries = {"one.mtl", "two words.mtl"};
  appearance.materials = {{"a", "b", "a b"}, {-1, 0, 0, 1, 2, 0}};
  appearance.groups = {{"left arm", "head"}, {0, 0, -1, -1, 1, 0}};
  appearance.objects = {{"body"}, {0, 0, 0, 0, 0, 0}};
  appearance.vertex_colours = (Eigen::MatrixXd::Random(4, 8).array() + 1) / 2;
  WriteMesh(Path("a.obj"), soup_.vertices, soup_);
  const Soup read = ReadSoup(Path("a.obj"));
  EXPECT_EQ(read.vertices, soup_.vertices);
  EXPECT_EQ(read.polygon_begin, soup_.polygon_begin);
  EXPECT_EQ(read.corners, soup_.corners);
  EXPECT_EQ(read.segments, soup_.segments);
  testing::ExpectSame(read.appearance, appearance);
  EXPECT_TRUE(read.dropped.empty());

  WriteMesh(Path("b.obj"), read.vertices, read);
  EXPECT_EQ(testing::Content(Path("b.obj")), testing::Content(Path("a.obj")));
}

// Every double is reproduced exactly; frames rely on that.
TEST_F(WriteTest, ObjKeepsEveryBitOfEveryNumber) {
  Soup soup;
  soup.vertices.resize(3, 20000);
  std::mt19937_64 random(11);
  for (double& x : soup.vertices.reshaped()) {
    do {
      const std::uint64_t bits = random();
      std::memcpy(&x, &bits, sizeof x);
    } while (!std::isfinite(x));
  }
  using Limits = std::numeric_limits<double>;
  soup.vertices.leftCols(3) << 4e6 + 0.1, Limits::denorm_min(), -0.0,  //
      std::nextafter(1, 2), Limits::max(), 3 * Limits::denorm_min(),   //
      Limits::lowest(), Limits::min(), std::nextafter(4e6, 5e6);
  soup.segments = {{0, 1}};
  WriteMesh(Path("a.obj"), soup.vertices, soup);
  const Shape read = ReadSoup(Path("a.obj")).vertices;
  ASSERT_EQ(read.cols(), soup.vertices.cols());
  EXPECT_EQ(std::memcmp(read.data(), soup.vertices.data(), sizeof(double) * read.size()), 0);
}

TEST_F(WriteTest, RefusesAnAppearanceOfAnotherMesh) {
  const auto expect_refused = [&](const std::function<void(Appearance*)>& change,
                                  const std::string& part) {
    Soup soup = soup_;
    change(&soup.appearance);
    ExpectError<MeshError>([&] { WriteMesh(Path("never.obj"), soup.vertices, soup); },
                           {"never.obj: ", part});
  };
  using A = Appearance;
  expect_refused([](A* a) { a->texture_coordinates.setZero(2, 3); }, "both be there");
  expect_refused(
      [](A* a) {
        a->texture_coordinates.setZero(2, 3);
        a->corner_texture.assign(24, 3);
      },
      "texture coordinates of corners: index 3 is not in -1 .. 2");
  expect_refused(
      [](A* a) {
        a->texture_coordinates.setZero(2, 3);
        a->corner_texture.assign(23, 0);
      },
      "texture coordinates of corners: given 23 times, the mesh has 24");
  expect_refused(
      [](A* a) {
        a->materials = {{"a"}, {0, 0, 0, 0, 0, 1}};
      },
      "materials of polygons: index 1");
  expect_refused([](A* a) { a->groups = {{"a"}, {0}}; }, "groups of polygons: given 1 times");
  expect_refused([](A* a) { a->objects = {{"a\nb"}, {0, 0, 0, 0, 0, 0}}; }, "'a?b'");
  expect_refused([](A* a) { a->vertex_colours.setZero(3, 7); }, "3 x 7 instead of 3 or 4 x 8");
  expect_refused([](A* a) { a->vertex_colours.setConstant(3, 8, 1.5); }, "not in 0 .. 1");
  EXPECT_FALSE(std::filesystem::exists(Path("never.obj")));
}

TEST_F(WriteTest, LongPolygonsAndPureGraphsSurvivePly) {
  // Of 130 corners there are 260 texture coordinates.
  for (const int corners : {130, 300}) {
    Soup soup;
    soup.vertices = Shape::Random(3, 400);
    for (int v = 0; v < corners; ++v) soup.corners.push_back(v);
    soup.polygon_begin = {0, corners};
    soup.appearance.texture_coordinates = Eigen::Matrix2Xd::Identity(2, 400);
    soup.appearance.corner_texture = soup.corners;
    WriteMesh(Path("long.ply"), soup.vertices, soup);
    EXPECT_EQ(ReadSoup(Path("long.ply")).corners, soup.corners);
    EXPECT_EQ(ReadSoup(Path("long.ply")).appearance.corner_texture.size(), soup.corners.size());
  }

  Soup graph;
  graph.vertices = Shape::Random(3, 3);
  graph.segments = {{0, 1}, {1, 2}};
  WriteMesh(Path("graph.ply"), graph.vertices, graph);
  EXPECT_EQ(ReadSoup(Path("graph.ply")).segments, graph.segments);
  EXPECT_EQ(ReadSoup(Path("graph.ply")).NumPolygons(), 0);
}

TEST_F(WriteTest, OffIsExact) {
  soup_.segments.clear();
  WriteMesh(Path("a.off"), soup_.vertices, soup_);
  const Soup read = ReadSoup(Path("a.off"));
  EXPECT_EQ(read.vertices, soup_.vertices);
  EXPECT_EQ(read.polygon_begin, soup_.polygon_begin);
  EXPECT_EQ(read.corners, soup_.corners);
}

// A polygon with a notch that points in another direction in each frame, so that frames would be
// cut into different triangles if each were cut alone.
TEST_F(WriteTest, StlFramesHaveTheSameTriangles) {
  Shape first(3, 5), last(3, 5);
  first << 0, 1, 2, 2, 0, 0, 0.9, 0, 2, 2, 0, 0, 0, 0, 0;
  last << 0, 1, 2, 2, 0, 0, 0, 0, 2, 2, 0, 0, 0, 0, 0;
  last.col(4) << 1.1, 1, 0;
  Soup soup = testing::MakeSoup(first, {{0, 1, 2, 3, 4}});
  soup.triangles = Triangulate(soup.polygon_begin, soup.corners, {first, last});
  WriteMesh(Path("0.stl"), first, soup);
  WriteMesh(Path("1.stl"), last, soup);
  const Poses poses = ReadPoses({Path("0.stl"), Path("1.stl")});
  EXPECT_EQ(poses.soup.NumPolygons(), 3);
  soup.triangles.resize(3, 0);
  WriteMesh(Path("alone.stl"), last, soup);
  EXPECT_NE(ReadSoup(Path("alone.stl")).corners, poses.soup.corners);
}

TEST_F(WriteTest, StlIsRefusedWhereSinglePrecisionIsTooCoarse) {
  const Shape cube = testing::Cube().vertices;
  soup_.segments.clear();
  // A cube whose corners are no round numbers, at some distances and in some units.
  const auto write = [&](double unit, double distance) {
    WriteMesh(Path("a.stl"), unit * ((cube / 3).array() + distance), soup_);
  };
  for (const double unit : {1.0, 1e-20, 1e20}) {
    EXPECT_NO_THROW(write(unit, 100)) << unit;
    ExpectError<MeshError>([&] { write(unit, 1e5); }, {"a.stl", "single precision", "origin"});
  }
  ExpectError<MeshError>([&] { write(1e40, 0); }, {"a.stl", "choose another unit"});
  ExpectError<MeshError>([&] { write(1e-50, 0); }, {"a.stl", "choose another unit"});
}

TEST_F(WriteTest, OffAndStlTellWhatTheyCannotStore) {
  soup_.appearance.vertex_colours.setOnes(3, 8);
  soup_.appearance.groups = {{"head"}, std::vector<int>(6, 0)};
  for (const char* file : {"a.off", "a.stl"}) {
    EXPECT_EQ(
        NotKept(file, soup_),
        (std::vector<std::string>{"groups, vertex colours, segments are dropped; OBJ keeps them"}));
    Soup graph;
    graph.vertices = soup_.vertices;
    graph.segments = soup_.segments;
    ExpectError<MeshError>([&] { WriteMesh(Path(file), graph.vertices, graph); },
                           {file, "no polygons", "write .obj or .ply"});
  }
}

TEST_F(WriteTest, RefusesAndLeavesTheOldFileAlone) {
  const std::string old = File("old.obj", "v 0 0 0\n");
  Shape broken = soup_.vertices;
  broken(1, 4) = std::nan("");
  ExpectError<MeshError>([&] { WriteMesh(old, broken, soup_); },
                         {"old.obj: vertex 5", "not a finite number"});
  ExpectError<MeshError>([&] { WriteMesh(old, Shape::Zero(3, 7), soup_); },
                         {"old.obj: 7 vertices", "of 8"});
  EXPECT_EQ(testing::Content(old), "v 0 0 0\n");
  ExpectError<FileError>([&] { WriteMesh(Path("a.dae"), soup_.vertices, soup_); },
                         {"a.dae", "'.dae' is not one of .obj, .ply, .off, .stl"});
  ExpectError<FileError>([&] { WriteMesh(old + "/a.obj", soup_.vertices, soup_); }, {"a.obj"});
}

}  // namespace
}  // namespace shapespace
