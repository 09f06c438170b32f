#include <shapespace/files/vertex_field.h>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>

#include "mesh/files.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

using testing::ExpectError;

class VertexFieldTest : public testing::FilesTest {};

TEST_F(VertexFieldTest, ReadsTextLineByLine) {
  const std::string file = File("field.txt", "\xEF\xBB\xBF# bone\n1\r\n\n2.5 # joint\n1e-3");
  EXPECT_EQ(ReadVertexField(file), Eigen::Vector3d(1, 2.5, 1e-3));
}

TEST_F(VertexFieldTest, ReadsAPropertyOfAPlyFile) {
  const std::string file = File("body.ply",
                                "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                                "property float y\nproperty int stiff\nproperty float z\n"
                                "element face 1\nproperty list uchar int vertex_indices\n"
                                "end_header\n0 0 5 9\n1 0 6 9\n0 1 7 9\n3 0 1 2\n");
  EXPECT_EQ(ReadVertexField(file + ":stiff"), Eigen::Vector3d(5, 6, 7));
  EXPECT_EQ(ReadVertexField(file + ":x"), Eigen::Vector3d(0, 1, 0));
  ExpectError<FileError>([&] { ReadVertexField(file + ":soft"); }, {file, "soft"});
  ExpectError<FileError>([&] { ReadVertexField(file + ":"); }, {file, "property"});
  ExpectError<FileError>([&] { ReadVertexField(file); }, {file, ":name"});
}

TEST_F(VertexFieldTest, NamesTheLineOfWhatIsWrong) {
  const auto expect = [&](const std::string& content, const std::vector<std::string>& parts) {
    const std::string file = File("field.txt", content);
    ExpectError<FileError>([&] { ReadVertexField(file); }, parts);
  };
  expect("1\n\nsoft\n", {"field.txt:3", "vertex 2", "soft"});
  expect("1\nnan\n", {"field.txt:2", "vertex 2", "finite"});
  expect("1 2\n", {"field.txt:1", "vertex 1", "more than one"});
  ExpectError<FileError>([&] { ReadVertexField(Path("none.txt")); }, {"none.txt"});
}

TEST_F(VertexFieldTest, MessagesNameVertexLineAndRemedy) {
  const auto message = [](const std::string& source) {
    return testing::MessageOf<FileError>([&] { ReadVertexField(source); });
  };
  const std::string ply = File("body.ply",
                               "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                               "property float y\nproperty float z\nproperty double soft\n"
                               "property double hard\nend_header\n"
                               "0 0 9 1 nan\n1 0 9 2 5\n0 1 9 inf 6\n1 1 9 nan 7\n");
  EXPECT_TRUE(testing::Names(message(ply + ":soft"), {ply, "property soft", "vertex 3"}));
  EXPECT_TRUE(testing::Names(message(ply + ":hard"), {ply, "property hard", "vertex 1"}));
  EXPECT_TRUE(testing::Names(message(ply + ":"), {ply + "::", "property behind"}));
  EXPECT_TRUE(testing::Names(message(ply), {ply, ":name"}));
  const std::string vtk = File("body.VTK",
                               "# vtk DataFile Version 3.0\n\nASCII\nDATASET POLYDATA\n"
                               "POINTS 3 float\n0 0 0 1 0 0 0 1 0\nPOLYGONS 1 4\n3 0 1 2\n"
                               "POINT_DATA 3\nSCALARS soft double\nLOOKUP_TABLE default\n"
                               "1 nan 3\n");
  EXPECT_TRUE(testing::Names(message(vtk + ":soft"), {vtk, "property soft", "vertex 2"}));
  EXPECT_NE(message(vtk).find(vtk + ":name"), std::string::npos);
  const std::string vtp = Path("body.vtp");
  EXPECT_TRUE(testing::Names(message(vtp), {vtp, ":name"}));
  const std::string text = File("field.txt", "# bone\n1\n2 # and 3\n\n4 5\n");
  EXPECT_TRUE(testing::Names(message(text), {text + ":5:", "vertex 3"}));
}

TEST_F(VertexFieldTest, AColonInTheNameOfATextIsNoProperty) {
  EXPECT_EQ(ReadVertexField(File("a:b.txt", "4\n5\n")), Eigen::Vector2d(4, 5));
  EXPECT_EQ(ReadVertexField(File("c.txt:name", "6\n7\n")), Eigen::Vector2d(6, 7));
  EXPECT_EQ(ReadVertexField(File("none.txt", "# nothing\n\n")).size(), 0);
}

}  // namespace
}  // namespace shapespace
