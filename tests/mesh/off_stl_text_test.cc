#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/bytes.h>
#include <shapespace/base/internal/text.h>
#include <shapespace/files/read.h>

#include "mesh/files.h"
#include "support/message_of.h"

// OFF and STL: asymmetric meshes, and what is said about them.

namespace shapespace::off_stl_text_test {
namespace {

using internal::AppendLittleEndian;
using Ints = std::vector<int>;
using Strings = std::vector<std::string>;

Soup Read(const std::string& content, MeshFormat format) {
  return testing::SoupOf(content, "m", format);
}

Soup ReadOff(const std::string& content) { return Read(content, MeshFormat::kOff); }
Soup ReadStl(const std::string& content) { return Read(content, MeshFormat::kStl); }

void ExpectRefused(const std::string& content, MeshFormat format, std::vector<std::string> parts) {
  parts.front() = "m" + parts.front();
  EXPECT_TRUE(testing::Refuses<FileError>([&] { Read(content, format); }, parts)) << content;
}

TEST(OffTextTest, CountsWhatItDrops) {
  const Soup soup = ReadOff(
      "STCNOFF # all\n4 3 # two numbers\n1 2 3 9 9 # x\n4 5 6\n\n7 8 9 1\n-1 -2 -3\n"
      "3 2 0 1 255 0 0\n4 0 1 2 3\n# none\n3 3 2 1 0.5");
  EXPECT_EQ(soup.vertices.col(2), Eigen::Vector3d(7, 8, 9));
  EXPECT_EQ(soup.vertices.col(3), Eigen::Vector3d(-1, -2, -3));
  EXPECT_EQ(soup.corners, (Ints{2, 0, 1, 0, 1, 2, 3, 3, 2, 1}));
  EXPECT_EQ(soup.polygon_begin, (Ints{0, 3, 7, 10}));
  EXPECT_EQ(soup.vertex_line, (Ints{3, 4, 6, 7}));
  EXPECT_EQ(soup.polygon_line, (Ints{8, 9, 11}));
  EXPECT_EQ(soup.dropped, (Strings{"what follows x y z of 2 vertices (normals, colours, texture "
                                   "coordinates) not kept",
                                   "2 polygon colours not kept"}));
}

TEST(OffTextTest, SaysWhatIsWrong) {
  const auto refused = [](const std::string& content, const std::vector<std::string>& parts) {
    ExpectRefused(content, MeshFormat::kOff, parts);
  };
  for (const std::string word : {"4OFF", "nOFF", "C4nOFF", "OFFN", "COFFEE", "CCOFF", "offset"}) {
    refused("\n" + word + " 3 1 0\n", {":2:", word, "STOFF"});
  }
  refused("OFF BINARY\n3 1 0\n", {":1:"});
  refused("# nothing\n\n", {":2:"});
  refused("OFF\n# nothing\n", {":2:"});
  refused("OFF\n\n3 x 0\n0 0 0\n", {":3:", "'x'"});
  refused("OFF\n3\n0 0 0\n", {":2:", "''"});
  refused("OFF\n0 1 0\n3 0 0 0\n", {":2:"});
  // Eight bytes follow.
  refused("OFF\n9 1 0\n0 0 0\n0\n", {":2:", "9"});
  refused("OFF\n8 1 0\n0 0 0\n0\n", {":4:", "vertex 2", "coordinate y"});
  refused("OFF\n1 9 0\n0 0 0\n0\n", {":2:", "9"});
  refused("OFF\n3 1 0\n0 0 0\n0 1 0\n\n", {":5:", "vertex 3 of 3"});
  refused("OFF\n2 1 0\n0 0 0\n0 1 0\n3 0 1 2\n", {":5:", "polygon 1", "'2'", "0", "1"});
  refused("OFF\n1 2 0\n0 0 0\n3 0 0 0\n2 0 0\n", {":5:", "polygon 2", "'2'"});
  refused("OFF\n1 2 0\n0 0 0\n3 0 0 0\n5 0 0 0\n", {":5:", "polygon 2", "3 of 5"});
  refused("OFF\n1 1 0\n0 0 0\n3 0 0 0\n\n# end\n3 0 0 0\n", {":7:"});
  refused("OFF\n1 1 0\n0 0 0\n3 0 0 0.5\n", {":4:", "polygon 1", "'0.5'", "0"});
}

TEST(OffTextTest, KeywordsAreInAnyLettersAndBeforeTheNumbersWithOrWithoutABlank) {
  const std::string rest = "4 2 0\n0 0 0 7 7\n1 0 0\n1 1 0\n0 1 .5\n4 0 1 2 3\n3 2 1 0 9\n";
  const Soup plain = ReadOff("OFF\n" + rest);
  for (const std::string keyword : {"OFF", "off", "Off", "NCOFF", "NCSTOFF", "stoff", "noff"}) {
    for (const std::string between : {"", " ", "\t", "\r\n\r\n", "\n# none\n", "\r"}) {
      const Soup soup = ReadOff(keyword + between + rest);
      EXPECT_EQ(soup.vertices, plain.vertices) << keyword << between;
      EXPECT_EQ(soup.corners, (Ints{0, 1, 2, 3, 2, 1, 0})) << keyword << between;
      EXPECT_EQ(soup.dropped, plain.dropped);
    }
  }
  EXPECT_EQ(ReadOff("\xEF\xBB\xBF# a\noff" + rest).corners, plain.corners);
}

TEST(OffTextTest, NumbersOfAnElementMayBeOnLinesOfTheirOwn) {
  const Soup soup = ReadOff(
      "OFF\n4\n3\n0\n0\n0\n0\n1 0\n0\n1\n\n1 0 # here\n0 1 .5\n"
      "4 0 1\n2\n3\n3\n0 1\n2\n3 3 2 1 255 0 0\n");
  EXPECT_EQ(soup.vertices, (Shape(3, 4) << 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 0, .5).finished());
  EXPECT_EQ(soup.corners, (Ints{0, 1, 2, 3, 0, 1, 2, 3, 2, 1}));
  EXPECT_EQ(soup.vertex_line, (Ints{5, 8, 10, 13}));
  EXPECT_EQ(soup.polygon_line, (Ints{14, 17, 20}));
  EXPECT_EQ(soup.dropped, Strings{"1 polygon colours not kept"});
  // Without the number of edges, which is followed by three words.
  EXPECT_EQ(ReadOff("off3\n1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n").corners, (Ints{0, 1, 2}));
}

TEST(OffTextTest, WordsAfterTheLastPolygonAreLeftOut) {
  for (const std::string end : {"\x1a", "\n# by hand\nEND of file 7\n", "\n-- 3 --"}) {
    const Soup soup = ReadOff("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n" + end);
    EXPECT_EQ(soup.corners, (Ints{0, 1, 2}));
    EXPECT_EQ(soup.dropped, Strings{"1 lines after the last polygon not kept"}) << end;
  }
}

TEST(OffTextTest, ALineThatWasCutOffDoesNotTakeTheNext) {
  ExpectRefused("OFF\n3 2 0\n0 0 0\n1 0\n0 1 0\n3 0 1 2\n3 2 1 0\n", MeshFormat::kOff,
                {":4:", "vertex 2", "coordinate z"});
  ExpectRefused("OFF\n3 2 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1\n3 2 1 0\n", MeshFormat::kOff,
                {":6:", "polygon 1", "2 of 3"});
}

TEST(OffTextTest, WhatFollowsAVertexNeedNotBeANumber) {
  const Soup soup = ReadOff("NOFF\n3 1 0\n0 0 0 nan nan nan\n1 0 0 x\n0 1 0 1.#IND\n3 0 1 2\n");
  EXPECT_EQ(soup.vertices.col(1), Eigen::Vector3d(1, 0, 0));
  EXPECT_EQ(soup.dropped.size(), 1u);
}

const std::string kFacet =
    "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 "
    "0\nendloop\nendfacet\n";  // 7 lines

TEST(StlTextTest, SaysWhatIsWrong) {
  const auto refused = [](const std::string& content, const std::vector<std::string>& parts) {
    ExpectRefused("solid of many words\n" + content, MeshFormat::kStl, parts);
  };
  refused(kFacet, {":8:"});
  refused(kFacet + "endsolid\n" + kFacet, {":16:"});
  refused("endsolid\n\nsolid\n", {":4:"});
  refused("facet\nvertex 0 0 0\nvertex 1 0 x\n", {":4:", "corner 2", "coordinate z", "'x'"});
  refused(kFacet + "vertex 0 nan 0\n", {":9:", "corner 1", "coordinate y", "'nan'"});
  refused("vertex 0 0\n", {":2:", "corner 1", "coordinate z"});
  refused("vertex 0 0 1 2 3\n", {":2:", "'2'"});
  refused(kFacet + "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nvertex 1 1 0\nendfacet\n",
          {":13:", "triangle 2"});
  refused(kFacet + "triangle\n", {":9:", "'triangle'"});
  ExpectRefused("polid\nendsolid\n", MeshFormat::kStl, {":", "'solid'"});
}

TEST(StlTextTest, CapitalsBlanksAndWhatFollowsDoNotMatter) {
  const std::string facet =
      "\tFacet Normal nan 0 1\n\tOUTER Loop\nVertex 0 0 0\n\tVERTEX 1 0 0\nvertex 0 1 0E0\n"
      "ENDLOOP\nEndFacet\n";
  const Soup soup =
      ReadStl("\xEF\xBB\xBF \t\r\n\n SOLID facet normal\n" + facet + "EndSolid facet\n");
  EXPECT_EQ(soup.corners, (Ints{0, 1, 2}));
  EXPECT_TRUE(soup.dropped.empty());
  for (const std::string end : {"endsolid\n\x1a", "endsolid a\n# by hand\n\n",
                                "endsolid\n\n<!-- signature -->", "endsolid\nvalue 1"}) {
    const Soup followed = ReadStl("solid\n" + facet + end);
    EXPECT_EQ(followed.corners, (Ints{0, 1, 2})) << end;
    EXPECT_EQ(followed.dropped, Strings{"1 lines after endsolid not kept"}) << end;
  }
  const std::string zeros(300, '\0');
  EXPECT_EQ(ReadStl("solid\n" + facet + "endsolid" + zeros).corners, (Ints{0, 1, 2}));
  const Soup two = ReadStl("solid\n" + facet + "endsolid\n# next\nsolid\n" + facet + "endsolid\n");
  EXPECT_EQ(two.corners, (Ints{0, 1, 2, 0, 1, 2}));
  EXPECT_EQ(two.dropped.size(), 1u);
}

TEST(StlTextTest, SeveralSolidsAreOneMesh) {
  const Soup soup =
      ReadStl("solid a\r\n" + kFacet + "endsolid a\n\nsolid b\n" + kFacet + "endsolid b\n  \n");
  EXPECT_EQ(soup.corners, (Ints{0, 1, 2, 0, 1, 2}));
  EXPECT_EQ(soup.vertex_line, (Ints{4, 5, 6}));
  EXPECT_EQ(soup.polygon_line, (Ints{4, 14}));
  const Soup empty = ReadStl("solid a\nendsolid a\n");
  EXPECT_EQ(empty.NumVertices(), 0);
  EXPECT_EQ(empty.NumPolygons(), 0);
  EXPECT_EQ(empty.file, "m");
}

TEST(StlTextTest, BinaryTriangles) {
  const std::vector<float> corners[] = {{1, 2, 3, 4, 5, 6, 7, 8, 10},
                                        {7, 8, 10, 1, 2, 3, -1, -2, .5f}};
  std::string bytes = "solid";
  bytes.resize(80, 'x');
  AppendLittleEndian(std::uint32_t{2}, &bytes);
  for (const std::vector<float>& triangle : corners) {
    for (int i = 0; i < 3; ++i) AppendLittleEndian(99.f, &bytes);  // a normal
    for (const float x : triangle) AppendLittleEndian(x, &bytes);
    bytes += "ab";
  }
  const Soup soup = ReadStl(bytes);
  Shape expected(3, 4);
  expected << 1, 4, 7, -1, 2, 5, 8, -2, 3, 6, 10, 0.5;
  EXPECT_EQ(soup.vertices, expected);
  EXPECT_EQ(soup.corners, (Ints{0, 1, 2, 2, 0, 3}));
  EXPECT_EQ(soup.polygon_begin, (Ints{0, 3, 6}));
  EXPECT_TRUE(soup.vertex_line.empty() && soup.polygon_line.empty() && soup.dropped.empty());
  const std::string infinity("\0\0\x80\x7f", 4);
  bytes.replace(84 + 50 + 12 + 32, 4, infinity);  // the last coordinate
  ExpectRefused(bytes, MeshFormat::kStl, {":", "triangle 2"});
  // No triangles, in the least bytes.
  EXPECT_EQ(ReadStl(std::string(84, '\0')).NumPolygons(), 0);
}

}  // namespace
}  // namespace shapespace::off_stl_text_test
