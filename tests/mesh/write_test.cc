#include <cmath>
#include <random>

#include <shapespace/base/error.h>
#include <shapespace/mesh/read.h>
#include <shapespace/mesh/write.h>

#include "mesh/bodies.h"
#include "mesh/files.h"

namespace shapespace {
namespace {

using testing::ExpectError;

class WriteTest : public testing::FilesTest {
 protected:
  WriteTest() : soup_(testing::Cube()) {
    // Numbers of all magnitudes, so that a lost digit shows.
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

TEST_F(WriteTest, ObjKeepsNineDigitsAndTheAppearance) {
  soup_.texture_coordinates = Eigen::Matrix2Xd::Random(2, 5);
  for (size_t k = 0; k < soup_.corners.size(); ++k) {
    soup_.corner_texture.push_back(static_cast<int>(k) % 6 - 1);
  }
  soup_.material_libraries = {"one.mtl", "two words.mtl"};
  soup_.polygon_material = {"", "a", "a", "b", "a b", "a"};
  WriteMesh(Path("a.obj"), soup_.vertices, soup_);
  const Soup read = ReadSoup(Path("a.obj"));
  EXPECT_LE(((read.vertices - soup_.vertices).array() / soup_.vertices.array()).abs().maxCoeff(),
            5.1e-9);
  EXPECT_EQ(read.polygon_begin, soup_.polygon_begin);
  EXPECT_EQ(read.corners, soup_.corners);
  EXPECT_EQ(read.segments, soup_.segments);
  EXPECT_LE((read.texture_coordinates - soup_.texture_coordinates).cwiseAbs().maxCoeff(), 1e-9);
  EXPECT_EQ(read.corner_texture, soup_.corner_texture);
  EXPECT_EQ(read.material_libraries, soup_.material_libraries);
  EXPECT_EQ(read.polygon_material, soup_.polygon_material);

  WriteMesh(Path("b.obj"), read.vertices, read);
  EXPECT_EQ(testing::Content(Path("b.obj")), testing::Content(Path("a.obj")));
}

TEST_F(WriteTest, LongPolygonsAndPureGraphsSurvivePly) {
  Soup soup;
  soup.vertices = Shape::Random(3, 400);
  for (int v = 0; v < 300; ++v) soup.corners.push_back(v);
  soup.polygon_begin = {0, 300};
  WriteMesh(Path("long.ply"), soup.vertices, soup);
  EXPECT_EQ(ReadSoup(Path("long.ply")).corners, soup.corners);

  Soup graph;
  graph.vertices = Shape::Random(3, 3);
  graph.segments = {{0, 1}, {1, 2}};
  WriteMesh(Path("graph.ply"), graph.vertices, graph);
  EXPECT_EQ(ReadSoup(Path("graph.ply")).segments, graph.segments);
  EXPECT_EQ(ReadSoup(Path("graph.ply")).NumPolygons(), 0);
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
  ExpectError<FileError>([&] { WriteMesh(Path("a.stl"), soup_.vertices, soup_); },
                         {"a.stl", "'.stl' is neither .obj nor .ply"});
  ExpectError<FileError>([&] { WriteMesh(old + "/a.obj", soup_.vertices, soup_); }, {"a.obj"});
}

}  // namespace
}  // namespace shapespace
