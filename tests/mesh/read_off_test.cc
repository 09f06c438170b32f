#include <shapespace/base/error.h>
#include <shapespace/files/read.h>

#include "mesh/files.h"

namespace shapespace {
namespace {

using testing::ExpectError;
using Ints = std::vector<int>;

class ReadOffTest : public testing::FilesTest {
 protected:
  Soup Read(const std::string& content) { return ReadSoup(File("pose.off", content)); }

  void ExpectRefused(const std::string& content, const std::vector<std::string>& parts) {
    ExpectError<FileError>([&] { Read(content); }, parts);
  }
};

TEST_F(ReadOffTest, ReadsWithCommentsAndLines) {
  const Soup soup = Read(
      "OFF # a square and a triangle\n# another comment\n4 2 0\n\n"
      "0 0 0\n1 0 0 # here\n1 1 0\n0 1 .1\n4 0 1 2 3\n3 2 1 0\n\n");
  EXPECT_EQ(soup.vertices.col(3), Eigen::Vector3d(0, 1, .1));
  EXPECT_EQ(soup.polygon_begin, (Ints{0, 4, 7}));
  EXPECT_EQ(soup.corners, (Ints{0, 1, 2, 3, 2, 1, 0}));
  EXPECT_EQ(soup.vertex_line, (Ints{5, 6, 7, 8}));
  EXPECT_EQ(soup.polygon_line, (Ints{9, 10}));
  EXPECT_TRUE(soup.dropped.empty());
}

TEST_F(ReadOffTest, HeaderVariantsGiveTheSameMesh) {
  const std::string plain = "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
  for (const std::string header : {"OFF\n3 1 0\n", "OFF 3 1 0\n", "3 1 0\n", "OFF\r\n3 1\r\n"}) {
    EXPECT_EQ(Read(header + plain).corners, (Ints{0, 1, 2})) << header;
  }
  const std::string further = "0 0 0 9 9 9\n1 0 0 9 9 9\n0 1 0 9 9 9\n3 0 1 2 255 0 0\n";
  for (const std::string keyword : {"COFF", "NOFF", "OFF", "CNOFF", "STOFF"}) {
    const Soup soup = Read(keyword + "\n3 1 3\n" + further);
    EXPECT_EQ(soup.vertices.col(2), Eigen::Vector3d(0, 1, 0));
    ASSERT_EQ(soup.dropped.size(), 2u) << keyword;
    EXPECT_NE(soup.dropped[0].find("3 vertices"), std::string::npos);
    EXPECT_EQ(soup.dropped[1], "1 polygon colours not kept");
  }
}

TEST_F(ReadOffTest, RefusesBadInput) {
  const std::string vertices = "0 0 0\n1 0 0\n0 1 0\n";
  ExpectRefused("", {"pose.off: "});
  ExpectRefused("hello\n", {"pose.off:1: ", "'hello'"});
  ExpectRefused("OFF\n-3 1 0\n", {"pose.off:2: ", "'-3'"});
  ExpectRefused("OFF\n1000000000 1 0\n" + vertices, {"pose.off:2: ", "1000000000 vertices"});
  ExpectRefused("OFF\n3 1000000000 0\n" + vertices, {"pose.off:2: ", "1000000000 polygons"});
  ExpectRefused("OFF\n3 1 0\n0 0 0\n1 nan 0\n0 1 0\n3 0 1 2\n",
                {"pose.off:4: vertex 2: coordinate y 'nan' "});
  ExpectRefused("OFF\n3 1 0\n" + vertices, {"pose.off:5: ", "polygon 1 of 1"});
  ExpectRefused("OFF\n3 1 0\n" + vertices + "3 0 1 -1\n", {"pose.off:6: polygon 1", "'-1'"});
}

}  // namespace
}  // namespace shapespace
