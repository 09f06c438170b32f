#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <shapespace/mesh/check.h>

#include "mesh/bodies.h"
#include "mesh/findings.h"

// Findings about two poses, and the limits from which on there are some.

namespace shapespace {
namespace {

using testing::ExpectFindings;
using testing::Grid;
using testing::MakeSoup;

using Texts = std::vector<std::string>;

const std::string kFiles = "b.obj against a.obj: ";
Soup InFile(Soup soup, const std::string& file, int first_line) {
  soup.file = file;
  for (int p = 0; p < soup.NumPolygons(); ++p) soup.polygon_line.push_back(first_line + p);
  for (size_t s = 0; s < soup.segments.size(); ++s) {
    soup.segment_line.push_back(first_line + 500 + static_cast<int>(s));
  }
  return soup;
}

/// "kind: message" of every finding; lines begin at 10 in a.obj and at 50 in b.obj.
Texts TextsOf(const Soup& a, const Soup& b) {
  Texts texts;
  for (const Finding& finding : CheckSameMesh(InFile(a, "a.obj", 10), InFile(b, "b.obj", 50))) {
    texts.push_back(finding.kind + ": " + finding.message);
  }
  return texts;
}

TEST(CheckSameMeshMessagesTest, EveryCountThatDiffersIsTold) {
  Soup a = Grid(2, 1), b = Grid(3, 2);
  a.segments = {{0, 5}};
  b.segments = {{0, 5}, {1, 4}, {2, 3}};
  ExpectFindings(TextsOf(a, b), {{"vertex-count", kFiles, "12 vertices instead of 6"},
                                 {"polygon-count", kFiles, "12 polygons instead of 4"},
                                 {"segment-count", kFiles, "3 segments instead of 1"}});
}

TEST(CheckSameMeshMessagesTest, EitherMeshIsNamedIfItIsBroken) {
  Soup broken = Grid(2, 1);
  broken.corners[7] = 6;
  ExpectFindings(TextsOf(broken, Grid(2, 1)),
                 {{"index-out-of-range", "a.obj: ", "polygon 3 (line 12)"}});
  ExpectFindings(TextsOf(Grid(2, 1), broken),
                 {{"index-out-of-range", "b.obj: ", "polygon 3 (line 52)"}});
}

TEST(CheckSameMeshMessagesTest, ThePolygonThatDiffersIsQuotedUpToEightCorners) {
  const Shape vertices = Shape::Random(3, 12);
  const auto differing = [&](int corners) {
    std::vector<int> polygon, other;
    for (int v = 0; v < corners; ++v) polygon.push_back(v);
    other = polygon;
    other.back() = 11;
    const std::vector<int> common = {10, 11, 9};
    return TextsOf(MakeSoup(vertices, {common, polygon, polygon}),
                   MakeSoup(vertices, {common, other, polygon}));
  };
  const std::string here = "polygon 2 (line 51) with vertices ",
                    there = "polygon 2 (line 11) with ";
  ExpectFindings(differing(8), {{"polygons-differ", kFiles, here + "1 2 3 4 5 6 7 12,",
                                 there + "1 2 3 4 5 6 7 8;"}});
  ExpectFindings(differing(9), {{"polygons-differ", kFiles, here + "1 2 3 4 5 6 7 8 ...",
                                 there + "1 2 3 4 5 6 7 8 ..."}});
}

TEST(CheckSameMeshMessagesTest, VerticesThatWereRenumberedAreToldFromOtherMeshes) {
  const Shape vertices = Shape::Random(3, 6);
  // Vertices 4 and 5 are exchanged.
  ExpectFindings(TextsOf(MakeSoup(vertices, {{0, 1, 2}, {1, 3, 2}, {3, 1, 4}}),
                         MakeSoup(vertices, {{0, 1, 2}, {1, 4, 2}, {4, 1, 3}})),
                 {{"polygons-differ", kFiles, "polygon 2 (line 51) with vertices 2 5 3",
                   "polygon 2 (line 11) with 2 4 3", "vertex 4 is number 5 here"}});
  // Two vertices of the reference would be one, or one of them two.
  for (const bool swap : {false, true}) {
    const Soup a = MakeSoup(vertices, {{0, 1, 2}, {1, 3, 2}, {3, 1, 4}});
    const Soup b = MakeSoup(vertices, {{0, 1, 2}, {1, 4, 2}, {4, 1, 0}});
    const Texts texts = swap ? TextsOf(b, a) : TextsOf(a, b);
    ExpectFindings(texts, {{"polygons-differ", "different meshes"}});
  }
  // As many corners at the vertices, but of other numbers of polygons.
  ExpectFindings(TextsOf(MakeSoup(vertices, {{0, 1, 2}, {2, 1, 3, 4}}),
                         MakeSoup(vertices, {{0, 1, 2, 3}, {1, 3, 4}})),
                 {{"polygons-differ", "the same mesh"}});
}

TEST(CheckSameMeshMessagesTest, PolygonsThatAreReversedAreNamedAndCounted) {
  Soup a = Grid(3, 1);
  Soup b = a;
  const auto reverse = [&](int p) { std::swap(b.corners[3 * p + 1], b.corners[3 * p + 2]); };
  for (const int p : {1, 3, 4, 5}) reverse(p);
  ExpectFindings(TextsOf(a, b), {{"polygon-winding", kFiles,
                                  "(4): polygon 2 (line 51), polygon 4 (line "
                                  "53), polygon 6 (line 55) and 1 more"}});
  // The last polygon comes first, and with another corner at its beginning.
  const Soup reordered =
      MakeSoup(a.vertices, {{7, 5, 4}, {0, 2, 3}, {0, 3, 1}, {2, 4, 5}, {2, 5, 3}, {4, 6, 7}});
  ExpectFindings(TextsOf(a, reordered), {{"polygon-order", kFiles}});
}

TEST(CheckSameMeshMessagesTest, TheFirstSegmentThatDiffersIsNamedWhicheverWayTheOthersRun) {
  Soup a;
  a.vertices = Shape::Random(3, 5);
  a.segments = {{0, 1}, {2, 1}, {2, 3}, {3, 4}};
  Soup b = a;
  b.segments = {{1, 0}, {1, 2}, {2, 4}, {3, 0}};
  ExpectFindings(TextsOf(a, b),
                 {{"segments-differ", kFiles, "segment 3 (line 552)", "segment 3 (line 512)"}});
}

TEST(CheckSameMeshMessagesTest, MirrorImagesAndScaledOnesAreTold) {
  const Soup torus = testing::Torus(9, 7);
  Soup pose = torus;
  pose.vertices.row(1) *= -3;
  pose.vertices.row(0) *= 3;
  pose.vertices.row(2) *= 3;
  ExpectFindings(TextsOf(torus, pose),
                 {{"mirrored", kFiles, "allow_mirrored"}, {"other-units", kFiles, "3 times"}});
  pose.vertices(0, 5) = std::numeric_limits<double>::infinity();
  EXPECT_EQ(TextsOf(torus, pose), Texts());
  EXPECT_EQ(TextsOf(pose, torus), Texts());
}

TEST(CheckSameMeshMessagesTest, FromTwiceOrHalfTheSizeOnUnitsProbablyDiffer) {
  const Soup grid = Grid(4, 3);
  for (const auto& [scale, said] :
       {std::make_pair(1.99, ""), {2.01, "2.01"}, {1 / 1.99, ""}, {0.495, "0.495"}}) {
    Soup pose = grid;
    pose.vertices *= scale;
    if (*said == '\0') {
      EXPECT_EQ(TextsOf(grid, pose), Texts());
    } else {
      ExpectFindings(TextsOf(grid, pose), {{"other-units", kFiles, std::string(said) + " times"}});
    }
  }
}

/// Segments of length 1 along lines: one line of 100, then one of each of these numbers, which lie
/// side by side. `stretch` gives the length of those of each line.
Soup Lines(const std::vector<int>& counts, const std::vector<double>& stretch) {
  std::vector<Eigen::Vector3d> points;
  Soup soup;
  for (size_t line = 0; line <= counts.size(); ++line) {
    const int count = line == 0 ? 100 : counts[line - 1];
    const double length = line == 0 ? 1 : stretch[line - 1];
    for (int k = 0; k <= count; ++k) {
      if (k > 0) {
        const int last = static_cast<int>(points.size());
        soup.segments.emplace_back(last - 1, last);
      }
      points.emplace_back(length * k, 2.0 * line, 0);
    }
  }
  soup.vertices.resize(3, points.size());
  for (size_t v = 0; v < points.size(); ++v) soup.vertices.col(v) = points[v];
  return soup;
}

void ExpectGroup(const Texts& texts, const std::string& times, const std::string& number,
                 const std::string& groups, const std::string& names) {
  ExpectFindings(texts,
                 {{"vertex-order", kFiles, times + " times (" + number, groups + "): " + names}});
}

TEST(CheckSameMeshMessagesTest, EightVerticesWhoseEdgesStretchFivefoldAreAGroup) {
  const auto told = [](int segments, double stretch) {
    return TextsOf(Lines({segments}, {1}), Lines({segments}, {stretch}));
  };
  const std::string names = "vertex 102, vertex 103, vertex 104 and ";
  EXPECT_EQ(told(6, 5.5), Texts());
  EXPECT_EQ(told(7, 4.9), Texts());
  ExpectGroup(told(7, 5.1), "5.1", "8", "1", names + "5 more");
  ExpectGroup(told(8, 0.125), "8", "9", "1", names + "6 more");
}

TEST(CheckSameMeshMessagesTest, GroupsAreCountedAndTheLargestFactorIsTold) {
  const std::vector<int> counts = {7, 3, 9, 10};
  const std::vector<double> none = {1, 1, 1, 1};
  const std::string names = "vertex 102, vertex 103, vertex 104 and 26 more";
  for (const std::vector<double>& stretch :
       {std::vector<double>{6, 40, 0.05, 8}, {20, 40, 1 / 6.0, 8}, {8, 40, 6, 20}}) {
    const Soup before = Lines(counts, none), after = Lines(counts, stretch);
    ExpectGroup(TextsOf(before, after), "20", "29", "3", names);
    // Relative to all of the body, which has other units.
    Soup scaled = after;
    scaled.vertices *= 3;
    const Texts texts = TextsOf(before, scaled);
    ASSERT_EQ(texts.size(), 2u);
    ExpectGroup({texts[1]}, "20", "29", "3", names);
    ExpectGroup(TextsOf(after, before), "20", "29", "3", names);
  }
}

TEST(CheckSameMeshMessagesTest, EdgesThatCollapseCountAsAMillionthOfTheMedianLength) {
  const std::string names = "vertex 102, vertex 103, vertex 104 and 5 more";
  const Soup before = Lines({7, 8}, {1, 0}), after = Lines({7, 8}, {0, 0});
  ExpectGroup(TextsOf(before, after), "1e+06", "8", "1", names);
  ExpectGroup(TextsOf(after, before), "1e+06", "8", "1", names);
  Soup scaled = after;
  scaled.vertices *= 1.5;
  ExpectGroup(TextsOf(before, scaled), "1e+06", "8", "1", names);
}

/// A line of segments of length 1 between vertices 0 ... count - 1.
Soup Line(int count) {
  Soup line;
  line.vertices = Shape::Zero(3, count);
  for (int v = 0; v < count; ++v) line.vertices(0, v) = v;
  for (int v = 0; v + 1 < count; ++v) line.segments.emplace_back(v, v + 1);
  return line;
}

TEST(CheckSameMeshMessagesTest, EdgesLongerAgainstTheWholeTellThatMostVerticesAreElsewhere) {
  // The remainders of the ninth powers of all numbers below 23 are these numbers in another order,
  // in which the median of the differences is 5. The whole has the same size.
  const Soup line = Line(23);
  for (const double scale : {1.0, 0.01}) {
    Soup pose = line;
    for (int v = 0; v < 23; ++v) {
      int power = 1;
      for (int k = 0; k < 9; ++k) power = power * v % 23;
      pose.vertices(0, v) = scale * power + 7;
    }
    ExpectFindings(TextsOf(line, pose), {{"vertex-order", kFiles, "5 times"}});
  }
  // If most edges are longer by the same factor, that may be a body rolled up.
  Soup rolled = Line(21);
  for (int v = 0; v < 21; ++v) rolled.vertices(0, v) = v * 8 % 21;
  ExpectFindings(TextsOf(Line(21), rolled), {{"other-units", kFiles, "8 times"}});
}

}  // namespace
}  // namespace shapespace
