#include <limits>

#include <shapespace/mesh/check.h>

#include "mesh/bodies.h"
#include "mesh/files.h"

namespace shapespace {
namespace {

using testing::Cube;
using testing::Grid;
using testing::MakeSoup;

/// The one finding of this kind; fails if there is none, or more than one.
Finding Only(const std::vector<Finding>& findings, const std::string& kind) {
  Finding result{Severity::kNote, "", "", ""};
  int count = 0;
  for (const Finding& finding : findings) {
    if (finding.kind != kind) continue;
    result = finding;
    ++count;
  }
  EXPECT_EQ(count, 1) << kind;
  return result;
}

void ExpectFinding(const Soup& soup, const std::string& kind, Severity severity,
                   const std::vector<std::string>& parts) {
  const Finding finding = Only(CheckSoup(soup), kind);
  EXPECT_EQ(finding.severity, severity);
  EXPECT_EQ(finding.option, severity == Severity::kNonManifold ? "allow_nonmanifold" : "");
  for (const std::string& part : parts) {
    EXPECT_NE(finding.message.find(part), std::string::npos)
        << "no '" << part << "' in: " << finding.message;
  }
}

std::vector<std::string> Kinds(const std::vector<Finding>& findings) {
  std::vector<std::string> kinds;
  for (const Finding& finding : findings) kinds.push_back(finding.kind);
  return kinds;
}

using ListOfNames = std::vector<std::string>;
const ListOfNames kNotes = {"components", "boundary-loops", "genus"};

/// `soup` with line numbers: element i of each kind is on line 100 + i or so.
Soup WithLines(Soup soup) {
  soup.file = "pose.obj";
  for (int v = 0; v < soup.NumVertices(); ++v) soup.vertex_line.push_back(100 + v);
  for (int p = 0; p < soup.NumPolygons(); ++p) soup.polygon_line.push_back(200 + p);
  return soup;
}

TEST(CheckTest, HealthyMeshesHaveNotesOnly) {
  EXPECT_EQ(Kinds(CheckSoup(Cube())), kNotes);
  EXPECT_EQ(Kinds(CheckSoup(testing::Torus(5, 4))), kNotes);
  EXPECT_NE(Only(CheckSoup(testing::Torus(5, 4)), "genus").message.find("genus 1"),
            std::string::npos);
  ExpectFinding(Grid(3, 2), "boundary-loops", Severity::kNote,
                {"boundary loops (1): 10 edges of length 10"});
}

TEST(CheckTest, NothingInIt) {
  EXPECT_EQ(Kinds(CheckSoup(Soup())), (ListOfNames{"no-vertices", "no-elements"}));
  ExpectFinding(WithLines(MakeSoup(Shape::Random(3, 4), {})), "no-elements", Severity::kFatal,
                {"pose.obj", "no polygons and no segments"});
}

TEST(CheckTest, BrokenStructureIsFatalAndNothingElseIsTold) {
  Soup soup = WithLines(Cube());
  soup.corners[5] = 8;
  soup.corners[9] = -1;
  ExpectFinding(soup, "index-out-of-range", Severity::kFatal,
                {"pose.obj", "(2)", "polygon 2 (line 201), polygon 3 (line 202)"});
  EXPECT_EQ(CheckSoup(soup).size(), 1u);

  soup = WithLines(Cube());
  soup.polygon_begin[1] = 2;
  ExpectFinding(soup, "bad-structure", Severity::kFatal, {"polygon 1 (line 200)"});
  soup.polygon_begin[1] = 99;
  ExpectFinding(soup, "bad-structure", Severity::kFatal, {"polygon_begin"});
  soup = Cube();
  soup.segments = {{0, 1}, {0, 8}};
  ExpectFinding(soup, "index-out-of-range", Severity::kFatal, {"segment 2"});
}

TEST(CheckTest, NonFiniteCoordinates) {
  Soup soup = WithLines(Cube());
  soup.vertices(2, 6) = std::numeric_limits<double>::quiet_NaN();
  soup.vertices(0, 3) = std::numeric_limits<double>::infinity();
  ExpectFinding(soup, "non-finite-coordinate", Severity::kFatal,
                {"pose.obj", "(2): vertex 4 (line 103), vertex 7 (line 106)"});
}

TEST(CheckTest, CoordinatesWhoseSquaresWouldBeNoNumbers) {
  for (const double far : {1e150, -1e307}) {
    Soup soup = WithLines(Cube());
    soup.vertices(1, 4) = far;
    ExpectFinding(soup, "coordinate-out-of-range", Severity::kFatal,
                  {"pose.obj", "1e+60", "(1): vertex 5 (line 104)", "another unit"});
  }
  Soup tiny = WithLines(Cube());
  tiny.vertices *= 1e-150;
  ExpectFinding(tiny, "coordinate-out-of-range", Severity::kFatal, {"only 1e-150 in size"});
  tiny.vertices *= 1e100;
  EXPECT_TRUE(CheckSoup(tiny).front().severity == Severity::kNote);
}

TEST(CheckTest, DegeneratePolygons) {
  Shape vertices(3, 4);
  vertices << 0, .1, .3, 0, 0, .1, .3, 1, 0, .1, .3, 0;
  const Soup collinear = WithLines(MakeSoup(vertices, {{0, 1, 2}, {0, 2, 3}}));
  ExpectFinding(collinear, "zero-area", Severity::kWarning, {"(1): polygon 1 (line 200)"});

  Soup coincident = WithLines(Grid(1, 1));
  coincident.vertices.col(1) = coincident.vertices.col(0);
  ExpectFinding(coincident, "zero-length-edge", Severity::kWarning,
                {"(1): a side of polygon 2 (line 201)"});

  // A sliver with an angle of a millionth of a degree is still a triangle.
  vertices << 0, 1, .5, .5, 0, 0, 1e-8, -1, 0, 0, 0, 0;
  EXPECT_EQ(Kinds(CheckSoup(MakeSoup(vertices, {{0, 1, 2}, {1, 0, 3}}))), kNotes);

  // So are much thinner ones; only rounding is no area.
  for (const auto& [height, has_area] : {std::make_pair(1e-10, true), {1e-14, false}}) {
    for (const double scale : {1e-6, 1.0, 1e6}) {
      vertices(1, 2) = height;
      const Soup thin = MakeSoup(scale * vertices, {{0, 1, 2}, {1, 0, 3}});
      EXPECT_EQ(Kinds(CheckSoup(thin)) == kNotes, has_area) << height << " times " << scale;
    }
  }

  const Soup repeated =
      WithLines(MakeSoup(Shape::Random(3, 5), {{0, 1, 2}, {2, 1, 3, 3}, {3, 1, 4}}));
  ExpectFinding(repeated, "repeated-corner", Severity::kNonManifold,
                {"(1): polygon 2 (line 201)", "or allow it"});
}

TEST(CheckTest, RepeatedPolygonsWhateverTheirWinding) {
  const Soup soup = WithLines(
      MakeSoup(Shape::Random(3, 6), {{0, 1, 2}, {3, 4, 5}, {1, 2, 0}, {5, 4, 3}, {0, 1, 3}}));
  ExpectFinding(soup, "repeated-polygon", Severity::kNonManifold,
                {"(2): polygon 3 (line 202) repeats polygon 1 (line 200), polygon 4 (line 203) "
                 "repeats polygon 2 (line 201)",
                 "or allow it"});
}

TEST(CheckTest, NonManifoldEdge) {
  const Soup soup = WithLines(MakeSoup(Shape::Random(3, 5), {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}}));
  ExpectFinding(soup, "non-manifold-edge", Severity::kNonManifold,
                {"(1): edge 1-2 of polygon 1 (line 200), polygon 2 (line 201) and polygon 3 "
                 "(line 202)",
                 "or allow it"});
}

TEST(CheckTest, NonManifoldVertex) {
  const Soup soup = WithLines(MakeSoup(Shape::Random(3, 5), {{0, 1, 2}, {0, 3, 4}}));
  ExpectFinding(soup, "non-manifold-vertex", Severity::kNonManifold,
                {"(1): vertex 1 (line 100)", "or allow it"});
}

TEST(CheckTest, InconsistentWinding) {
  Soup soup = WithLines(Cube());
  std::swap(soup.corners[1], soup.corners[3]);
  ExpectFinding(soup, "inconsistent-winding", Severity::kNonManifold,
                {"(4): edge 1-2 of polygon 1 (line 200) and polygon 3 (line 202)", "and 1 more",
                 "or allow it"});
}

TEST(CheckTest, UnreferencedVertices) {
  Soup soup = WithLines(MakeSoup(Shape::Random(3, 9), {{0, 1, 2}}));
  soup.segments = {{4, 5}};
  soup.segment_line = {300};
  ExpectFinding(soup, "unreferenced-vertex", Severity::kWarning,
                {"(4): vertex 4 (line 103), vertex 7 (line 106), vertex 8 (line 107) and 1 more"});
  ExpectFinding(soup, "components", Severity::kNote, {"components (2), of vertices: 3, 2"});
}

TEST(CheckTest, Segments) {
  Soup soup = WithLines(MakeSoup(Shape::Random(3, 3), {}));
  soup.segments = {{0, 1}, {2, 2}};
  soup.segment_line = {300, 301};
  ExpectFinding(soup, "degenerate-segment", Severity::kFatal, {"(1): segment 2 (line 301)"});
  soup.segments[1] = {1, 2};
  EXPECT_EQ(Kinds(CheckSoup(soup)), (ListOfNames{"components"}));
}

TEST(CheckTest, FindingsFallInSeverity) {
  Soup soup = MakeSoup(Shape::Random(3, 8), {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}, {5, 6, 6}});
  soup.vertices(0, 0) = std::nan("");
  const std::vector<Finding> findings = CheckSoup(soup);
  EXPECT_EQ(Kinds(findings), (ListOfNames{"non-finite-coordinate", "repeated-corner",
                                          "non-manifold-edge", "unreferenced-vertex"}));
}

}  // namespace
}  // namespace shapespace
