#include <shapespace/files/vertex_field.h>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>

#include "mesh/files.h"

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

}  // namespace
}  // namespace shapespace
