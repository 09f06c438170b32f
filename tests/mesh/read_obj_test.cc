#include <shapespace/base/error.h>
#include <shapespace/files/read.h>

#include "mesh/files.h"

namespace shapespace {
namespace {

using testing::ExpectError;
using Ints = std::vector<int>;

class ReadObjTest : public testing::FilesTest {
 protected:
  Soup Read(const std::string& content) { return ReadSoup(File("pose.obj", content)); }

  void ExpectRefused(const std::string& content, const std::vector<std::string>& parts) {
    ExpectError<FileError>([&] { Read(content); }, parts);
  }
};

constexpr char kThree[] = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST_F(ReadObjTest, KeepsOrderPolygonsAndLines) {
  const Soup soup = Read(
      "# a comment\n"
      "v 1.5 -2e-3 +.25\n\n"
      "v 1 0 0\nv 1 1 0\nv 0 1 0 # behind an element\nv 2 2 2\n"
      "f 1 2 3 4 5\n"
      "f 3 2 1\n"
      "l 1 2 5\n");
  EXPECT_EQ(soup.file, Path("pose.obj"));
  ASSERT_EQ(soup.NumVertices(), 5);
  EXPECT_EQ(soup.vertices.col(0), Eigen::Vector3d(1.5, -2e-3, .25));
  EXPECT_EQ(soup.vertices.col(4), Eigen::Vector3d(2, 2, 2));
  EXPECT_EQ(soup.polygon_begin, (Ints{0, 5, 8}));
  EXPECT_EQ(soup.corners, (Ints{0, 1, 2, 3, 4, 2, 1, 0}));
  EXPECT_EQ(soup.segments, (std::vector<std::pair<int, int>>{{0, 1}, {1, 4}}));
  EXPECT_EQ(soup.vertex_line, (Ints{2, 4, 5, 6, 7}));
  EXPECT_EQ(soup.polygon_line, (Ints{8, 9}));
  EXPECT_EQ(soup.segment_line, (Ints{10, 10}));
  EXPECT_TRUE(soup.appearance.corner_texture.empty());
  EXPECT_TRUE(soup.appearance.materials.of_polygon.empty());
  EXPECT_TRUE(soup.dropped.empty());
}

TEST_F(ReadObjTest, NegativeIndicesCountFromTheLastVertexSoFar) {
  const Soup soup = Read(std::string(kThree) + "f -3 -2 -1\nv 5 5 5\nf -1 -2 1\nl -1 -4\n");
  EXPECT_EQ(soup.corners, (Ints{0, 1, 2, 3, 2, 0}));
  EXPECT_EQ(soup.segments, (std::vector<std::pair<int, int>>{{3, 0}}));
}

TEST_F(ReadObjTest, ContinuedLinesAndOtherLineEnds) {
  for (const std::string end : {"\n", "\r\n", "\r"}) {
    std::string content = "\xEF\xBB\xBFv 0 0 0@v 1 0 0@v 1 1 0@v 0 1 0@f 1 2 \\@ 3 4@f 1 2 3";
    for (size_t at; (at = content.find('@')) != std::string::npos;) content.replace(at, 1, end);
    const Soup soup = Read(content);
    EXPECT_EQ(soup.corners, (Ints{0, 1, 2, 3, 0, 1, 2}));
    EXPECT_EQ(soup.polygon_line, (Ints{5, 7}));
  }
}

TEST_F(ReadObjTest, PolygonsOfAnySize) {
  std::string content, polygon = "f";
  for (int i = 0; i < 300; ++i) {
    content += "v " + std::to_string(i) + " 0 0\n";
    polygon += " " + std::to_string(i + 1);
  }
  EXPECT_EQ(Read(content + polygon + "\n").polygon_begin, (Ints{0, 300}));
}

TEST_F(ReadObjTest, AppearanceIsKept) {
  const Soup soup = Read("mtllib my things.mtl\n" + std::string(kThree) +
                         "vt 0 0\nvt 1 .5\nvt 0 1 0\nvn 0 0 1\nf 1 2 3\n"
                         "usemtl red paint \nf 1/1 2/2 3/3\nf 1/-1/1 2//1 3/1/1\n");
  EXPECT_EQ(soup.appearance.material_libraries, std::vector<std::string>{"my things.mtl"});
  EXPECT_EQ(soup.appearance.materials.names, std::vector<std::string>{"red paint"});
  EXPECT_EQ(soup.appearance.materials.of_polygon, (Ints{-1, 0, 0}));
  ASSERT_EQ(soup.appearance.texture_coordinates.cols(), 3);
  EXPECT_EQ(soup.appearance.texture_coordinates.col(1), Eigen::Vector2d(1, .5));
  EXPECT_EQ(soup.appearance.corner_texture, (Ints{-1, -1, -1, 0, 1, 2, 2, -1, 0}));
  ASSERT_EQ(soup.dropped.size(), 1u);
  EXPECT_EQ(soup.dropped[0], "1 normals (vn) not kept");
}

TEST_F(ReadObjTest, NamesOfPolygonsAreKept) {
  const Soup soup = Read("o body\n" + std::string(kThree) +
                         "g left upper\nf 1 2 3\ng\nf 1 2 3\ng right\no other\nf 1 2 3\n"
                         "g left upper\nf 1 2 3\n");
  EXPECT_EQ(soup.appearance.groups.names, (std::vector<std::string>{"left upper", "right"}));
  EXPECT_EQ(soup.appearance.groups.of_polygon, (Ints{0, -1, 1, 0}));
  EXPECT_EQ(soup.appearance.objects.names, (std::vector<std::string>{"body", "other"}));
  EXPECT_EQ(soup.appearance.objects.of_polygon, (Ints{0, 0, 1, 1}));
  EXPECT_TRUE(soup.dropped.empty());
}

TEST_F(ReadObjTest, VertexColoursAreKeptWhereTheyAreColours) {
  const Soup soup =
      Read("v 0 0 0\nv 1 0 0 1 0 .25\nv 0 1 0 2\nv 1 1 0 .1 .2 .3 .4\nv 2 2 2\nf 1 2 3\n");
  Eigen::MatrixXd expected(4, 5);
  expected << 1, 1, 1, .1, 1, 1, 0, 1, .2, 1, 1, .25, 1, .3, 1, 1, 1, 1, .4, 1;
  EXPECT_EQ(soup.appearance.vertex_colours, expected);
  EXPECT_EQ(Read("v 0 0 0 .1 .2 .3\nv 1 0 0 1 0 0\nl 1 2\n").appearance.vertex_colours,
            (Eigen::MatrixXd(3, 2) << .1, 1, .2, 0, .3, 0).finished());
  const Soup bytes = Read("v 0 0 0 255 128 0\nv 1 0 0\nl 1 2\n");
  EXPECT_EQ(bytes.appearance.vertex_colours.size(), 0);
  EXPECT_EQ(bytes.dropped, std::vector<std::string>{
                               "1 vertex colours (some number of them is not in 0 .. 1) not kept"});
}

TEST_F(ReadObjTest, SaysWhatItDrops) {
  const Soup soup = Read(
      "o empty\ng\no body\nv 0 0 0\nv 1 0 0 1\nv 0 1 0 2\ns off\nvt 0 0\nf 1 2 3\np 1\n"
      "wobble 3\nwobble 4\ng late\nusemtl late\n");
  std::string all;
  for (const std::string& sentence : soup.dropped) all += sentence + "\n";
  EXPECT_EQ(all,
            "1 vertex weights other than 1 not kept\n"
            "1 texture coordinates that no polygon has not kept\n"
            "1 materials (usemtl) that no polygon has not kept\n"
            "1 group names (g) that no polygon has not kept\n"
            "1 object names (o) that no polygon has not kept\n1 points (p) not kept\n"
            "1 smoothing groups (s) not kept\n"
            "2 statements 'wobble' (the first on line 11) not kept\n");
}

TEST_F(ReadObjTest, RefusesBadVertices) {
  ExpectRefused("v 0 0 0\nv 1 nan 2\n", {"pose.obj:2: vertex 2: coordinate y 'nan' "});
  ExpectRefused("v 0 0 0\nv inf 0 2\n", {"pose.obj:2: vertex 2: coordinate x 'inf' "});
  ExpectRefused("v 1e999 0 2\n", {"pose.obj:1: vertex 1: coordinate x '1e999' "});
  ExpectRefused("v 0 1.5x 0\n", {"pose.obj:1: vertex 1: coordinate y '1.5x' "});
  ExpectRefused("v\n", {"pose.obj:1: vertex 1: coordinate x "});
}

TEST_F(ReadObjTest, TinyNumbersAreZeroNotErrors) {
  EXPECT_EQ(Read(std::string(kThree) + "v 1e-400 -0.0 1e-310\nf 1 2 4\n").vertices(0, 3), 0.0);
}

TEST_F(ReadObjTest, RefusesBadPolygons) {
  const std::string three = kThree;
  ExpectRefused(three + "f\n", {"pose.obj:4: polygon 1: 0 "});
  ExpectRefused(three + "f 1 2 99999999999\n", {"pose.obj:4: polygon 1: ", "99999999999"});
  ExpectRefused(three + "f 1 2 3 trailing\n", {"pose.obj:4: polygon 1: corner 'trailing'"});
  ExpectRefused(three + "f 1 2", {"pose.obj:4: polygon 1: 2 "});  // a cut last line
}

TEST_F(ReadObjTest, RefusesWhatIsNoMesh) {
  ExpectRefused("", {"pose.obj: "});
  ExpectRefused("# nothing but a comment\n", {"pose.obj: ", "vertex"});
  ExpectError<FileError>([&] { ReadSoup(Path("none.obj")); }, {"none.obj: ", "No such file"});
  std::filesystem::create_directory(Path("folder.obj"));
  ExpectError<FileError>([&] { ReadSoup(Path("folder.obj")); }, {"folder.obj: ", "folder"});
  ExpectError<FileError>([&] { ReadSoup(File("a.dae", "<xml>")); },
                         {"a.dae", "'.dae'", ".obj, .ply, .off, .stl, .glb, .gltf"});
}

}  // namespace
}  // namespace shapespace
