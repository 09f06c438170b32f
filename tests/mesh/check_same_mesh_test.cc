#include <algorithm>
#include <numeric>
#include <random>

#include <gtest/gtest.h>
#include <Eigen/Geometry>

#include <shapespace/mesh/check.h>

#include "mesh/bodies.h"

namespace shapespace {
namespace {

using testing::Grid;
using testing::Torus;

Soup Named(Soup soup, const std::string& file, int first_line) {
  soup.file = file;
  for (int p = 0; p < soup.NumPolygons(); ++p) soup.polygon_line.push_back(first_line + p);
  return soup;
}

/// Expects exactly one finding, with these words in it.
void ExpectOnly(const Soup& reference, const Soup& pose, const std::string& kind, Severity severity,
                const std::vector<std::string>& parts) {
  const std::vector<Finding> findings = CheckSameMesh(reference, pose);
  ASSERT_EQ(findings.size(), 1u) << kind;
  EXPECT_EQ(findings[0].kind, kind);
  EXPECT_EQ(findings[0].severity, severity);
  EXPECT_EQ(findings[0].option, severity == Severity::kMirrored   ? "mirror"
                                : severity == Severity::kDoubtful ? "allow_mismatch"
                                                                  : "");
  for (const std::string& part : parts) {
    EXPECT_NE(findings[0].message.find(part), std::string::npos)
        << "no '" << part << "' in: " << findings[0].message;
  }
}

std::vector<int> Shuffled(int n, int first, int last) {
  std::vector<int> order(n);
  std::iota(order.begin(), order.end(), 0);
  std::shuffle(order.begin() + first, order.begin() + last, std::mt19937(3));
  return order;
}

/// The same mesh with vertex v renamed to[v].
Soup Renumbered(const Soup& soup, const std::vector<int>& to) {
  Soup result = soup;
  for (int v = 0; v < soup.NumVertices(); ++v) result.vertices.col(to[v]) = soup.vertices.col(v);
  for (int& v : result.corners) v = to[v];
  return result;
}

TEST(CheckSameMeshTest, MotionsAndBendsAreFine) {
  const Soup grid = Grid(20, 20);
  Soup pose = grid;
  const Eigen::Matrix3d turn(Eigen::AngleAxisd(1.0, Eigen::Vector3d(1, 2, 3).normalized()));
  pose.vertices = turn * grid.vertices;
  EXPECT_TRUE(CheckSameMesh(grid, pose).empty());
  for (int v = 0; v < grid.NumVertices(); ++v) {  // rolled up three times
    const double angle = 0.9 * grid.vertices(0, v);
    pose.vertices.col(v) << std::sin(angle) / 0.9, grid.vertices(1, v), std::cos(angle) / 0.9;
  }
  EXPECT_TRUE(CheckSameMesh(grid, pose).empty());
}

TEST(CheckSameMeshTest, CountsThatDiffer) {
  const std::vector<Finding> findings =
      CheckSameMesh(Named(Grid(2, 2), "a.obj", 1), Named(Grid(3, 2), "b.obj", 1));
  ASSERT_EQ(findings.size(), 2u);
  EXPECT_EQ(findings[0].kind, "vertex-count");
  EXPECT_EQ(findings[0].severity, Severity::kFatal);
  EXPECT_NE(findings[0].message.find("b.obj against a.obj: 12 vertices instead of 9"),
            std::string::npos);
  EXPECT_NE(findings[0].message.find("keep vertex order"), std::string::npos);
  EXPECT_EQ(findings[1].kind, "polygon-count");
}

TEST(CheckSameMeshTest, TheFirstPolygonThatDiffersIsNamedInBothFiles) {
  const Soup a = Named(Grid(2, 2), "a.obj", 10);
  Soup b = Named(Grid(2, 2), "b.obj", 50);
  // The first triangle has moved.
  std::copy_n(std::vector<int>{4, 7, 8}.begin(), 3, b.corners.begin());
  ExpectOnly(a, b, "polygons-differ", Severity::kFatal,
             {"b.obj against a.obj", "polygon 1 (line 50) with vertices 5 8 9",
              "polygon 1 (line 10) with 1 4 5", "different meshes"});
}

/// Each polygon cut into triangles from the corner that `first` gives.
template <typename First>
Soup CutFrom(const Soup& soup, const First& first) {
  std::vector<std::vector<int>> triangles;
  for (int p = 0; p < soup.NumPolygons(); ++p) {
    const int begin = soup.polygon_begin[p], size = soup.polygon_begin[p + 1] - begin;
    const auto corner = [&](int k) { return soup.corners[begin + (first(p) + k) % size]; };
    for (int k = 2; k < size; ++k) triangles.push_back({corner(0), corner(k - 1), corner(k)});
  }
  return testing::MakeSoup(soup.vertices, triangles);
}

TEST(CheckSameMeshTest, PolygonsCutAlongOtherDiagonalsAreToldFromOtherMeshes) {
  const Soup torus = Torus(9, 7);
  const Soup cut = CutFrom(torus, [](int) { return 0; });
  const Soup other = CutFrom(torus, [](int) { return 1; });
  const Soup some = CutFrom(torus, [](int p) { return p == 5 || p == 20; });
  const auto recut = [](const Soup& a, const Soup& b, const std::string& kind,
                        const std::string& count) {
    ExpectOnly(a, b, kind, Severity::kFatal, {"diagonals", "(" + count + ")", "triangulation"});
  };
  recut(cut, other, "polygons-differ", "63");
  recut(cut, some, "polygons-differ", "2");
  recut(torus, cut, "polygon-count", "63");
  recut(some, torus, "polygon-count", "63");
  // The polygons may be in another order too.
  Soup shuffled = other;
  std::reverse(shuffled.corners.begin(), shuffled.corners.end());
  recut(cut, shuffled, "polygons-differ", "63");
  // A polygon of seven corners among others, cut into triangles and into other polygons.
  const Soup flower =
      testing::MakeSoup(Shape::Random(3, 9), {{0, 1, 2, 3, 4, 5, 6}, {1, 0, 7}, {2, 1, 7, 8}});
  const Soup triangles = CutFrom(flower, [](int) { return 2; });
  recut(flower, triangles, "polygon-count", "2");
  recut(triangles, CutFrom(flower, [](int p) { return 3 * (p == 0); }), "polygons-differ", "1");
  recut(
      testing::MakeSoup(flower.vertices, {{0, 1, 2, 6}, {2, 3, 4, 5, 6}, {1, 0, 7}, {2, 1, 7, 8}}),
      triangles, "polygon-count", "3");
}

TEST(CheckSameMeshTest, OtherSurfacesAreNotTakenForOtherDiagonals) {
  const auto lacks = [](const Soup& a, const Soup& b) {
    for (const Finding& finding : CheckSameMesh(a, b)) {
      EXPECT_EQ(finding.message.find("diagonals"), std::string::npos) << finding.message;
    }
  };
  const Soup torus = Torus(9, 7);
  lacks(torus, Renumbered(torus, Shuffled(63, 0, 63)));
  const Soup cut = CutFrom(torus, [](int) { return 0; });
  lacks(cut, Renumbered(cut, Shuffled(63, 10, 40)));
  // Of one quad only one half is there.
  Soup hole = CutFrom(torus, [](int) { return 1; });
  hole.corners.resize(hole.corners.size() - 3);
  hole.polygon_begin.pop_back();
  lacks(cut, hole);
  lacks(torus, hole);
  // All edges differ: the rest, without any border, is no polygon.
  const Shape vertices = Shape::Random(3, 8);
  lacks(testing::MakeSoup(vertices, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {1, 3, 2}}),
        testing::MakeSoup(vertices, {{4, 5, 6}, {4, 6, 7}, {4, 7, 5}, {5, 7, 6}}));
}

TEST(CheckSameMeshTest, RenumberedVerticesAreRecognised) {
  const Soup torus = Named(Torus(9, 7), "a.obj", 10);
  const Soup renumbered = Renumbered(torus, Shuffled(63, 0, 63));
  ExpectOnly(torus, renumbered, "polygons-differ", Severity::kFatal,
             {"but the vertices are not", "keep vertex order"});
  Soup both = renumbered;
  std::reverse(both.corners.begin(), both.corners.end());
  ExpectOnly(torus, both, "polygons-differ", Severity::kFatal,
             {"looks like the same mesh with its vertices in another order"});
}

// No polygon uses the first vertex.
TEST(CheckSameMeshTest, TheFirstVertexOfAnotherNumberIsNamed) {
  Soup mesh;
  mesh.vertices = Grid(2, 1).vertices;
  mesh.corners = {1, 2, 5, 4};
  mesh.polygon_begin = {0, 4};
  Soup pose = mesh;
  pose.corners = {1, 2, 4, 5};
  ExpectOnly(Named(mesh, "a.obj", 1), Named(pose, "b.obj", 1), "polygons-differ", Severity::kFatal,
             {"the reference's vertex 5 is number 6 here"});
}

TEST(CheckSameMeshTest, OrderAndFirstCornerOfPolygonsDoNotMatter) {
  const Soup torus = Torus(9, 7);
  Soup pose = torus;
  std::rotate(pose.corners.begin(), pose.corners.begin() + 4, pose.corners.end());
  ExpectOnly(torus, pose, "polygon-order", Severity::kWarning, {"another order"});
  pose = torus;
  std::rotate(pose.corners.begin(), pose.corners.begin() + 1, pose.corners.begin() + 4);
  ExpectOnly(torus, pose, "polygon-order", Severity::kWarning, {"begin at other corners"});
}

TEST(CheckSameMeshTest, MirroredWindingIsAWarning) {
  const Soup torus = Torus(9, 7);
  Soup pose = torus;
  std::reverse(pose.corners.begin(), pose.corners.end());
  ExpectOnly(torus, pose, "polygon-winding", Severity::kWarning, {"(63)", "mirror"});
}

TEST(CheckSameMeshTest, DoubleSidedPolygonsInAnotherOrderAreNotWoundTheOtherWay) {
  Soup sheet = Grid(5, 4);
  const std::vector<int> front = sheet.corners;
  for (size_t k = 0; k < front.size(); k += 3) {
    sheet.corners.insert(sheet.corners.end(), {front[k], front[k + 2], front[k + 1]});
    sheet.polygon_begin.push_back(static_cast<int>(sheet.corners.size()));
  }
  Soup pose = sheet;  // its backs first
  std::rotate(pose.corners.begin(), pose.corners.begin() + front.size(), pose.corners.end());
  ExpectOnly(sheet, pose, "polygon-order", Severity::kWarning, {"another order"});
  // One front turned to the back: two backs there, and no front.
  std::swap(pose.corners[pose.corners.size() - 1], pose.corners[pose.corners.size() - 2]);
  ExpectOnly(sheet, pose, "polygon-winding", Severity::kWarning, {"(1)"});
}

TEST(CheckSameMeshTest, MirrorImagesOfClosedBodiesAreRefused) {
  const Soup torus = Torus(9, 7);
  for (int axis = 0; axis < 3; ++axis) {
    Soup pose = torus;
    pose.vertices.row(axis) *= -1;
    ExpectOnly(torus, pose, "mirrored", Severity::kMirrored, {"mirror image", "flipped"});
  }
  Soup turned = torus;
  turned.vertices.topRows(2) *= -1;  // by 180 degrees
  EXPECT_TRUE(CheckSameMesh(torus, turned).empty());
}

TEST(CheckSameMeshTest, Segments) {
  Soup a;
  a.vertices = Shape::Random(3, 4);
  a.segments = {{0, 1}, {1, 2}, {2, 3}};
  Soup b = a;
  b.segments = {{2, 1}, {0, 1}, {3, 2}};
  EXPECT_TRUE(CheckSameMesh(a, b).empty());
  b.segments[1] = {0, 2};
  ExpectOnly(a, b, "segments-differ", Severity::kFatal, {"segment 1"});
  b.segments.pop_back();
  ExpectOnly(a, b, "segment-count", Severity::kFatal, {"2 segments instead of 3"});
}

TEST(CheckSameMeshTest, OtherUnits) {
  const Soup torus = Torus(9, 7);
  Soup pose = torus;
  pose.vertices *= 1000.0;
  ExpectOnly(torus, pose, "other-units", Severity::kDoubtful, {"1e+03 times"});
  ExpectOnly(pose, torus, "other-units", Severity::kDoubtful, {"0.001 times"});
  // Feet and yards, metres and feet; and bodies that grow.
  pose.vertices = 3.3 * torus.vertices;
  ExpectOnly(torus, pose, "other-units", Severity::kWarning, {"3.3 times"});
}

TEST(CheckSameMeshTest, PositionsInAnotherOrderAreFoundInAnyUnits) {
  const Soup grid = Grid(60, 60);
  for (const double scale : {1.0, 25.4}) {
    Soup pose = grid;
    pose.vertices *= scale;
    const std::vector<int> order = Shuffled(61 * 61, 1000, 1400);
    for (int v = 0; v < grid.NumVertices(); ++v) {
      pose.vertices.col(order[v]) = scale * grid.vertices.col(v);
    }
    const std::vector<Finding> findings = CheckSameMesh(grid, pose);
    ASSERT_EQ(findings.size(), scale == 1.0 ? 1u : 2u);
    EXPECT_EQ(findings.back().kind, "vertex-order");
    EXPECT_EQ(findings.back().severity, Severity::kWarning);
    EXPECT_EQ(findings.front().severity, scale == 1.0 ? Severity::kWarning : Severity::kDoubtful);
    EXPECT_NE(findings.back().message.find("in groups: 1)"), std::string::npos)
        << findings.back().message;
    EXPECT_NE(findings.back().message.find("vertex 1001"), std::string::npos)
        << findings.back().message;
  }
}

TEST(CheckSameMeshTest, AllPositionsInAnotherOrderAreFound) {
  const Soup torus = Torus(40, 30);
  Soup pose = torus;
  const std::vector<int> order = Shuffled(1200, 0, 1200);
  for (int v = 0; v < 1200; ++v) pose.vertices.col(order[v]) = 0.01 * torus.vertices.col(v);
  ExpectOnly(torus, pose, "vertex-order", Severity::kDoubtful, {"most vertices"});
}

TEST(CheckSameMeshTest, SingleSliversAreNoGroup) {
  const Soup grid = Grid(30, 30);
  Soup pose = grid;
  pose.vertices.col(400) += Eigen::Vector3d(0, 0, 20);  // six edges 20 times as long
  pose.vertices.col(600) = pose.vertices.col(601);
  EXPECT_TRUE(CheckSameMesh(grid, pose).empty());
}

TEST(CheckSameMeshTest, BrokenSoupsAreReportedNotRead) {
  Soup broken = Grid(2, 2);
  broken.corners[0] = 99;
  ExpectOnly(Grid(2, 2), broken, "index-out-of-range", Severity::kFatal, {"polygon 1"});
  Soup flat = Grid(2, 2);
  flat.vertices.setZero();
  EXPECT_TRUE(CheckSameMesh(Grid(2, 2), flat).empty());
}

}  // namespace
}  // namespace shapespace
