#include <fstream>
#include <sstream>

#include <shapespace/base/error.h>
#include <shapespace/files/read.h>
#include <shapespace/mesh/different_meshes.h>

#include "mesh/files.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

using testing::ExpectError;

class PosesTest : public testing::FilesTest {
 protected:
  const std::string square_ = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n";
  const std::string bent_ = "v 0 0 0\nv 1 0 .1\nv 1 1 0\nv 0 1 .1\nf 1 2 3 4\n";
  const std::string book_ =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 -1 0\nv 0 0 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n";
};

TEST_F(PosesTest, ReadsPosesWithSegmentsAndStiffeners) {
  ReadOptions options;
  options.stiffeners = File("stiff.txt", "# across\n1 3\n\n4 2 # and back\n5 1\n");
  const std::vector<std::string> files = {File("a.obj", square_ + "v 5 5 5\nl 4 5\n"),
                                          File("b.obj", bent_ + "v 5 5 6\nl 4 5\n")};
  const Poses poses = ReadPoses(files, options);
  EXPECT_EQ(poses.names, files);
  ASSERT_EQ(poses.shapes.size(), 2u);
  EXPECT_EQ(poses.shapes[0](2, 4), 5.0);
  EXPECT_EQ(poses.shapes[1](2, 4), 6.0);
  EXPECT_EQ(poses.soup.vertices, poses.shapes[0]);
  EXPECT_EQ(poses.connectivity->NumPolygons(), 1);
  // Four sides and two diagonals of the square, the segment, one stiffener that is neither.
  EXPECT_EQ(poses.connectivity->NumEdges(), 8);
  EXPECT_TRUE(poses.warnings.empty());
}

TEST_F(PosesTest, OneFileIsEnoughAndNoneIsNot) {
  EXPECT_EQ(ReadPoses({File("a.obj", square_)}).shapes.size(), 1u);
  ExpectError<FileError>([] { ReadPoses({}); }, {"no mesh file"});
}

TEST_F(PosesTest, NonManifoldMeshesNeedPermission) {
  const std::vector<std::string> files = {File("book.obj", book_), File("again.obj", book_)};
  ExpectError<MeshError>([&] { ReadPoses(files); },
                         {"book.obj", "edge 1-2", "line 6", "or allow it"});
  ReadOptions options;
  options.allow_nonmanifold = true;
  const Poses poses = ReadPoses(files, options);
  EXPECT_EQ(poses.connectivity->NumTriangles(), 3);
  ASSERT_EQ(poses.warnings.size(), 1u);  // said once, not for every pose
  EXPECT_NE(poses.warnings[0].find("book.obj: edges with more than two polygons"),
            std::string::npos);
}

TEST_F(PosesTest, WarningsAboutPositionsNameTheirPose) {
  const std::string folded = "v 0 0 0\nv 1 0 0\nv 1 0 0\nv 0 0 0\nf 1 2 3 4\n";
  const Poses poses = ReadPoses({File("a.obj", square_), File("flat.obj", folded)});
  ASSERT_EQ(poses.warnings.size(), 2u);
  EXPECT_NE(poses.warnings[0].find("flat.obj: edges whose two ends"), std::string::npos);
  EXPECT_NE(poses.warnings[1].find("flat.obj: polygons without area (1)"), std::string::npos);
}

TEST_F(PosesTest, OtherMeshesAreRefused) {
  ExpectError<MismatchError>(
      [&] {
        ReadPoses({File("a.obj", square_), File("b.obj", book_)});
      },
      {"b.obj", "against", "a.obj", "5 vertices instead of 4", "Correspond"});
  std::string other = square_;
  other.replace(other.find("1 2 3 4"), 7, "1 3 2 4");
  ExpectError<MismatchError>(
      [&] {
        ReadPoses({File("a.obj", square_), File("c.obj", other)});
      },
      {"c.obj", "polygon 1 (line 5) with vertices 1 3 2 4", "polygon 1 (line 5) with 1 2 3 4"});
}

// These have a remedy of their own, which is not said of poses that only need to be exported again.
TEST_F(PosesTest, DifferentMeshesAreToldFromMeshesThatAreCutOtherwise) {
  const std::string a = File("a.obj", square_), b = File("b.obj", book_);
  std::string cut = square_;
  cut.replace(cut.find("f 1 2 3 4"), 9, "f 1 2 3\nf 1 3 4");
  const std::string c = File("c.obj", cut);
  try {
    ReadPoses({a, b});
    ADD_FAILURE() << "nothing was thrown";
  } catch (const DifferentMeshes& error) {
    EXPECT_EQ(error.first(), a);
    EXPECT_EQ(error.second(), b);
    const std::string message = error.MessageWith("another name");
    EXPECT_TRUE(testing::Names(message, {"5 vertices instead of 4", "another name"}));
    EXPECT_FALSE(testing::HasWord(message, "Correspond"));
  }
  const std::string message = testing::MessageOf<MismatchError>([&] { ReadPoses({a, c}); });
  EXPECT_TRUE(testing::Names(message, {"diagonals"}));
  EXPECT_FALSE(testing::HasWord(message, "Correspond"));
}

TEST_F(PosesTest, MirrorImagesAreTurnedBackIfAsked) {
  const std::string faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  const std::vector<std::string> files = {
      File("a.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" + faces),
      File("b.obj", "v 0 0 0\nv 2 0 0\nv 0 1 0\nv 0 0 1\n" + faces),
      File("c.obj", "v 0 0 0\nv 1 0 0\nv 0 -1 0\nv 0 0 1\n" + faces)};
  ExpectError<MismatchError>([&] { ReadPoses(files); }, {"c.obj", "mirror image"});
  ReadOptions options;
  options.mirror = 'y';
  const Poses poses = ReadPoses(files, options);
  EXPECT_EQ(poses.shapes[1](0, 1), 2.0);
  EXPECT_EQ(poses.shapes[2](1, 2), 1.0);
  ASSERT_EQ(poses.warnings.size(), 1u);
  EXPECT_NE(poses.warnings[0].find("c.obj: is a mirror image"), std::string::npos);
  options.mirror = 'w';
  ExpectError<InvalidOptions>([&] { ReadPoses(files, options); }, {"mirror: 'w'"});
}

TEST_F(PosesTest, PosesInOtherUnitsAreRefusedUnlessAllowed) {
  const std::string faces = "f 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n";
  const std::vector<std::string> files = {
      File("m.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n" + faces),
      File("mm.obj", "v 0 0 0\nv 1000 0 0\nv 0 1000 0\nv 0 0 1000\n" + faces)};
  ExpectError<MismatchError>([&] { ReadPoses(files); }, {"mm.obj", "1e+03", "allow_mismatch"});
  ReadOptions options;
  options.allow_mismatch = true;
  const Poses poses = ReadPoses(files, options);
  EXPECT_EQ(poses.shapes[1](0, 1), 1000.0);
  EXPECT_EQ(poses.warnings.size(), 1u);
}

TEST_F(PosesTest, ConcavePolygonsAreCutAsTheMeanOfThePosesSuits) {
  // A dart with its tip at vertex 2: only the diagonal 2-4 lies inside.
  const std::string dart = "v 0 0 0\nv 2 0.5 0\nv 0 1 0\nv 0.5 0.5 0\nf 1 2 3 4\n";
  const Poses poses = ReadPoses({File("a.obj", dart), File("b.obj", dart)});
  for (int f = 0; f < 2; ++f) {
    const Eigen::Vector3i t = poses.connectivity->Triangles().col(f);
    EXPECT_TRUE((t.array() == 1).any() && (t.array() == 3).any()) << t.transpose();
  }
}

TEST_F(PosesTest, StiffenersAreReadStrictly) {
  auto refused = [&](const std::string& content, const std::vector<std::string>& parts) {
    ExpectError<FileError>([&] { ReadStiffeners(File("stiff.txt", content), 10); }, parts);
  };
  refused("1 2\n3\n", {"stiff.txt:2: stiffener 2", "a line holds two"});
  refused("1 2 3\n", {"stiff.txt:1: stiffener 1: '3' is too much"});
  refused("0 2\n", {"stiff.txt:1: stiffener 1: '0' is not a vertex number from 1 to 10",
                    "the first vertex has the number 1"});
  refused("1 11\n", {"stiff.txt:1: stiffener 1: '11'"});
  refused("1 2.5\n", {"stiff.txt:1: stiffener 1: '2.5'"});
  refused("4 4\n", {"stiff.txt:1: stiffener 1: joins vertex 4 to itself"});
  ExpectError<FileError>([&] { ReadStiffeners(Path("none.txt"), 10); }, {"none.txt"});
  EXPECT_EQ(ReadStiffeners(File("good.txt", "10 1\r\n2 3"), 10),
            (std::vector<std::pair<int, int>>{{9, 0}, {1, 2}}));
}

TEST_F(PosesTest, StreamsSayWhatFilesSay) {
  const std::string off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const std::string ply =
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty double x\nproperty double y\n"
      "property double z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n"
      "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  const std::pair<std::string, MeshFormat> meshes[] = {
      {square_, MeshFormat::kObj}, {off, MeshFormat::kOff}, {ply, MeshFormat::kPly}};
  const char* const names[] = {"a.obj", "a.off", "a.ply"};
  for (int i = 0; i < 3; ++i) {
    const auto& [text, format] = meshes[i];
    const Soup expected = ReadSoup(File(names[i], text));
    std::istringstream stream("before" + text);
    stream.ignore(6);
    const Soup soup = ReadSoup(stream, "socket", format);
    EXPECT_EQ(soup.file, "socket");
    EXPECT_EQ(soup.vertices, expected.vertices);
    EXPECT_EQ(soup.corners, expected.corners);
    EXPECT_EQ(soup.polygon_begin, expected.polygon_begin);
  }
}

TEST_F(PosesTest, MessagesAboutStreamsNameThem) {
  const auto read = [](const std::string& text, const std::string& name) {
    std::istringstream stream(text);
    return ReadSoup(stream, name, MeshFormat::kObj);
  };
  ExpectError<FileError>([&] { read(square_ + "f 1 2 x\n", "socket"); },
                         {"socket:6", "polygon 2", "x"});
  ExpectError<FileError>([&] { read("", "socket"); }, {"socket", "empty"});
  std::ifstream closed(File("none.obj", square_) + ".not");
  ExpectError<FileError>([&] { ReadSoup(closed, "closed", MeshFormat::kObj); }, {"closed"});
  // In Node, a folder is read as an empty file.
#ifndef __EMSCRIPTEN__
  std::ifstream folder(Path(""));  // can be opened, but not read
  ExpectError<FileError>([&] { ReadSoup(folder, "folder", MeshFormat::kObj); },
                         {"folder: cannot be read to its end"});
#endif
  ExpectError<MeshError>([&] { MakePoses({read(book_, "book")}); },
                         {"book: edges with more than two polygons", "line 6"});
  ReadOptions options;
  options.stiffeners = File("stiff.txt", "1 4\n");
  options.allow_nonmanifold = true;
  const Poses poses = MakePoses({read(book_, "book"), read(book_, "again")}, options);
  EXPECT_EQ(poses.names, (std::vector<std::string>{"book", "again"}));
  EXPECT_EQ(poses.warnings.size(), 1U);
}

}  // namespace
}  // namespace shapespace
