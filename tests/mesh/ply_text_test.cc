#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/bytes.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/read.h>
#include <shapespace/files/vertex_field.h>

#include "mesh/files.h"
#include "support/message_of.h"

// The whole text of what is said about PLY files.

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

  static void Refused(const std::string& content, const std::string& words) {
    EXPECT_EQ(testing::MessageOf<FileError>([&] { Read(content); }), "m.ply:" + words) << content;
  }
};

TEST_F(PlyTextTest, Elements) {
  Refused(kHeader + "0 0 0\n1 0 0\n\n0 y 0\n3 0 1 2\n",
          "13: vertex 3: y 'y' is not a number" + kReexport);
  Refused(kHeader + "0 0 0\n1 inf 0\n0 1 0\n3 0 1 2\n",
          "11: vertex 2: coordinate y is not a finite number" + kReexport);
  Refused(kHeader + "0 0 0\n1 0 0 7 8\n0 1 0\n3 0 1 2\n",
          "11: vertex 2: '7' at the end of its line is too much" + kReexport);
  Refused(kHeader + kVertices + "\n3 0 1 3\n",
          "14: polygon 1: vertex index 3 is not one of 0 to 2" + kReexport);
  Refused(kHeader + kVertices + "3 0 1 2.5\n",
          "13: polygon 1: a vertex index is not a number counted from 0" + kReexport);
  Refused(kHeader + kVertices + "3 0 1 2147483648\n",
          "13: polygon 1: a vertex index is not a number counted from 0" + kReexport);
  Refused(kHeader + kVertices + "2 0 1\n",
          "13: polygon 1: 2 corners, a polygon needs three" + kReexport);
  Refused(kHeader + kVertices + "3.5 0 1 2\n",
          "13: polygon 1: the length of vertex_indices is not a count" + kReexport);
  Refused(kHeader + kVertices + "nan 0 1 2\n",
          "13: polygon 1: the length of vertex_indices is not a count" + kReexport);
  Refused(
      kHeader + kVertices + "3 0 1 2\n\n7\n",
      "15: something follows the last element; the counts of the header do not fit" + kReexport);
  Refused(kHeader + "0 0 0\n1 0 0\n          \n\n",
          "13: the file ends before vertex 3" + kReexport);
}

TEST_F(PlyTextTest, CountsThatTheFileHasNoRoomFor) {
  // Three numbers, of two bytes each at least; the last one need not be followed by a blank.
  Refused(
      kText + kXyz + "end_header\n0 0 0\n1 0 0\n0 1\n",
      "7: the header promises 3 of element 'vertex', the file has room for at most 2" + kReexport);
  EXPECT_EQ(Read(kText + kXyz + "end_header\n0 0 0\n1 0 0\n0 1 5").vertices.col(2),
            Eigen::Vector3d(0, 1, 5));
  Refused(
      kHeader + kVertices,
      "12: the header promises 1 of element 'face', the file has room for at most 0" + kReexport);
  Refused(kText + kXyz + "element odd 2\nend_header\n" + kVertices,
          "11: element 'odd' has no properties" + kReexport);
  EXPECT_TRUE(Read(kText + kXyz + "element odd 0\nend_header\n" + kVertices).dropped.empty());
}

TEST_F(PlyTextTest, Headers) {
  Refused("plybinary\n", "1: does not begin with 'ply'; is this a PLY file?");
  Refused(kText + "element vertex 1\n", "3: the file ends inside its header" + kReexport);
  Refused(kText + "comment\nelements vertex 1\n",
          "4: the header holds 'elements', which is not a statement of PLY" + kReexport);
  Refused("ply\n" + kXyz + "end_header\n" + kVertices,
          "6: the header has no 'format' statement" + kReexport);
  Refused("ply\n\nformat ASCII 1.0\n",
          "3: format 'ASCII' is not one of ascii, binary_little_endian, binary_big_endian");
  Refused(kText + "element vertex\n", "3: element 'vertex': '' is not a count" + kReexport);
  Refused(kText + kXyz + "element face 1\nproperty int i\nelement vertex 1\n",
          "9: element 'vertex' occurs twice");
  Refused(kText + "property float x\n", "3: a property precedes any element" + kReexport);
  Refused(kText + kXyz + "property list double int i\n",
          "7: 'double' is not a type that can count the items of a list");
  Refused(kText + kXyz + "property list quad int i\n",
          "7: 'quad' is not a type that can count the items of a list");
  Refused(kText + kXyz + "property list int quad i\n", "7: 'quad' is not a type of PLY");
  Refused(kText + kXyz + "property list int int x\n", "7: property 'x' occurs twice");
  Refused(kText + kXyz + "element tristrips 1\nproperty list int int i\nend_header\n",
          "9: triangle strips are not read; export polygons (faces) instead");
  EXPECT_NO_THROW(Read(kText + kXyz + "element tristrips 0\nproperty list int int i\nend_header\n" +
                       kVertices));
  Refused(kText + "element vertex 0\nproperty float x\nend_header\n",
          "5: the header says that there are no vertices");
  Refused(kText +
              "element vertex 1\nproperty float x\nproperty list int float y\nproperty float "
              "z\nend_header\n0 1 0 0\n",
          "7: property y of element vertex is a list");
  Refused(kText + "element vertex 1\nproperty float x\nproperty float y\nend_header\n0 0\n",
          "6: element vertex has no property z" + kReexport);
  const auto faces = [](const std::string& properties) {
    return kText + kXyz + "element face 1\n" + properties + "end_header\n" + kVertices +
           "3 0 1 2 3 0 1 2\n";
  };
  Refused(faces("property list int float vertex_index\n"),
          "12: property vertex_index of element face is not a list of integers");
  Refused(faces("property int vertex_indices\n"),
          "12: property vertex_indices of element face is not a list of integers");
  Refused(faces("property list int int vertex_index\nproperty list int int vertex_indices\n"),
          "13: element face needs one list vertex_indices, it has 2" + kReexport);
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
  Refused(header + "0 7 2\n3 7 0\n" + kVertices,
          "13: segment 2: vertex index 3 is not one of 0 to 2" + kReexport);
  Refused(header + "0 7 2\n0 7 4\n" + kVertices,
          "13: segment 2: vertex index 4 is not one of 0 to 2" + kReexport);
  Refused(header + "0 7 2\n0 7 -1\n" + kVertices,
          "13: segment 2: a vertex index is not a number counted from 0" + kReexport);
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
  Refused(
      content.substr(0, content.size() - 1),
      " the header promises 1 of element 'vertex', the file has room for at most 0" + kReexport);
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
  const auto refused = [&](const std::string& name, const std::string& words) {
    EXPECT_EQ(testing::MessageOf<FileError>([&] { ReadVertexField(file + name); }), file + words);
  };
  refused(":many", ":10: property many of element vertex is a list");
  refused(":Age", ":10: element vertex has no property Age" + kReexport);
  refused("", ": name the property of the vertices to read, as " + file + ":name");
  refused(":", ":: name a property behind the colon");
  const std::string plain = File("numbers.txt", "# of vertices\n1\n\n-2.5 # two\n 3e2\n");
  EXPECT_EQ(ReadVertexField(plain), Eigen::Vector3d(1, -2.5, 300));
  const auto plain_refused = [&](const std::string& content, const std::string& words) {
    const std::string path = File("n.txt", content);
    EXPECT_EQ(testing::MessageOf<FileError>([&] { ReadVertexField(path); }), path + words);
  };
  plain_refused("1\n\n2 3\n", ":3: vertex 2: more than one number");
  plain_refused("1\n# a\ninf\n", ":3: vertex 2: number 'inf' is not a finite number" + kReexport);
}

}  // namespace
}  // namespace shapespace::ply_text_test
