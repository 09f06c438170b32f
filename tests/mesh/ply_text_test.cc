#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/bytes.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/read.h>
#include <shapespace/files/vertex_field.h>

#include "mesh/files.h"
#include "support/message_of.h"

// What is said about PLY files.

namespace shapespace::ply_text_test {
namespace {

using internal::AppendLittleEndian;
using Ints = std::vector<int>;
using Strings = std::vector<std::string>;

const std::string kReexport = internal::kReexport;
const std::string kText = "ply\nformat ascii 1.0\n";
const std::string kXyz = "element vertex 3\nproperty float x\nproperty float y\nproperty float z\n";
const std::string kFaces = "element face 1\nproperty list uchar int vertex_indices\n";
const std::string kHeader = kText + kXyz + kFaces + "end_header\n";  // 9 lines
const std::string kVertices = "0 0 0\n1 0 0\n0 1 0\n";               // to line 12

class PlyTextTest : public testing::FilesTest {
 protected:
  static Soup Read(const std::string& content) {
    return testing::SoupOf(content, "m.ply", MeshFormat::kPly);
  }

  static void Refused(const std::string& content, Strings parts) {
    parts.front() = "m.ply:" + parts.front();
    EXPECT_TRUE(testing::Refuses<FileError>([&] { Read(content); }, parts)) << content;
  }
};

TEST_F(PlyTextTest, Elements) {
  Refused(kHeader + "0 0 0\n1 0 0\n\n0 y 0\n3 0 1 2\n", {"13:", "vertex 3", "'y'"});
  Refused(kHeader + "0 0 0\n1 inf 0\n0 1 0\n3 0 1 2\n", {"11:", "vertex 2", "coordinate y"});
  Refused(kHeader + "0 0 0\n1 0 0 7 8\n0 1 0\n3 0 1 2\n", {"11:", "vertex 2", "'7'"});
  Refused(kHeader + kVertices + "\n3 0 1 3\n", {"14:", "polygon 1", "index 3", "0", "2"});
  Refused(kHeader + kVertices + "3 0 1 2.5\n", {"13:", "polygon 1", "0"});
  Refused(kHeader + kVertices + "3 0 1 2147483648\n", {"13:", "polygon 1", "0"});
  Refused(kHeader + kVertices + "2 0 1\n", {"13:", "polygon 1", "2"});
  Refused(kHeader + kVertices + "3.5 0 1 2\n", {"13:", "polygon 1", "vertex_indices"});
  Refused(kHeader + kVertices + "nan 0 1 2\n", {"13:", "polygon 1", "vertex_indices"});
  Refused(kHeader + kVertices + "3 0 1 2\n\n7\n", {"15:"});
  Refused(kHeader + "0 0 0\n1 0 0\n          \n\n", {"13:", "vertex 3"});
}

TEST_F(PlyTextTest, CountsThatTheFileHasNoRoomFor) {
  // Three numbers, of two bytes each at least; the last one need not be followed by a blank.
  Refused(kText + kXyz + "end_header\n0 0 0\n1 0 0\n0 1\n", {"7:", "3", "'vertex'", "2"});
  EXPECT_EQ(Read(kText + kXyz + "end_header\n0 0 0\n1 0 0\n0 1 5").vertices.col(2),
            Eigen::Vector3d(0, 1, 5));
  Refused(kHeader + kVertices, {"12:", "1", "'face'", "0"});
  Refused(kText + kXyz + "element odd 2\nend_header\n" + kVertices, {"11:", "'odd'"});
  EXPECT_TRUE(Read(kText + kXyz + "element odd 0\nend_header\n" + kVertices).dropped.empty());
}

TEST_F(PlyTextTest, Headers) {
  Refused("plybinary\n", {"1:", "'ply'"});
  Refused(kText + "element vertex 1\n", {"3:"});
  Refused(kText + "comment\nelements vertex 1\n", {"4:", "'elements'"});
  Refused("ply\n" + kXyz + "end_header\n" + kVertices, {"6:", "'format'"});
  Refused("ply\n\nformat ASCII 1.0\n",
          {"3:", "'ASCII'", "binary_little_endian", "binary_big_endian"});
  Refused(kText + "element vertex\n", {"3:", "'vertex'", "''"});
  Refused(kText + kXyz + "element face 1\nproperty int i\nelement vertex 1\n", {"9:", "'vertex'"});
  Refused(kText + "property float x\n", {"3:", "property"});
  Refused(kText + kXyz + "property list double int i\n", {"7:", "'double'"});
  Refused(kText + kXyz + "property list quad int i\n", {"7:", "'quad'"});
  Refused(kText + kXyz + "property list int quad i\n", {"7:", "'quad'"});
  Refused(kText + kXyz + "property list int int x\n", {"7:", "'x'"});
  Refused(kText + kXyz + "element tristrips 1\nproperty list int int i\nend_header\n", {"9:"});
  EXPECT_NO_THROW(Read(kText + kXyz + "element tristrips 0\nproperty list int int i\nend_header\n" +
                       kVertices));
  Refused(kText + "element vertex 0\nproperty float x\nend_header\n", {"5:"});
  Refused(kText +
              "element vertex 1\nproperty float x\nproperty list int float y\nproperty float "
              "z\nend_header\n0 1 0 0\n",
          {"7:", "property y", "element vertex"});
  Refused(kText + "element vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
          {"6:", "element vertex", "property z"});
  const auto faces = [](const std::string& properties) {
    return kText + kXyz + "element face 1\n" + properties + "end_header\n" + kVertices +
           "3 0 1 2 3 0 1 2\n";
  };
  Refused(faces("property list int float vertex_index\n"),
          {"12:", "property vertex_index", "element face"});
  Refused(faces("property int vertex_indices\n"),
          {"12:", "property vertex_indices", "element face"});
  Refused(faces("property list int int vertex_index\nproperty list int int vertex_indices\n"),
          {"13:", "element face", "vertex_indices", "2"});
}

// Elements in another order: edges and polygons before the vertices that they name.
TEST_F(PlyTextTest, EdgesAreCheckedWhenTheVerticesAreKnown) {
  const std::string header = kText +
                             "element edge 2\nproperty int vertex2\nproperty short odd\n"
                             "property uint vertex1\n" +
                             kXyz + "end_header\n";  // 11 lines
  const Soup soup = Read(header + "0 7 2\n1 7 0\n" + kVertices);
  EXPECT_EQ(soup.segments, (std::vector<std::pair<int, int>>{{2, 0}, {0, 1}}));
  EXPECT_EQ(soup.segment_line, (Ints{12, 13}));
  EXPECT_EQ(soup.vertex_line, (Ints{14, 15, 16}));
  EXPECT_EQ(soup.dropped, Strings{"properties of element 'edge' not kept: odd"});
  Refused(header + "0 7 2\n3 7 0\n" + kVertices, {"13:", "segment 2", "index 3", "0", "2"});
  Refused(header + "0 7 2\n0 7 4\n" + kVertices, {"13:", "segment 2", "index 4", "0", "2"});
  Refused(header + "0 7 2\n0 7 -1\n" + kVertices, {"13:", "segment 2", "0"});
}

TEST_F(PlyTextTest, ColoursNeedRedGreenAndBlue) {
  const auto with = [](const Strings& properties, const std::string& more) {
    std::string content = kText + kXyz;
    for (const std::string& property : properties) content += "property " + property + "\n";
    return Read(content + "end_header\n0 0 0 " + more + "\n1 0 0 " + more + "\n0 1 0 " + more +
                "\n");
  };
  const Soup two = with({"uchar red", "uchar blue", "uchar alpha"}, "1 2 3");
  EXPECT_EQ(two.appearance.vertex_colours.size(), 0);
  EXPECT_EQ(two.dropped, Strings{"properties of element 'vertex' not kept: red, blue, alpha"});
  const Soup rgb = with({"float blue", "uchar alpha", "ushort green", "uchar red", "float q"},
                        ".25 51 13107 255 7");
  EXPECT_EQ(rgb.appearance.vertex_colours.col(1), Eigen::Vector4d(1, 0.2, 0.25, 0.2));
  EXPECT_EQ(rgb.dropped, Strings{"properties of element 'vertex' not kept: q"});
  const Soup signs = with({"char red", "uchar green", "uchar blue"}, "1 2 3");
  EXPECT_EQ(signs.dropped, Strings{"properties of element 'vertex' not kept: red, green, blue"});
  const Soup opaque = with({"uchar red", "uchar green", "uchar blue", "int alpha"}, "0 51 255 3");
  EXPECT_EQ(opaque.appearance.vertex_colours.col(2), Eigen::Vector3d(0, 0.2, 1));
  EXPECT_EQ(opaque.dropped, Strings{"properties of element 'vertex' not kept: alpha"});
  const Soup below = with({"float red", "float green", "float blue"}, "0 -.01 1");
  EXPECT_EQ(below.dropped,
            Strings{"3 vertex colours (some number of them is not in 0 .. 1) not kept"});
}

TEST_F(PlyTextTest, BytesBehindTheLastElementAreCounted) {
  std::string content =
      "ply\nformat binary_little_endian 1.0\nelement odd 2\nproperty uchar a\n"
      "element vertex 1\nproperty float x\nproperty float y\nproperty float z\n"
      "end_header\nab";
  for (const float x : {1.5f, -2.f, 3.f}) AppendLittleEndian(x, &content);
  const Soup soup = Read(content + "\n\n ");
  EXPECT_EQ(soup.vertices.col(0), Eigen::Vector3d(1.5, -2, 3));
  EXPECT_EQ(soup.dropped,
            (Strings{"2 of element 'odd' not kept", "3 bytes after the last element not kept"}));
  EXPECT_EQ(Read(content).dropped, Strings{"2 of element 'odd' not kept"});
  Refused(content.substr(0, content.size() - 1), {" ", "1", "'vertex'", "0"});
}

TEST_F(PlyTextTest, NumbersOfVertices) {
  const std::string file =
      File("m.ply", kText +
                        "element vertex 3\nproperty float age\nproperty float x\nproperty float y\n"
                        "property float z\nproperty list int int many\nproperty int last\n"
                        "end_header\n.5 0 0 0 2 8 9 4\n.25 1 0 0 0 5\n2 0 1 -7 1 3 6\n");
  EXPECT_EQ(ReadVertexField(file + ":age"), Eigen::Vector3d(.5, .25, 2));
  EXPECT_EQ(ReadVertexField(file + ":last"), Eigen::Vector3d(4, 5, 6));
  EXPECT_EQ(ReadVertexField(file + ":z"), Eigen::Vector3d(0, 0, -7));
  const auto refused = [&](const std::string& name, Strings parts) {
    parts.front() = file + parts.front();
    EXPECT_TRUE(testing::Refuses<FileError>([&] { ReadVertexField(file + name); }, parts));
  };
  refused(":many", {":10:", "property many", "element vertex"});
  refused(":Age", {":10:", "element vertex", "property Age"});
  refused("", {":", file + ":name"});
  refused(":", {"::", "property"});
  const std::string plain = File("numbers.txt", "# of vertices\n1\n\n-2.5 # two\n 3e2\n");
  EXPECT_EQ(ReadVertexField(plain), Eigen::Vector3d(1, -2.5, 300));
  const auto plain_refused = [&](const std::string& content, Strings parts) {
    const std::string path = File("n.txt", content);
    parts.front() = path + parts.front();
    EXPECT_TRUE(testing::Refuses<FileError>([&] { ReadVertexField(path); }, parts));
  };
  plain_refused("1\n\n2 3\n", {":3:", "vertex 2"});
  plain_refused("1\n# a\ninf\n", {":3:", "vertex 2", "'inf'"});
}

}  // namespace
}  // namespace shapespace::ply_text_test
