#include <cmath>
#include <functional>
#include <limits>
#include <set>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <shapespace/base/error.h>
#include <shapespace/files/read.h>
#include <shapespace/mesh/check.h>
#include <shapespace/mesh/seams.h>
#include <shapespace/mesh/surface.h>
#include <shapespace/mesh/topology.h>

#include "mesh/bodies.h"
#include "support/cut_body.h"

namespace shapespace {
namespace {

using testing::Connected;
using testing::Cube;
using testing::CutBody;
using testing::CutIntoPolygons;
using testing::Grid;
using testing::MakeSoup;
using testing::Torus;

Seams SeamsOf(const Soup& soup) {
  return FindSeams(soup.polygon_begin, soup.corners, {soup.vertices});
}

Seams SeamsOf(const CutBody& cut, const std::vector<Shape>& whole) {
  std::vector<Shape> poses;
  for (const Shape& pose : whole) poses.push_back(cut.Of(pose));
  return FindSeams(cut.polygon_begin, cut.corners, poses);
}

CutBody CutUp(const Soup& soup) { return CutIntoPolygons(*Connected(soup)); }

// Two squares side by side, which have the edge from (1, 0) to (1, 1) twice.
Soup TwoSquares() {
  Shape vertices(3, 8);
  vertices << 0, 1, 1, 0, 1, 2, 2, 1,  //
      0, 0, 1, 1, 0, 0, 1, 1,          //
      0, 0, 0, 0, 0, 0, 0, 0;
  return MakeSoup(vertices, {{0, 1, 2, 3}, {4, 5, 6, 7}});
}

TEST(FindSeams, JoinsNeighboursAtTheirEdge) {
  const Seams seams = SeamsOf(TwoSquares());
  EXPECT_EQ(seams.representatives, (std::vector<int>{0, 1, 2, 3, 1, 5, 6, 2}));
  EXPECT_EQ(seams.joined, 2);
  EXPECT_EQ(seams.unclear, 0);
}

TEST(FindSeams, LeavesAWholeMeshAsItIs) {
  for (const Soup& soup : {Cube(), Torus(5, 4), Grid(2, 3)}) {
    const Seams seams = SeamsOf(soup);
    EXPECT_TRUE(seams.representatives.empty());
    EXPECT_EQ(seams.joined, 0);
    EXPECT_EQ(seams.unclear, 0);
  }
}

TEST(FindSeams, MakesSoupsWhole) {
  for (const Soup& soup : {Cube(), Torus(5, 4), Grid(2, 3)}) {
    const CutBody cut = CutUp(soup);
    EXPECT_EQ(SeamsOf(cut, {soup.vertices}).representatives, cut.source);
  }
}

TEST(FindSeams, LipsThatOpenInOnePoseStayOpen) {
  const Soup closed = TwoSquares();
  Shape open = closed.vertices;
  open.rightCols(4).row(2).setConstant(0.1);
  for (const std::vector<Shape>& poses :
       {std::vector<Shape>{closed.vertices, open}, {open, closed.vertices}}) {
    const Seams seams = FindSeams(closed.polygon_begin, closed.corners, poses);
    EXPECT_EQ(seams.joined, 0);
    EXPECT_EQ(seams.unclear, 0);
  }
  // Also if one end only moves away.
  open = closed.vertices;
  open(2, 7) = 0.1;
  EXPECT_EQ(FindSeams(closed.polygon_begin, closed.corners, {closed.vertices, open}).joined, 0);
}

TEST(FindSeams, PolygonsThatAreWoundAlikeAreNoNeighbours) {
  Soup soup = TwoSquares();
  soup.corners = {0, 1, 2, 3, 7, 6, 5, 4};
  const Seams seams = SeamsOf(soup);
  EXPECT_EQ(seams.joined, 0);
  EXPECT_EQ(seams.unclear, 1);
}

TEST(FindSeams, WhatTouchesAtAPointIsNotJoined) {
  Soup soup = TwoSquares();
  soup.vertices.rightCols(4).row(1).array() += 1;  // the second square has (1, 1) alone in common
  const Seams seams = SeamsOf(soup);
  EXPECT_EQ(seams.joined, 0);
  EXPECT_EQ(seams.unclear, 0);
}

// Three squares at the edge from (1, 0, 0) to (1, 1, 0): the third stands on the others.
TEST(FindSeams, MoreThanTwoBordersAtAPlaceStayOpen) {
  const Soup two = TwoSquares();
  Shape vertices(3, 12);
  vertices.leftCols(8) = two.vertices;
  vertices.rightCols(4) << 1, 1, 1, 1,  //
      0, 1, 1, 0,                       //
      0, 0, 1, 1;
  const Seams seams = SeamsOf(MakeSoup(vertices, {{0, 1, 2, 3}, {4, 5, 6, 7}, {8, 9, 10, 11}}));
  EXPECT_EQ(seams.joined, 0);
  EXPECT_EQ(seams.unclear, 1);
}

// Bodies without borders have no seams: two cubes of which one stands on the other.
TEST(FindSeams, ClosedBodiesThatTouchStayTwo) {
  const Soup cube = Cube();
  Soup both = cube;
  both.vertices.resize(3, 16);
  both.vertices << cube.vertices, cube.vertices.colwise() + Eigen::Vector3d(0, 0, 1);
  for (const int v : cube.corners) both.corners.push_back(8 + v);
  for (int p = 1; p <= 6; ++p) both.polygon_begin.push_back(24 + 4 * p);
  EXPECT_EQ(SeamsOf(both).joined, 0);
}

// The two sides of a leaf: the same polygons at the same places, wound the other way round.
Soup DoubleSided(const Soup& sheet) {
  Soup both = sheet;
  const int n = sheet.NumVertices();
  both.vertices.resize(3, 2 * n);
  both.vertices << sheet.vertices, sheet.vertices;
  for (int p = 0; p < sheet.NumPolygons(); ++p) {
    for (int k = sheet.polygon_begin[p + 1]; k-- > sheet.polygon_begin[p];) {
      both.corners.push_back(n + sheet.corners[k]);
    }
    both.polygon_begin.push_back(static_cast<int>(both.corners.size()));
  }
  return both;
}

TEST(FindSeams, TheTwoSidesOfASheetAreNoNeighbours) {
  const Soup sides = DoubleSided(Grid(2, 3));
  const Seams seams = SeamsOf(sides);
  EXPECT_EQ(seams.joined, 0);
  EXPECT_EQ(seams.unclear, 0);
  // Each is whole all the same if the file is a soup.
  const CutBody cut = CutUp(sides);
  EXPECT_EQ(SeamsOf(cut, {sides.vertices}).representatives, cut.source);
  EXPECT_EQ(SeamsOf(cut, {sides.vertices}).unclear, 0);
}

// Of the copies of a torus each is moved a little, at random but for the seed.
Shape Shaken(const Shape& shape, double by) {
  std::srand(1);
  return shape + by * Shape::Random(3, shape.cols());
}

TEST(FindSeams, AllowsForRoundingOfExportersAndNotForGaps) {
  const Soup torus = Torus(6, 8);
  const CutBody cut = CutUp(torus);
  const double edge = 2 * std::sin(std::acos(-1.0) / 8);  // the sides of the small circle
  for (const double unit : {1e-9, 1.0, 1e9}) {
    const Shape whole = unit * torus.vertices;
    const auto joined = [&](double share) {
      return FindSeams(cut.polygon_begin, cut.corners, {Shaken(cut.Of(whole), share * unit * edge)})
          .representatives;
    };
    EXPECT_EQ(joined(1e-7), cut.source);
    EXPECT_TRUE(joined(1e-4).empty());
  }
}

// A million units from the origin, a coordinate that is transformed twice differs in its last
// place, which is more than a millionth of a short edge.
TEST(FindSeams, AllowsForTheRoundingOfCoordinatesFarAway) {
  const Soup grid = Grid(3, 3);
  const CutBody cut = CutUp(grid);
  Shape far = cut.Of(Shape(1e-4 * grid.vertices)).colwise() + Eigen::Vector3d(1e6, -1e6, 2e5);
  for (Eigen::Index v = 16; v < far.cols(); ++v) {
    for (double& x : far.col(v)) x = std::nextafter(x, std::numeric_limits<double>::infinity());
  }
  EXPECT_EQ(FindSeams(cut.polygon_begin, cut.corners, {far}).representatives, cut.source);
}

// A large polygon beside small ones does not make small gaps seams.
TEST(FindSeams, EveryEdgeHasATolerance) {
  Shape vertices(3, 9);
  const double far = 1e6, gap = 0.01;
  vertices << 0, 1, 1, 0, 1 + gap, 2, 2, 1 + gap, 0,  //
      0, 0, 1, 1, 0, 0, 1, 1, -far,                   //
      0, 0, 0, 0, 0, 0, 0, 0, 0;
  const Seams seams =
      SeamsOf(MakeSoup(vertices, {{0, 1, 2, 3}, {4, 5, 6, 7}, {1, 0, 8}, {5, 4, 8}}));
  EXPECT_EQ(seams.joined, 0);
}

// A sphere of rectangles, whose rows at the poles have lost a side: its two corners are at one
// place, and must not become one vertex.
TEST(FindSeams, NoPolygonGetsAVertexTwice) {
  constexpr int kRound = 6, kUp = 4;
  const double turn = 2 * std::acos(-1.0);
  Shape vertices(3, (kRound + 1) * (kUp + 1));
  std::vector<std::vector<int>> polygons;
  for (int i = 0; i <= kRound; ++i) {
    for (int j = 0; j <= kUp; ++j) {
      const double u = i == kRound ? 0 : turn * i / kRound, v = turn / 2 * j / kUp;
      const double r = j == 0 || j == kUp ? 0 : std::sin(v);
      vertices.col(i * (kUp + 1) + j) << r * std::cos(u), r * std::sin(u), std::cos(v);
      const int a = i * (kUp + 1) + j, b = a + kUp + 1;
      if (i < kRound && j < kUp) polygons.push_back({a, a + 1, b + 1, b});
    }
  }
  const Soup globe = MakeSoup(vertices, polygons);
  const Seams seams = SeamsOf(globe);
  // The meridian that is there twice.
  for (int j = 1; j < kUp; ++j) EXPECT_EQ(seams.representatives[kRound * (kUp + 1) + j], j);
  for (int p = 0; p < globe.NumPolygons(); ++p) {
    std::set<int> corners;
    for (int k = globe.polygon_begin[p]; k < globe.polygon_begin[p + 1]; ++k) {
      corners.insert(seams.representatives[globe.corners[k]]);
    }
    EXPECT_EQ(corners.size(), 4u);
  }
}

// In a soup, a triangle without a side lies between two others, which are neighbours.
TEST(FindSeams, CollapsedPolygonsFollowTheirNeighbours) {
  Shape vertices(3, 9);
  vertices << 0, 1, 0, 0, 0, 1, 1, 1, 0,  //
      0, 0, 1, 1, 1, 0, 0, 1, 1,          //
      0, 0, 0, 0, 0, 0, 0, 0, 0;
  const Seams seams = SeamsOf(MakeSoup(vertices, {{0, 1, 2}, {3, 5, 4}, {6, 7, 8}}));
  EXPECT_EQ(seams.representatives[6], 1);
  EXPECT_EQ(seams.representatives[8], 2);
  EXPECT_EQ(seams.representatives[5], 1);
  EXPECT_NE(seams.representatives[3], seams.representatives[4]);
  EXPECT_EQ(seams.unclear, 0);
}

TEST(TwinsOfConnectivity, HaveNoElements) {
  for (const Soup& soup : {Cube(), Torus(5, 4), Grid(2, 3)}) {
    const auto whole = Connected(soup);
    const CutBody cut = CutIntoPolygons(*whole);
    const auto joined = testing::Joined(cut, *whole);
    EXPECT_EQ(joined->Triangles(), whole->Triangles());
    EXPECT_EQ(joined->Edges(), whole->Edges());
    EXPECT_EQ(joined->NumTriangleEdges(), whole->NumTriangleEdges());
    EXPECT_EQ(joined->Hinges(), whole->Hinges());
    EXPECT_EQ(joined->FileTriangles(), cut.triangles);
    EXPECT_EQ(joined->Corners(), cut.corners);
    EXPECT_EQ(joined->Twins().size(), cut.source.size() - soup.NumVertices());
    for (const int twin : joined->Twins()) {
      EXPECT_EQ(joined->TrianglesOfVertices()[twin].size(), 0);
      EXPECT_EQ(joined->EdgesOfVertices()[twin].size(), 0);
    }
    const Topology topology = ComputeTopology(*joined), expected = ComputeTopology(*whole);
    EXPECT_EQ(topology.components, expected.components);
    EXPECT_EQ(topology.genus, expected.genus);
    EXPECT_EQ(topology.boundary_loops, expected.boundary_loops);
    for (size_t v = 0; v < cut.source.size(); ++v) {
      EXPECT_EQ(topology.component[v], expected.component[cut.source[v]]);
    }
    const Shape normals = VertexNormals(*joined, cut.Of(soup.vertices));
    EXPECT_EQ(normals, cut.Of(VertexNormals(*whole, soup.vertices)));
  }
}

TEST(TwinsOfConnectivity, AreRepresentedInSegmentsAndStiffeners) {
  const Soup soup = TwoSquares();
  const auto joined =
      Connectivity::Make(8, soup.polygon_begin, soup.corners, {{4, 7}, {5, 7}},
                         {{0, 4}, {1, 4}, {3, 5}}, {}, SeamsOf(soup).representatives);
  // Seven sides, four diagonals, one of which is a segment too, and one stiffener; the segment
  // between the ends of the common side is that side, and what joins a vertex to its twin is none.
  EXPECT_EQ(joined->NumTriangleEdges(), 9);
  EXPECT_EQ(joined->NumEdges(), 12);
  EXPECT_EQ(joined->Segments(), (std::vector<std::pair<int, int>>{{4, 7}, {5, 7}}));
}

TEST(TwinsOfConnectivity, WrongRepresentativesAreRefused) {
  const Soup soup = TwoSquares();
  for (const std::vector<int>& wrong : {std::vector<int>{0, 1},
                                        {0, 1, 2, 3, 8, 5, 6, 7},
                                        {0, 1, 2, 3, -1, 5, 6, 7},
                                        {1, 2, 2, 3, 4, 5, 6, 7}}) {
    EXPECT_THROW(Connectivity::Make(8, soup.polygon_begin, soup.corners, {}, {}, {}, wrong),
                 MeshError);
  }
}

TEST(SeamsOfPoses, AreJoinedWithANoteUnlessTheyAreToStayOpen) {
  const Soup torus = Torus(6, 8);
  const CutBody cut = CutUp(torus);
  Soup soup = cut.AsSoup(torus.vertices);
  soup.vertices = Shaken(soup.vertices, 1e-8);
  const Poses poses = MakePoses({soup, soup});
  EXPECT_EQ(poses.connectivity->Representatives(), cut.source);
  EXPECT_EQ(poses.connectivity->NumVertices(), soup.NumVertices());
  for (const Shape& shape : poses.shapes) EXPECT_TRUE(cut.HasNoGap(shape));
  ASSERT_EQ(poses.notes.size(), 1u);
  const std::string pairs = std::to_string(soup.NumVertices() - torus.NumVertices());
  EXPECT_NE(poses.notes[0].find(pairs), std::string::npos) << poses.notes[0];
  EXPECT_TRUE(poses.warnings.empty());

  ReadOptions options;
  options.open_seams = true;
  options.loose_components = true;  // the pieces are near each other
  const Poses open = MakePoses({soup, soup}, options);
  EXPECT_TRUE(open.connectivity->Twins().empty());
  EXPECT_EQ(open.shapes[0], soup.vertices);
  EXPECT_TRUE(open.notes.empty());
}

TEST(SeamsOfPoses, UnclearOnesAreWarnedOf) {
  Soup soup = TwoSquares();
  soup.corners = {0, 1, 2, 3, 7, 6, 5, 4};
  EXPECT_EQ(MakePoses({soup}).warnings.size(), 1u);
  ReadOptions options;
  options.open_seams = true;
  EXPECT_TRUE(MakePoses({soup}, options).warnings.empty());
}

std::string MessageOfKind(const std::vector<Finding>& findings, const std::string& kind) {
  for (const Finding& finding : findings) {
    if (finding.kind == kind) return finding.message;
  }
  return {};
}

TEST(SeamsOfSoups, AreJoinedInWhatChecksSay) {
  const Soup torus = Torus(6, 8);
  const Soup soup = CutUp(torus).AsSoup(torus.vertices);
  EXPECT_NE(MessageOfKind(CheckSoup(soup), "genus").find("genus 1"), std::string::npos);
  EXPECT_NE(MessageOfKind(CheckSoup(soup), "components").find("(1)"), std::string::npos);
  EXPECT_NE(MessageOfKind(CheckSoup(soup), "boundary-loops").find("(0)"), std::string::npos);
  EXPECT_FALSE(MessageOfKind(CheckSoup(soup), "seams").empty());
  EXPECT_NE(MessageOfKind(CheckSoup(soup, true), "components").find("(48)"), std::string::npos);
  EXPECT_TRUE(MessageOfKind(CheckSoup(soup, true), "seams").empty());
  EXPECT_TRUE(MessageOfKind(CheckSoup(torus), "seams").empty());
}

// Whether a body is closed, and therefore has a mirror image, does not depend on how it is stored.
TEST(SeamsOfSoups, MirrorImagesAreFound) {
  const Soup torus = Torus(6, 8);
  const Soup soup = CutUp(torus).AsSoup(torus.vertices);
  Soup mirrored = soup;
  mirrored.vertices.row(0) *= -1;
  EXPECT_FALSE(MessageOfKind(CheckSameMesh(soup, mirrored), "mirrored").empty());
  Soup back = mirrored;
  EXPECT_TRUE(MirrorBack(soup, 'x', &back));
  EXPECT_EQ(back.vertices, soup.vertices);
}

TEST(SeamsOfSelections, ArePointsOnce) {
  const Soup soup = TwoSquares();
  const Poses poses = MakePoses({soup});
  EXPECT_EQ(RepresentativesOf(*poses.connectivity, {7, 4, 5, 1, 2}), (std::vector<int>{1, 2, 5}));
  EXPECT_EQ(RepresentativesOf(*Connected(soup), {7, 4, 1}), (std::vector<int>{7, 4, 1}));
}

}  // namespace
}  // namespace shapespace
