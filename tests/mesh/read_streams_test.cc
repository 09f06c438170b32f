#include <sstream>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/bytes.h>
#include <shapespace/files/read.h>
#include <shapespace/mesh/check.h>

#include "mesh/bodies.h"
#include "mesh/files.h"
#include "support/message_of.h"

// Streams, formats, and what is refused or mended when meshes become poses.

namespace shapespace::read_streams_test {
namespace {

using Ints = std::vector<int>;
using Strings = std::vector<std::string>;
using testing::Refuses;

class ReadStreamsTest : public testing::FilesTest {};

Soup Named(Soup soup, const std::string& file) {
  soup.file = file;
  return soup;
}

TEST_F(ReadStreamsTest, LongStreamsAreReadToTheirEnd) {
  std::string content;
  constexpr int kVertices = 20000;
  for (int v = 0; v < kVertices; ++v) content += "v " + std::to_string(v) + " 0 0.125\n";
  ASSERT_GT(content.size(), 4u << 16);
  std::istringstream stream(content + "l 1 20000\n");
  const Soup soup = ReadSoup(stream, "socket", MeshFormat::kObj);
  ASSERT_EQ(soup.NumVertices(), kVertices);
  EXPECT_EQ(soup.vertices.row(0).transpose(),
            Eigen::VectorXd::LinSpaced(kVertices, 0, kVertices - 1));
  EXPECT_EQ(soup.segment_line, Ints{kVertices + 1});
  std::istringstream again(content);  // nothing, at its end
  again.seekg(0, std::ios::end);
  EXPECT_TRUE(
      Refuses<FileError>([&] { ReadSoup(again, "socket", MeshFormat::kObj); }, {"socket:"}));
}

TEST_F(ReadStreamsTest, FormatsAreKnownByTheExtensionInAnyCase) {
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const std::string obj = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
  EXPECT_EQ(ReadSoup(File("a.Off", off)).corners, (Ints{0, 1, 2}));
  EXPECT_EQ(ReadSoup(File("a.off.OBJ", obj)).corners, (Ints{0, 1, 2}));
  EXPECT_TRUE(Refuses<FileError>(
      [] { ReadSoup("a.obj.txt"); },
      {"a.obj.txt:", "'.txt'", ".obj", ".ply", ".off", ".stl", ".glb", ".gltf", ".vtk", ".vtp"}));
}

TEST_F(ReadStreamsTest, OfSeveralMorphTargetsAllAreCounted) {
  std::string bytes;
  for (const float x : std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0})
    internal::AppendLittleEndian(x, &bytes);
  for (const float x : std::vector<float>{0, 0, 2, 0, 0, 0, 0, 0, 0})
    internal::AppendLittleEndian(x, &bytes);
  File("a.bin", bytes);
  const std::string accessor = R"("componentType":5126,"type":"VEC3","count":3,"min":[0,0,0],)"
                               R"("max":[1,1,2]})";
  const std::string file = File(
      "a.gltf",
      R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],)"
      R"("buffers":[{"byteLength":72,"uri":"a.bin"}],"bufferViews":[)"
      R"({"buffer":0,"byteOffset":0,"byteLength":36},{"buffer":0,"byteOffset":36,"byteLength":36}],)"
      R"("accessors":[{"bufferView":0,)" +
          accessor + R"(,{"bufferView":1,)" + accessor +
          R"(],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"targets":[{"POSITION":1},)"
          R"({"POSITION":1},{"POSITION":1}]}]}]})");
  const std::vector<Soup> soups = ReadSoups(file);
  ASSERT_EQ(soups.size(), 4u);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(soups[i].name, i == 0 ? "" : "target " + std::to_string(i));
    EXPECT_EQ(soups[i].vertices(2, 0), i == 0 ? 0 : 2);
  }
  EXPECT_EQ(ReadSoup(file).dropped, Strings{"3 morph targets not read, since one mesh is wanted"});
  const Poses poses = ReadPoses({file});
  EXPECT_EQ(poses.names, (Strings{file, "target 1", "target 2", "target 3"}));
}

/// The corners 0 and 1 twice in a polygon, a polygon repeated, an edge of three polygons, edges
/// that are wound alike and vertices at which parts touch.
Soup Tangle() {
  Soup soup = testing::MakeSoup(Shape::Random(3, 8),
                                {{0, 1, 2}, {0, 1, 2}, {0, 1, 3}, {4, 5, 4, 6}, {0, 7, 5}});
  return Named(std::move(soup), "tangle.obj");
}

TEST_F(ReadStreamsTest, ThreeOfManyFatalFindingsAreReported) {
  int fatal = 0, told = 0;
  for (const Finding& finding : CheckSoup(Tangle())) {
    fatal += finding.severity == Severity::kNonManifold;
    told += finding.severity != Severity::kNote;
  }
  ASSERT_GT(fatal, 3);
  try {
    MakePoses({Tangle()});
    ADD_FAILURE();
  } catch (const MeshError& error) {
    std::istringstream lines(error.what());
    std::string line;
    int count = 0;
    for (; std::getline(lines, line); ++count) EXPECT_EQ(line.find("tangle.obj: "), 0u) << line;
    EXPECT_EQ(count, 3);
    EXPECT_EQ(error.option(), "allow_nonmanifold");
  }
  ReadOptions options;
  options.allow_nonmanifold = true;
  EXPECT_EQ(MakePoses({Tangle()}, options).warnings.size(), static_cast<size_t>(told));
}

// Allowing what one of the findings says would leave the other one.
TEST_F(ReadStreamsTest, AnOptionIsNamedOnlyIfNothingElseIsRefused) {
  Soup soup = testing::MakeSoup(Shape::Random(3, 5), {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}});
  const auto option = [&] {
    try {
      MakePoses({soup});
    } catch (const MeshError& error) {
      return error.option();
    }
    return std::string("nothing was thrown");
  };
  EXPECT_EQ(option(), "allow_nonmanifold");
  soup.segments = {{2, 2}};
  EXPECT_EQ(option(), "");
}

TEST_F(ReadStreamsTest, ThePoseTheReferenceAndTheAxisOfAMirrorImageAreNamed) {
  const Soup cube = testing::Cube();
  for (const char axis : {'x', 'y', 'z'}) {
    Soup mirrored = cube;
    mirrored.vertices.row(1) *= -1;
    mirrored.vertices.row(2) *= 3;
    Shape expected = mirrored.vertices;
    expected.row(axis - 'x') *= -1;
    Soup pose = mirrored;
    EXPECT_TRUE(MirrorBack(cube, axis, &pose));
    EXPECT_EQ(pose.vertices, expected);
    ReadOptions options;
    options.mirror = axis;
    const Poses poses =
        MakePoses({Named(cube, "a.obj"), Named(cube, "b.obj"), Named(mirrored, "c.obj")}, options);
    EXPECT_EQ(poses.shapes[1], cube.vertices);
    EXPECT_EQ(poses.shapes[2], expected);
    EXPECT_EQ(poses.warnings, Strings{std::string("c.obj: is a mirror image of a.obj; its ") +
                                      axis + " has changed sign"});
  }
  Soup same = cube;
  EXPECT_FALSE(MirrorBack(cube, 'x', &same));
  EXPECT_EQ(same.vertices, cube.vertices);
  Soup more = cube;
  more.vertices.conservativeResize(3, 9);
  EXPECT_FALSE(MirrorBack(cube, 'x', &more));
  for (const char axis : {'w', '{', 'X'}) {
    EXPECT_TRUE(Refuses<InvalidOptions>([&] { MirrorBack(cube, axis, &same); },
                                        {"mirror:", std::string(1, axis)}));
  }
}

TEST_F(ReadStreamsTest, StiffenersSayWhatIsWrong) {
  const auto refused = [&](const std::string& content, std::vector<std::string> parts) {
    const std::string file = File("s.txt", content);
    parts.front() = file + parts.front();
    EXPECT_TRUE(Refuses<FileError>([&] { ReadStiffeners(file, 7); }, parts));
  };
  refused("# pairs\n1 2\n\n3 4 # good\n5 8\n", {":5:", "stiffener 3", "'8'", "1", "7"});
  refused("7 1\n2\n", {":2:", "stiffener 2", "''", "1", "7"});
  refused("7 1\n2 3 4\n", {":2:", "stiffener 2", "'4'"});
  refused("7 1\n3 3\n", {":2:", "stiffener 2", "vertex 3"});
}

TEST_F(ReadStreamsTest, ElementsOfPosesMustBeThere) {
  EXPECT_TRUE(Refuses<FileError>([] { ReadPoses({}); }, {"mesh file"}));
  EXPECT_TRUE(Refuses<MeshError>([] { MakePoses({}); }, {"pose"}));
}

}  // namespace
}  // namespace shapespace::read_streams_test
