#include <cmath>
#include <limits>

#include <gtest/gtest.h>

#include <shapespace/mesh/check.h>

#include "mesh/bodies.h"
#include "mesh/findings.h"

// Findings about one mesh: what they name.

namespace shapespace {
namespace {

using testing::Cube;
using testing::ExpectFindings;
using testing::Grid;
using testing::MakeSoup;

using Texts = std::vector<std::string>;

/// The soup as a part of a file: vertices begin at line 100, polygons at 200, segments at 300.
Soup InFile(Soup soup) {
  soup.file = "pose.obj";
  soup.name = "left";
  for (int v = 0; v < soup.NumVertices(); ++v) soup.vertex_line.push_back(100 + v);
  for (int p = 0; p < soup.NumPolygons(); ++p) soup.polygon_line.push_back(200 + p);
  for (size_t s = 0; s < soup.segments.size(); ++s) {
    soup.segment_line.push_back(300 + static_cast<int>(s));
  }
  return soup;
}

/// "kind: message" of every finding.
Texts TextsOf(const Soup& soup) {
  Texts texts;
  for (const Finding& finding : CheckSoup(soup)) {
    texts.push_back(finding.kind + ": " + finding.message);
  }
  return texts;
}

Texts Kinds(const Soup& soup) {
  Texts kinds;
  for (const Finding& finding : CheckSoup(soup)) kinds.push_back(finding.kind);
  return kinds;
}

/// Four polygons of 3, 4, 5 and 6 corners that have nothing in common, with these circumferences:
/// 12, 14, 28 and 60.25. The first `count` of them.
Soup Islands(int count) {
  const std::vector<std::vector<Eigen::Vector2d>> outlines = {
      {{0, 0}, {3, 0}, {0, 4}},
      {{0, 0}, {2, 0}, {2, 5}, {0, 5}},
      {{0, 0}, {6, 0}, {6, 3}, {6, 8}, {0, 8}},
      {{0, 0}, {10.125, 0}, {10.125, 3}, {10.125, 20}, {0, 20}, {0, 7}}};
  std::vector<Eigen::Vector3d> points;
  std::vector<std::vector<int>> polygons;
  for (int i = 0; i < count; ++i) {
    polygons.emplace_back();
    for (const Eigen::Vector2d& corner : outlines[i]) {
      polygons.back().push_back(static_cast<int>(points.size()));
      points.emplace_back(corner.x(), corner.y(), 7.0 * i - 3);
    }
  }
  Shape vertices(3, points.size());
  for (size_t v = 0; v < points.size(); ++v) vertices.col(v) = points[v];
  return MakeSoup(vertices, polygons);
}

TEST(CheckMessagesTest, UpToThreeComponentsAndLoopsAreListedAndMoreAreCounted) {
  const std::string loops = "3 edges of length 12, 4 edges of length 14, 5 edges of length 28";
  ExpectFindings(TextsOf(InFile(Islands(3))), {{"components", "pose.obj:left:", "(3)", "5, 4, 3"},
                                               {"boundary-loops", "pose.obj:left:", "(3)", loops},
                                               {"genus", "pose.obj:left:", "genus 0"}});
  ExpectFindings(TextsOf(InFile(Islands(4))), {{"components", "(4)", "6, 5, 4, ..."},
                                               {"boundary-loops", "(4)", loops + ", ..."},
                                               {"genus", "genus 0"}});
  Soup one;
  one.vertices = Islands(4).vertices.rightCols(6);
  one.corners = {0, 1, 2, 3, 4, 5};
  one.polygon_begin = {0, 6};
  ExpectFindings({TextsOf(one).at(1)},
                 {{"boundary-loops", "mesh:", "(1): 6 edges of length 60.2"}});
  ExpectFindings(TextsOf(Cube()), {{"components", "mesh:", "(1)", "8"},
                                   {"boundary-loops", "mesh:", "(0)"},
                                   {"genus", "mesh:", "genus 0"}});
}

/// Triangles that fan out from their common edge, between vertices 2 and 5.
Soup Book(int pages) {
  Shape vertices(3, 5 + pages);
  std::vector<std::vector<int>> polygons;
  std::vector<int> outer = {0, 2, 3};
  for (int i = 0; i < pages; ++i) outer.push_back(5 + i);
  for (int v = 0; v < vertices.cols(); ++v) vertices.col(v) << std::sin(v), std::cos(3 * v), v;
  for (int i = 0; i < pages; ++i) {
    polygons.push_back(i % 2 == 0 ? std::vector<int>{1, 4, outer[i]}
                                  : std::vector<int>{4, 1, outer[i]});
  }
  return MakeSoup(vertices, polygons);
}

TEST(CheckMessagesTest, ThePolygonsAtAnEdgeAreNamedUpToFour) {
  const std::string begin =
      "edge 2-5 of polygon 1 (line 200), polygon 2 (line 201), polygon 3 (line 202)";
  ExpectFindings({TextsOf(InFile(Book(4))).at(0)},
                 {{"non-manifold-edge", "(1)", begin + " and polygon 4 (line 203);"}});
  ExpectFindings({TextsOf(InFile(Book(5))).at(0)},
                 {{"non-manifold-edge", "(1)", begin + ", polygon 4 (line 203), ..."}});
  // Neither is it wound inconsistently, nor a manifold of which more could be said.
  EXPECT_EQ(Kinds(Book(3)), (Texts{"non-manifold-edge", "unreferenced-vertex", "components"}));
  EXPECT_EQ(Kinds(Book(2)),
            (Texts{"unreferenced-vertex", "components", "boundary-loops", "genus"}));
}

TEST(CheckMessagesTest, WhatIsNoManifoldIsToldWithItsRemedy) {
  Shape vertices(3, 7);
  vertices << 0, 3, 0, 5, 1, 6, 9, 0, 0, 2, 4, 7, 5, 9, 0, 1, 0, 2, 8, 4, 1;
  const Soup touching = InFile(MakeSoup(vertices, {{6, 0, 1}, {6, 2, 3}}));
  ExpectFindings(TextsOf(touching),
                 {{"non-manifold-vertex", "pose.obj:left:", "(1): vertex 7 (line 106)"},
                  {"unreferenced-vertex", "(2): vertex 5 (line 104), vertex 6 (line 105)"},
                  {"components", "(1)", "5"}});
  const Soup against = InFile(MakeSoup(vertices.leftCols(4), {{0, 1, 2}, {1, 2, 3}}));
  ExpectFindings(TextsOf(against),
                 {{"inconsistent-winding", "pose.obj:left:",
                   "(1): edge 2-3 of polygon 1 (line 200) and polygon 2 (line 201)"},
                  {"components", "(1)", "4"}});
}

TEST(CheckMessagesTest, APolygonThatRepeatsACornerIsNoSeparatePart) {
  Shape vertices(3, 4);
  vertices << 0, 3, 0, 5, 0, 0, 2, 4, 0, 1, 0, 2;
  // The corner follows itself within the list, or from its end to its beginning.
  for (const std::vector<int>& polygon : {std::vector<int>{2, 1, 3, 3}, {3, 2, 1, 3}}) {
    ExpectFindings(TextsOf(InFile(MakeSoup(vertices, {{0, 1, 2}, polygon}))),
                   {{"repeated-corner", "(1): polygon 2 (line 201)"},
                    {"zero-length-edge", "(1)", "side of polygon 2 (line 201)"},
                    {"components", "(1)", "4"}});
  }
}

TEST(CheckMessagesTest, EveryCopyOfAPolygonRepeatsTheOneBeforeInTheOrderOfTheFile) {
  Shape vertices(3, 6);
  vertices << 0, 3, 0, 5, 1, 6, 0, 0, 2, 4, 7, 5, 0, 1, 0, 2, 8, 4;
  const Soup soup = InFile(
      MakeSoup(vertices, {{0, 1, 2}, {3, 4, 5}, {4, 5, 3}, {2, 1, 0}, {1, 2, 0}, {0, 1, 2}}));
  ExpectFindings({TextsOf(soup).at(0)},
                 {{"repeated-polygon", "(4)", "polygon 3 (line 202) repeats polygon 2 (line 201)",
                   "polygon 4 (line 203) repeats polygon 1 (line 200)",
                   "polygon 5 (line 204) repeats polygon 4 (line 203) and 1 more"}});
}

TEST(CheckMessagesTest, WhatHasNoExtentIsFoundFarFromTheOrigin) {
  const Eigen::Vector3d far(129140163, 43046721, -71744535), along(0.125, 0.375, 0.625);
  Soup soup;
  soup.vertices.resize(3, 6);
  soup.vertices << far, far + along, far + 3 * along, far + Eigen::Vector3d(0, 1, 0),
      far + Eigen::Vector3d(0, 2, 5), far + Eigen::Vector3d(0, 2, 5);
  soup.corners = {0, 1, 3, 0, 1, 2};
  soup.polygon_begin = {0, 3, 6};
  soup.segments = {{3, 4}, {4, 5}, {5, 2}};
  const Texts texts = TextsOf(InFile(soup));
  ASSERT_GE(texts.size(), 2u);
  ExpectFindings({texts.end() - 3, texts.end() - 1},
                 {{"zero-length-edge", "(1): segment 2 (line 301)"},
                  {"zero-area", "(1): polygon 2 (line 201)"}});
}

TEST(CheckMessagesTest, SegmentsThatJoinAVertexToItselfAreTakenOut) {
  Soup soup;
  soup.vertices = Cube().vertices.leftCols(3);
  soup.segments = {{0, 1}, {2, 2}, {1, 2}, {1, 1}};
  ExpectFindings({TextsOf(InFile(soup)).at(0)},
                 {{"degenerate-segment", "(2): segment 2 (line 301), segment 4 (line 303)"}});
  EXPECT_EQ(CheckSoup(soup).front().severity, Severity::kFatal);
}

TEST(CheckMessagesTest, CoordinatesMayBeAsLargeAsTheLimitOnBothSides) {
  Soup soup = InFile(Cube());
  soup.vertices(0, 1) = kLargestCoordinate;
  soup.vertices(2, 4) = -kLargestCoordinate;
  for (const std::string& kind : Kinds(soup)) EXPECT_NE(kind, "coordinate-out-of-range");
  soup.vertices(2, 4) *= 1.001;
  soup.vertices(1, 6) = std::numeric_limits<double>::quiet_NaN();
  ExpectFindings(TextsOf(soup), {{"non-finite-coordinate", "(1): vertex 7 (line 106)"},
                                 {"coordinate-out-of-range", "1e+60", "(1): vertex 5 (line 104)"}});
}

TEST(CheckMessagesTest, TheLargestExtentDecidesWhetherAMeshIsTooSmall) {
  Soup sheet = InFile(Grid(3, 1));
  sheet.vertices *= 1e-70;
  ExpectFindings(TextsOf(sheet), {{"coordinate-out-of-range", "3e-70", "1e-60"}});
  sheet.vertices.row(1) *= 1e11;  // 1e-59
  for (const std::string& kind : Kinds(sheet)) EXPECT_NE(kind, "coordinate-out-of-range");
  sheet.vertices.setConstant(3);  // a point has no size that a unit would change
  for (const std::string& kind : Kinds(sheet)) EXPECT_NE(kind, "coordinate-out-of-range");
}

TEST(CheckMessagesTest, EachWayInWhichPolygonsCannotBeReadIsTold) {
  Soup soup = InFile(Grid(1, 1));
  for (const std::vector<int>& begin :
       {std::vector<int>{}, {1, 3, 6}, {0, 3, 5}, {0, 3, 7}, {0, 4, 3, 6}}) {
    soup.polygon_begin = begin;
    SCOPED_TRACE(begin.size());
    ExpectFindings(TextsOf(soup), {{"bad-structure", "pose.obj:left:", "polygon_begin"}});
  }
  soup.polygon_begin = {0, 2, 6, 6};
  ExpectFindings(TextsOf(soup), {{"bad-structure", "(2): polygon 1 (line 200), polygon 3;"}});
  soup = Grid(1, 1);
  soup.corners[4] = 4;
  soup.segments = {{0, 3}, {-1, 2}, {2, 3}, {1, 4}};
  ExpectFindings(TextsOf(InFile(soup)),
                 {{"index-out-of-range",
                   "(3): polygon 2 (line 201), segment 2 (line 301), segment 4 (line 303)"}});
  soup.vertices.resize(3, 0);
  EXPECT_EQ(Kinds(soup), (Texts{"no-vertices", "index-out-of-range"}));
  ExpectFindings(TextsOf(Soup()), {{"no-vertices", "mesh:"}, {"no-elements", "mesh:"}});
}

}  // namespace
}  // namespace shapespace
