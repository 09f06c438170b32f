#include <cmath>
#include <cstring>

#include <shapespace/base/error.h>
#include <shapespace/files/read.h>

#include "mesh/files.h"

namespace shapespace {
namespace {

using testing::ExpectError;
using Ints = std::vector<int>;

/// The bytes of numbers of mixed types, in the byte order asked for.
class Bytes {
 public:
  explicit Bytes(bool big_endian) : big_endian_(big_endian) {}

  template <typename T>
  Bytes& Add(T value) {
    const unsigned one = 1;
    char first, bytes[sizeof(T)];
    std::memcpy(&first, &one, 1);
    std::memcpy(bytes, &value, sizeof(T));
    const bool machine_is_big = first == 0;
    for (size_t i = 0; i < sizeof(T); ++i) {
      content += bytes[big_endian_ == machine_is_big ? i : sizeof(T) - 1 - i];
    }
    return *this;
  }

  std::string content;

 private:
  bool big_endian_;
};

class ReadPlyTest : public testing::FilesTest {
 protected:
  Soup Read(const std::string& content) { return ReadSoup(File("pose.ply", content)); }

  void ExpectRefused(const std::string& content, const std::vector<std::string>& parts) {
    ExpectError<FileError>([&] { Read(content); }, parts);
  }
};

// 9 lines.
constexpr char kHeader[] =
    "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
    "property float z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
constexpr char kVertices[] = "0 0 0\n1 0 0\n0 1 0\n";

TEST_F(ReadPlyTest, ReadsTextAndSkipsWhatItDoesNotKnow) {
  const Soup soup = Read(
      "ply\r\nformat ascii 1.0\r\ncomment made by hand\r\nobj_info nothing\r\n"
      "element camera 1\r\nproperty float f\r\nproperty list uchar short tags\r\n"
      "element vertex 4\r\nproperty uchar red\r\nproperty double z\r\nproperty float y\r\n"
      "property list int float weights\r\nproperty int x\r\n"
      "element face 2\r\nproperty list uchar uint vertex_index\r\nproperty int flags\r\n"
      "element edge 1\r\nproperty short vertex2\r\nproperty uchar red\r\nproperty int vertex1\r\n"
      "end_header\r\n"
      "0.5 2 7 8\r\n"
      "255 0 0 0 0\r\n255 .1 0 1 .5 1\r\n\r\n255 0 1 2 .1 .2 1\r\n0 0 1 0 0\r\n"
      "4 0 1 2 3 17\r\n3 2 1 0 17\r\n3 0 1\r\n");
  EXPECT_EQ(soup.vertices.col(1), Eigen::Vector3d(1, 0, .1));
  EXPECT_EQ(soup.vertices.col(3), Eigen::Vector3d(0, 1, 0));
  EXPECT_EQ(soup.polygon_begin, (Ints{0, 4, 7}));
  EXPECT_EQ(soup.corners, (Ints{0, 1, 2, 3, 2, 1, 0}));
  EXPECT_EQ(soup.segments, (std::vector<std::pair<int, int>>{{1, 3}}));
  EXPECT_EQ(soup.vertex_line, (Ints{23, 24, 26, 27}));
  EXPECT_EQ(soup.polygon_line, (Ints{28, 29}));
  EXPECT_EQ(soup.segment_line, (Ints{30}));
  std::string all;
  for (const std::string& sentence : soup.dropped) all += sentence + "\n";
  EXPECT_EQ(all,
            "1 of element 'camera' not kept\n"
            "properties of element 'vertex' not kept: red, weights\n"
            "properties of element 'face' not kept: flags\n"
            "properties of element 'edge' not kept: red\n");
}

// As MeshLab writes them.
TEST_F(ReadPlyTest, ReadsColoursAndTextureCoordinates) {
  const Soup soup = Read(
      "ply\nformat ascii 1.0\ncomment TextureFile skin.png\nelement vertex 4\n"
      "property float x\nproperty float y\nproperty float z\n"
      "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty uchar alpha\n"
      "element face 3\nproperty list uchar int vertex_indices\n"
      "property list uchar float texcoord\nproperty int texnumber\nend_header\n"
      "0 0 0 255 0 51 255\n1 0 0 0 255 0 0\n1 1 0 0 0 0 102\n0 1 0 1 2 3 255\n"
      "3 0 1 2 6 0 0 1 0 1 1 0\n3 0 2 3 0 0\n4 0 1 2 3 8 0 0 1 0 0.5 1 0 1 0\n");
  const Appearance& appearance = soup.appearance;
  Eigen::MatrixXd colours(4, 4);
  colours << 255, 0, 0, 1, 0, 255, 0, 2, 51, 0, 0, 3, 255, 0, 102, 255;
  EXPECT_EQ(appearance.vertex_colours, colours / 255);
  Eigen::MatrixXd expected(2, 5);
  expected << 0, 1, 1, 0.5, 0, 0, 0, 1, 1, 1;
  EXPECT_EQ(appearance.texture_coordinates, expected);
  EXPECT_EQ(appearance.corner_texture, (Ints{0, 1, 2, -1, -1, -1, 0, 1, 3, 4}));
  EXPECT_EQ(soup.dropped, (std::vector<std::string>{
                              "texture file 'skin.png' not kept; a material of an OBJ can name it",
                              "properties of element 'face' not kept: texnumber"}));
}

TEST_F(ReadPlyTest, FullColourIsOneInEveryTypeOfColours) {
  for (const auto& [type, full, fifth] : {std::make_tuple("uchar", "255", "51"),
                                          {"ushort", "65535", "13107"},
                                          {"float", "1", "0.2"},
                                          {"double", "1", "0.2"}}) {
    std::string header =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
        "property float y\nproperty float z\n";
    for (const char* channel : {"red", "green", "blue"}) {
      header += std::string("property ") + type + " " + channel + "\n";
    }
    std::string vertices;
    for (const char* place : {"0 0 0", "1 0 0", "0 1 0"}) {
      vertices += std::string(place) + " 0 " + fifth + " " + full + "\n";
    }
    const Soup soup =
        Read(header + "element face 1\nproperty list uchar int vertex_indices\nend_header\n" +
             vertices + "3 0 1 2\n");
    EXPECT_EQ(soup.appearance.vertex_colours, Eigen::Vector3d(0, 0.2, 1).replicate(1, 3)) << type;
  }
}

TEST_F(ReadPlyTest, SaysWhereColoursOrTextureCoordinatesAreNone) {
  const auto dropped = [this](const std::string& type, const std::string& vertices,
                              const std::string& texture) {
    const Soup soup = Read(
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
        "property float y\nproperty float z\nproperty " +
        type + " red\nproperty " + type + " green\nproperty " + type +
        " blue\nelement face 1\nproperty list uchar int vertex_indices\n"
        "property list uchar float texcoord\nend_header\n" +
        vertices + "3 0 1 2 " + texture + "\n");
    EXPECT_EQ(soup.appearance.vertex_colours.size(), 0);
    EXPECT_TRUE(soup.appearance.corner_texture.empty());
    return soup.dropped;
  };
  EXPECT_EQ(dropped("int", "0 0 0 1 2 3\n1 0 0 1 2 3\n0 1 0 1 2 3\n", "0"),
            std::vector<std::string>{"properties of element 'vertex' not kept: red, green, blue"});
  EXPECT_EQ(dropped("float", "0 0 0 1 0 1\n1 0 0 1 nan 0\n0 1 0 1 0 1\n", "2 0 0"),
            (std::vector<std::string>{
                "texture coordinates of 1 polygons, which are not two finite numbers a corner, not "
                "kept",
                "3 vertex colours (some number of them is not in 0 .. 1) not kept"}));
  for (const std::string bad : {"inf", "-1.#IND", "x"}) {
    const std::vector<std::string> said =
        dropped("uchar", "0 0 0 1 2 3\n1 0 0 " + bad + " 2 3\n0 1 0 1 2 3\n", "6 0 0 0 0 0 " + bad);
    ASSERT_EQ(said.size(), 2u);
    EXPECT_NE(said[0].find("texture coordinates of 1 polygons"), std::string::npos);
    EXPECT_NE(said[1].find("3 vertex colours"), std::string::npos);
  }
}

TEST_F(ReadPlyTest, WhatIsNotKeptNeedNotBeANumber) {
  const Soup soup = Read(
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float nx\n"
      "property float y\nproperty float z\nend_header\n0 nan 0 0\n1 None 0 0\n0 1.#QNAN 1 0\n");
  EXPECT_EQ(soup.vertices, (Shape(3, 3) << 0, 1, 0, 0, 0, 1, 0, 0, 0).finished());
  EXPECT_EQ(soup.dropped, std::vector<std::string>{"properties of element 'vertex' not kept: nx"});
}

TEST_F(ReadPlyTest, ReadsEveryScalarTypeInBothByteOrders) {
  for (const bool big : {false, true}) {
    Bytes bytes(big);
    // An unknown element with one property of each type, and a list of shorts.
    bytes.Add<std::int8_t>(-1).Add<std::uint8_t>(1).Add<std::int16_t>(-2).Add<std::uint16_t>(2);
    bytes.Add<std::int32_t>(-3).Add<std::uint32_t>(3).Add(1.5f).Add(2.5);
    bytes.Add<std::uint16_t>(2).Add<std::int16_t>(7).Add<std::int16_t>(8);
    // Vertices: short, float, double.
    bytes.Add<std::int16_t>(-300).Add(0.5f).Add(0.1);
    bytes.Add<std::int16_t>(2).Add(-0.25f).Add(1e-300);
    bytes.Add<std::int16_t>(0).Add(0.0f).Add(-1e300);
    // One triangle, its length as an int, its indices as bytes; one edge.
    bytes.Add<std::int32_t>(3).Add<std::uint8_t>(2).Add<std::uint8_t>(0).Add<std::uint8_t>(1);
    bytes.Add<std::uint32_t>(1).Add<std::uint32_t>(2);
    const Soup soup =
        Read(std::string("ply\nformat ") + (big ? "binary_big_endian" : "binary_little_endian") +
             " 1.0\nelement odd 1\nproperty char a\nproperty uint8 b\nproperty int16 c\n"
             "property ushort d\nproperty int e\nproperty uint32 f\nproperty float32 g\n"
             "property double h\nproperty list ushort short i\n"
             "element vertex 3\nproperty short x\nproperty float y\nproperty float64 z\n"
             "element face 1\nproperty list int uchar vertex_indices\n"
             "element edge 1\nproperty uint vertex1\nproperty uint vertex2\nend_header\n" +
             bytes.content);
    Shape expected(3, 3);
    expected << -300, 2, 0, 0.5, -0.25, 0, 0.1, 1e-300, -1e300;
    EXPECT_EQ(soup.vertices, expected) << big;
    EXPECT_EQ(soup.corners, (Ints{2, 0, 1}));
    EXPECT_EQ(soup.segments, (std::vector<std::pair<int, int>>{{1, 2}}));
    EXPECT_TRUE(soup.vertex_line.empty() && soup.polygon_line.empty() && soup.segment_line.empty());
  }
}

TEST_F(ReadPlyTest, RefusesBadText) {
  const std::string header = kHeader, vertices = kVertices;
  ExpectRefused("", {"pose.ply: "});
  ExpectRefused(header + "0 0 0\n1 0\n0 1 0\n3 0 1 2\n", {"pose.ply:11: vertex 2: z "});
  ExpectRefused(header + vertices + "3 0 1 -1\n", {"pose.ply:13: polygon 1: "});
  ExpectRefused(header + vertices + "3 0 1\n", {"pose.ply:13: polygon 1: vertex index "});
  ExpectRefused(header + vertices + "-3 0 1\n", {"pose.ply:13: polygon 1: ", "vertex_indices"});
  EXPECT_EQ(Read(header + vertices + "3 0 1 2\nmade by hand\n").dropped.back(),
            "1 lines after the last element not kept");
}

TEST_F(ReadPlyTest, RefusesBadHeaders) {
  auto refused = [this](const std::string& statements, const std::vector<std::string>& parts) {
    ExpectRefused("ply\nformat ascii 1.0\n" + statements, parts);
  };
  refused("element vertex many\n", {"pose.ply:3: element 'vertex': 'many' "});
  refused("element vertex -1\n", {"pose.ply:3: element 'vertex': '-1' "});
  refused("element vertex 1\nproperty quad x\n", {"pose.ply:4: 'quad' "});
  refused(
      "element vertex 1\nproperty int x\nproperty int y\nproperty int z\nelement face 1\n"
      "property int colour\nend_header\n0 0 0\n7\n",
      {"element face ", "vertex_indices", " 0"});
}

TEST_F(ReadPlyTest, RefusesTruncatedAndLyingBinary) {
  const std::string header =
      "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\n"
      "property float y\nproperty float z\nelement face 1\n"
      "property list uchar int vertex_indices\nend_header\n";
  Bytes vertices(false);
  for (int i = 0; i < 9; ++i) vertices.Add(static_cast<float>(i * i));
  Bytes polygon(false);
  polygon.Add<std::uint8_t>(3).Add(0).Add(1).Add(2);
  EXPECT_EQ(Read(header + vertices.content + polygon.content).corners, (Ints{0, 1, 2}));

  const std::string cut = polygon.content.substr(0, 7);
  ExpectRefused(header + vertices.content + cut, {"pose.ply: ", "polygon 1"});
  ExpectRefused(header + vertices.content.substr(0, 20), {"3 of element 'vertex'", "at most 1"});
  ExpectRefused(header + vertices.content + "\xff" + polygon.content, {"pose.ply: ", "polygon 1"});
  Bytes outside(false);
  outside.Add<std::uint8_t>(3).Add(0).Add(1).Add(3);
  ExpectRefused(header + vertices.content + outside.content,
                {"pose.ply: polygon 1: vertex index 3 "});
  Bytes negative(false);
  negative.Add<std::uint8_t>(3).Add(0).Add(1).Add(-1);
  ExpectRefused(header + vertices.content + negative.content, {"pose.ply: polygon 1: "});
  Bytes infinite(false);
  for (int i = 0; i < 9; ++i) infinite.Add(i == 4 ? INFINITY : 0.0f);
  ExpectRefused(header + infinite.content + polygon.content, {"pose.ply: vertex 2: coordinate y "});
  std::string lie = header + vertices.content + polygon.content;
  lie.replace(lie.find("vertex 3"), 8, "vertex 1000000000");
  ExpectRefused(lie, {"1000000000 of element 'vertex'", "at most 4"});
}

}  // namespace
}  // namespace shapespace
