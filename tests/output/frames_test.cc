#include <shapespace/output/frames.h>

#include <shapespace/base/error.h>
#include <shapespace/files/read.h>
#include <shapespace/path/path_file.h>

#include "mesh/files.h"
#include "support/path_of.h"

namespace shapespace {
namespace {

class FramesTest : public testing::FilesTest {};

// Stiffeners are edges of the metric, not of the mesh, so frames of a path file must not contain
// them.
TEST_F(FramesTest, GraphsWithStiffenersGoThroughPathFilesAsTheyWere) {
  using Pairs = std::vector<std::pair<int, int>>;
  const Pairs segments = {{0, 1}, {3, 2}, {2, 1}};
  const auto graph = Connectivity::Make(4, {0}, {}, segments, {{0, 2}, {1, 3}});
  Shape first(3, 4), last(3, 4);
  first << 0, 1, 2, 3, 0, 0, 0, 0, 0, 0, 0, 0;
  last << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, 0;
  const std::string file = Path("stick.path");
  WritePath(file, testing::PathOf(graph, {first, last}));
  const shapespace::Path read = ReadPath(file);
  EXPECT_EQ(read.metric->connectivity->NumEdges(), 5);
  EXPECT_EQ(FrameSoup(*read.metric->connectivity).segments, segments);
}

// Frames made from a path file are those made from the poses, byte for byte.
TEST_F(FramesTest, PathFilesKeepWhatFramesNeed) {
  const std::string
      head = "mtllib paint.mtl\n",
      tail =
          "vt 0 0\nvt 0.1 0\nvt 1 0\nvt 0 1\nvt 0.7 1\nvt 1 1\no page\ng left\nusemtl red\n"
          "f 1/1 2/2 5/5 4/4\ng right\nusemtl blue\nf 2/2 3 6/6 5/5\nl 3 6\n";
  const Poses poses = ReadPoses(
      {File("a.obj", head + "v 0 0 0 1 0 0\nv 1 0 0\nv 2 0 0\nv 0 1 0\nv 1 1 0\nv 2 1 0\n" + tail),
       File("b.obj", head + "v 0 0 0\nv 1 0 0\nv 2 0 1\nv 0 1 0\nv 1 1 0\nv 2 1 1\n" + tail)});
  shapespace::Path path = testing::PathOf(poses.connectivity, poses.shapes);
  path.appearance = poses.soup.appearance;
  WritePath(Path("page.path"), path);
  const shapespace::Path read = ReadPath(Path("page.path"));
  WriteFrames(Path("direct%d.obj"), path.Placed(), poses.soup);
  WriteFrames(Path("read%d.obj"), read.Placed(),
              FrameSoup(*read.metric->connectivity, read.appearance));
  for (const char* number : {"0", "1"}) {
    const std::string frame = testing::Content(Path(std::string("direct") + number + ".obj"));
    EXPECT_EQ(testing::Content(Path(std::string("read") + number + ".obj")), frame);
    EXPECT_EQ(frame.substr(frame.find("vt ")), tail);
    EXPECT_EQ(frame.find(head), 0u);
  }
}

TEST_F(FramesTest, FramesFarFromTheOriginLieWhereThePosesAre) {
  const auto triangle = Connectivity::FromTriangles(3, Eigen::Vector3i(0, 1, 2));
  Shape pose(3, 3);
  pose << 4e6 + 0.1, 4e6 + 1.3, 4e6, -4e6, -4e6 + 0.7, -4e6 + 1.1, 4e6, 4e6 + 0.9, 4e6 - 0.3;
  Shape other = pose;
  other.col(2).x() += 0.5;
  const shapespace::Path path = testing::PathOf(triangle, {pose, other});
  WriteFrames(Path("%d.obj"), path.Placed(), FrameSoup(*triangle));
  EXPECT_LT((ReadSoup(Path("0.obj")).vertices - pose).cwiseAbs().maxCoeff(), 4e-9);
  EXPECT_LT((ReadSoup(Path("1.obj")).vertices - other).cwiseAbs().maxCoeff(), 4e-9);
}

TEST_F(FramesTest, SegmentsBesidePolygonsAreKeptToo) {
  const auto flag = Connectivity::Make(5, {0, 4}, {0, 1, 2, 3}, {{3, 4}});
  const Soup plain = FrameSoup(*flag);
  EXPECT_EQ(plain.segments, (std::vector<std::pair<int, int>>{{3, 4}}));
  EXPECT_EQ(plain.corners, (std::vector<int>{0, 1, 2, 3}));
}

TEST(FrameNameTest, NumbersAreAsWideAsThePatternSays) {
  for (const auto& [pattern, name] : {std::pair{"a%d.obj", "a7.obj"},
                                      {"a%3d.obj", "a  7.obj"},
                                      {"b/%03d", "b/007"},
                                      {"%09d.x", "000000007.x"},
                                      {"%0d.x", "7.x"}}) {
    EXPECT_EQ(FrameName(pattern, 7), name);
  }
  EXPECT_EQ(FrameName("%02d.obj", 12), "12.obj");
  EXPECT_EQ(FrameName("%02d.obj", 123), "123.obj");
  for (const char* pattern : {"a.obj", "%d%d.obj", "%s.obj", "%12d.obj", "100%%d.obj", "%d%"}) {
    testing::ExpectError<FileError>(
        [&] { FrameName(pattern, 0); },
        {std::string(pattern) + ": a name for frames needs one number, as in frames/%03d.obj"});
  }
}

TEST_F(FramesTest, ColoursReplaceTheAppearanceAndAreOnePerShape) {
  const auto triangle = Connectivity::FromTriangles(3, Eigen::Vector3i(0, 1, 2));
  const Shape shape = Shape::Identity(3, 3);
  Appearance appearance;
  appearance.texture_coordinates.setRandom(2, 3);
  appearance.corner_texture = {0, 1, 2};
  appearance.material_libraries = {"a.mtl"};
  appearance.materials = {{"red"}, {0}};
  appearance.objects = {{"body"}, {0}};
  const Soup soup = FrameSoup(*triangle, appearance);
  EXPECT_EQ(soup.appearance.corner_texture, appearance.corner_texture);
  EXPECT_EQ(soup.NumVertices(), 3);
  EXPECT_EQ(soup.triangles, triangle->Triangles());
  const Eigen::MatrixXd colours = Eigen::MatrixXd::Constant(3, 3, 0.25);
  const Appearance coloured = Coloured(soup, colours).appearance;
  EXPECT_EQ(coloured.vertex_colours, colours);
  EXPECT_EQ(coloured.texture_coordinates.cols(), 0);
  EXPECT_TRUE(coloured.corner_texture.empty());
  EXPECT_TRUE(coloured.material_libraries.empty());
  EXPECT_TRUE(coloured.materials.names.empty());
  EXPECT_TRUE(coloured.materials.of_polygon.empty());
  EXPECT_EQ(coloured.objects.names, appearance.objects.names);
  testing::ExpectError<InvalidOptions>(
      [&] {
        WriteFrames(Path("%d.ply"), {shape, shape, shape}, soup, {colours, colours});
      },
      {"colours: there must be as many as shapes"});
  testing::ExpectError<FileError>([&] { WriteFrames(Path("a.ply"), {shape}, soup); },
                                  {"needs one number"});
  EXPECT_FALSE(std::filesystem::exists(Path("0.ply")));
}

}  // namespace
}  // namespace shapespace
