#include <set>
#include <vector>

#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/mesh/connectivity.h>

#include "mesh/bodies.h"
#include "mesh/files.h"
#include "support/message_of.h"

namespace shapespace {
namespace {

using testing::Connected;
using testing::Cube;
using testing::ExpectError;
using testing::Grid;

TEST(ConnectivityTest, CubeOfQuadrilaterals) {
  const Soup cube = Cube();
  const auto c = Connected(cube);
  EXPECT_EQ(c->NumVertices(), 8);
  EXPECT_EQ(c->NumPolygons(), 6);
  EXPECT_EQ(c->NumTriangles(), 12);
  EXPECT_EQ(c->NumTriangleEdges(), 18);  // 12 sides and 6 diagonals
  EXPECT_EQ(c->NumEdges(), 24);          // and 6 other diagonals
  EXPECT_EQ(c->NumHinges(), 18);
  EXPECT_EQ(c->Corners(), cube.corners);
  EXPECT_EQ(c->PolygonBegin(), cube.polygon_begin);
  EXPECT_FALSE(c->IsGraph());

  // With both diagonals every pair of vertices of a face is an edge, each once.
  std::set<std::pair<int, int>> edges;
  for (int e = 0; e < c->NumEdges(); ++e) {
    const int a = c->Edges()(0, e), b = c->Edges()(1, e);
    EXPECT_LT(a, b);
    EXPECT_TRUE(edges.emplace(a, b).second);
    EXPECT_LE((cube.vertices.col(a) - cube.vertices.col(b)).squaredNorm(), 2.0);
  }
  double volume = 0.0;
  for (int f = 0; f < c->NumTriangles(); ++f) {
    const auto t = c->Triangles().col(f);
    Eigen::Matrix3d corners;
    corners << cube.vertices.col(t[0]), cube.vertices.col(t[1]), cube.vertices.col(t[2]);
    volume += corners.determinant() / 6.0;
  }
  EXPECT_NEAR(volume, 1.0, 1e-15);
}

TEST(ConnectivityTest, HingesKeepTheWindingOfBothTriangles) {
  const auto c = Connected(Grid(3, 3));
  std::set<std::array<int, 3>> triangles;
  auto smallest_first = [](std::array<int, 3> t) {
    while (t[0] > t[1] || t[0] > t[2]) t = {t[1], t[2], t[0]};
    return t;
  };
  for (int f = 0; f < c->NumTriangles(); ++f) {
    const auto t = c->Triangles().col(f);
    triangles.insert(smallest_first({t[0], t[1], t[2]}));
  }
  ASSERT_EQ(c->NumHinges(), 33 - 12);  // edges of the grid without those of its boundary
  for (int h = 0; h < c->NumHinges(); ++h) {
    const auto q = c->Hinges().col(h);
    EXPECT_TRUE(triangles.count(smallest_first({q[0], q[1], q[2]})));
    EXPECT_TRUE(triangles.count(smallest_first({q[1], q[0], q[3]})));
    EXPECT_NE(q[2], q[3]);
  }
}

TEST(ConnectivityTest, TriangleEdgesComeFirstAndInOrder) {
  Soup grid = Grid(4, 2);
  grid.segments = {{14, 0}, {0, 14}, {1, 0}};  // twice the same, and one that is a side
  const auto c = Connectivity::Make(grid.NumVertices(), grid.polygon_begin, grid.corners,
                                    grid.segments, {{3, 14}});
  ASSERT_EQ(c->NumEdges(), c->NumTriangleEdges() + 2);
  for (int e = 1; e < c->NumTriangleEdges(); ++e) {
    const auto a = c->Edges().col(e - 1), b = c->Edges().col(e);
    EXPECT_LT(std::make_pair(a[0], a[1]), std::make_pair(b[0], b[1]));
  }
  EXPECT_EQ(c->Edges().col(c->NumEdges() - 2), Eigen::Vector2i(0, 14));
  EXPECT_EQ(c->Edges().col(c->NumEdges() - 1), Eigen::Vector2i(3, 14));
}

TEST(ConnectivityTest, GraphsAndNonManifolds) {
  const auto graph = Connectivity::Make(3, {0}, {}, {{2, 1}, {0, 1}});
  EXPECT_TRUE(graph->IsGraph());
  EXPECT_EQ(graph->NumEdges(), 2);
  EXPECT_EQ(graph->NumTriangleEdges(), 0);

  Eigen::Matrix3Xi three(3, 3);  // three triangles at edge 0 1: no hinge there
  three << 0, 1, 0, 1, 0, 1, 2, 3, 4;
  EXPECT_EQ(Connectivity::FromTriangles(5, three)->NumHinges(), 0);
  Eigen::Matrix3Xi against(3, 2);
  against << 0, 0, 1, 1, 2, 3;
  EXPECT_EQ(Connectivity::FromTriangles(4, against)->NumHinges(), 0);
  Eigen::Matrix3Xi degenerate(3, 1);
  degenerate << 0, 1, 1;
  EXPECT_EQ(Connectivity::FromTriangles(2, degenerate)->NumEdges(), 1);
}

TEST(ConnectivityTest, RefusesBadIndices) {
  ExpectError<MeshError>([] { Connectivity::Make(0, {0}, {}); }, {"at least one vertex"});
  ExpectError<MeshError>([] { Connectivity::Make(3, {0, 3}, {0, 1, 3}); }, {"3", "0 .. 2"});
  ExpectError<MeshError>([] { Connectivity::Make(3, {0, 3}, {0, 1, -1}); }, {"-1", "0 .. 2"});
  ExpectError<MeshError>([] { Connectivity::Make(3, {0, 2}, {0, 1, 2}); }, {"polygon_begin"});
  ExpectError<MeshError>(
      [] {
        Connectivity::Make(3, {0, 3, 5}, {0, 1, 2, 0, 1});
      },
      {"polygon 1 has 2 corners; a polygon needs three"});
  ExpectError<MeshError>(
      [] {
        Connectivity::Make(3, {0, 0, 3}, {0, 1, 2});
      },
      {"polygon 0 has 0 corners"});
  ExpectError<MeshError>([] { Connectivity::Make(3, {0}, {}, {{0, 3}}); }, {"segment 0 3"});
  ExpectError<MeshError>(
      [] {
        Connectivity::Make(3, {0}, {}, {{1, 1}});
      },
      {"segment joins vertex 1 to itself"});
  ExpectError<MeshError>(
      [] {
        Connectivity::Make(3, {0}, {}, {{0, 1}}, {{2, 2}});
      },
      {"stiffener joins vertex 2"});
}

TEST(ConnectivityTest, RefusesTrianglesThatAreNotThoseOfThePolygons) {
  const std::vector<int> begin = {0, 4, 7}, corners = {0, 1, 2, 3, 3, 2, 4};
  const auto make = [&](const Eigen::Matrix3Xi& triangles) {
    return Connectivity::Make(5, begin, corners, {}, {}, triangles);
  };
  Eigen::Matrix3Xi good(3, 3);
  good << 0, 1, 3,  //
      1, 2, 2,      //
      3, 3, 4;
  EXPECT_EQ(make(good)->Triangles(), good);
  ExpectError<MeshError>([&] { make(good.leftCols(2)); }, {"triangles: must be those"});
  Eigen::Matrix3Xi foreign = good;
  foreign(2, 0) = 4;  // no corner of the first polygon
  ExpectError<MeshError>([&] { make(foreign); }, {"triangles: must be those"});
}

TEST(ConnectivityTest, KeepsSegmentsApartFromStiffeners) {
  const auto graph = Connectivity::Make(4, {0}, {}, {{2, 1}, {0, 1}}, {{0, 3}});
  EXPECT_EQ(graph->NumEdges(), 3);
  EXPECT_EQ(graph->Segments(), (std::vector<std::pair<int, int>>{{2, 1}, {0, 1}}));
}

// What the lists say of an element is what a search through all elements finds.
void ExpectListsOf(const Connectivity& c) {
  const Eigen::Matrix3Xi& triangles = c.Triangles();
  const Eigen::Matrix2Xi& edges = c.Edges();
  const auto list = [](const IndexLists::Row& row) {
    return std::vector<int>(row.begin(), row.end());
  };
  ASSERT_EQ(c.TrianglesOfVertices().NumRows(), c.NumVertices());
  ASSERT_EQ(c.EdgesOfVertices().NumRows(), c.NumVertices());
  ASSERT_EQ(c.TrianglesOfEdges().NumRows(), c.NumTriangleEdges());
  for (int v = 0; v < c.NumVertices(); ++v) {
    std::vector<int> expected;
    for (int f = 0; f < c.NumTriangles(); ++f) {
      if ((triangles.col(f).array() == v).any()) expected.push_back(f);
    }
    EXPECT_EQ(list(c.TrianglesOfVertices()[v]), expected);
    expected.clear();
    for (int e = 0; e < c.NumEdges(); ++e) {
      if ((edges.col(e).array() == v).any()) expected.push_back(e);
    }
    EXPECT_EQ(list(c.EdgesOfVertices()[v]), expected);
    for (const int e : expected) EXPECT_EQ(c.OtherEnd(e, c.OtherEnd(e, v)), v);
  }
  for (int e = 0; e < c.NumTriangleEdges(); ++e) {
    std::vector<int> expected;
    for (int f = 0; f < c.NumTriangles(); ++f) {
      const auto has = [&](int v) { return (triangles.col(f).array() == v).any(); };
      if (has(edges(0, e)) && has(edges(1, e))) expected.push_back(f);
    }
    EXPECT_EQ(list(c.TrianglesOfEdges()[e]), expected);
  }
}

TEST(ConnectivityTest, ListsWhatLiesAtVerticesAndEdges) {
  ExpectListsOf(*Connected(Cube()));
  ExpectListsOf(*Connected(Grid(4, 3)));
  // Three triangles at one edge, one that is an edge there and back, a vertex of no triangle.
  Eigen::Matrix3Xi book(3, 4);
  book << 0, 1, 0, 1, 1, 0, 1, 3, 2, 3, 4, 1;
  ExpectListsOf(*Connectivity::FromTriangles(6, book));
  ExpectListsOf(*Connectivity::Make(4, {0}, {}, {{0, 1}, {2, 1}}, {{0, 2}}));  // a graph
}

TEST(ConnectivityTest, BadIndicesAreQuotedWhicheverEndTheyAreOf) {
  const auto message = [](const std::vector<std::pair<int, int>>& segments,
                          const std::vector<std::pair<int, int>>& stiffeners) {
    return testing::MessageOf<MeshError>(
        [&] { Connectivity::Make(4, {0}, {}, segments, stiffeners); });
  };
  EXPECT_TRUE(testing::Names(message({{0, 3}, {4, 1}}, {}), {"segment 4", "1", "0 .. 3"}));
  EXPECT_TRUE(testing::Names(message({{0, 3}, {1, 4}}, {}), {"segment 1", "4", "0 .. 3"}));
  EXPECT_TRUE(testing::Names(message({{-1, 3}}, {}), {"segment -1", "3", "0 .. 3"}));
  EXPECT_TRUE(testing::Names(message({{3, -1}}, {{5, 5}}), {"segment 3", "-1", "0 .. 3"}));
  EXPECT_TRUE(testing::Names(message({{3, 1}}, {{2, 0}, {5, 5}}), {"stiffener 5", "5", "0 .. 3"}));
  EXPECT_TRUE(testing::Names(message({{3, 1}}, {{0, 2}, {3, 3}}), {"vertex 3"}));
  EXPECT_EQ(message({{3, 1}}, {{0, 2}}), "nothing was thrown");
}

TEST(ConnectivityTest, APolygonIsAFanFromItsSmallestVertexWithAllShortDiagonals) {
  const auto c = Connectivity::Make(9, {0, 3, 8, 12}, {6, 2, 4, 7, 3, 1, 5, 8, 8, 5, 0, 6},
                                    {{4, 3}, {5, 8}}, {{7, 0}, {3, 4}});
  Eigen::Matrix3Xi triangles(3, 6);
  triangles << 2, 1, 1, 1, 0, 0,  //
      4, 5, 8, 7, 6, 8,           //
      6, 8, 7, 3, 8, 5;
  EXPECT_EQ(c->Triangles(), triangles);
  Eigen::Matrix2Xi sides(2, 14);
  sides << 0, 0, 0, 1, 1, 1, 1, 2, 2, 3, 4, 5, 6, 7,  //
      5, 6, 8, 3, 5, 7, 8, 4, 6, 7, 6, 8, 8, 8;
  ASSERT_EQ(c->NumTriangleEdges(), 14);
  EXPECT_EQ(c->Edges().leftCols(14), sides);
  // Then the segments, diagonals and stiffeners that are no sides, in order and each once.
  Eigen::Matrix2Xi others(2, 6);
  others << 0, 3, 3, 3, 5, 5,  //
      7, 4, 5, 8, 6, 7;
  EXPECT_EQ(c->Edges().rightCols(c->NumEdges() - 14), others);
}

}  // namespace
}  // namespace shapespace
