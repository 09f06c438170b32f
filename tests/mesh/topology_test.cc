#include <algorithm>

#include <gtest/gtest.h>

#include <shapespace/mesh/topology.h>

#include "mesh/bodies.h"

namespace shapespace {
namespace {

using testing::Cube;
using testing::Grid;
using testing::Torus;

Topology Of(const Soup& soup) {
  return ComputeTopology(
      *Connectivity::Make(soup.NumVertices(), soup.polygon_begin, soup.corners, soup.segments));
}

/// Both meshes as one.
Soup Union(const Soup& a, const Soup& b) {
  Soup result = a;
  result.vertices.resize(3, a.NumVertices() + b.NumVertices());
  result.vertices << a.vertices, b.vertices;
  for (int v : b.corners) result.corners.push_back(v + a.NumVertices());
  for (int p = 1; p <= b.NumPolygons(); ++p) {
    result.polygon_begin.push_back(a.polygon_begin.back() + b.polygon_begin[p]);
  }
  return result;
}

TEST(TopologyTest, Cube) {
  const Topology cube = Of(Cube());
  EXPECT_EQ(cube.components, 1);
  EXPECT_EQ(cube.component, std::vector<int>(8, 0));
  EXPECT_TRUE(cube.manifold);
  EXPECT_TRUE(cube.boundary_loops.empty());
  EXPECT_EQ(cube.genus, 0);
}

TEST(TopologyTest, TorusAndTwoTori) {
  EXPECT_EQ(Of(Torus(7, 5)).genus, 1);
  const Topology two = Of(Union(Torus(7, 5), Torus(3, 4)));
  EXPECT_EQ(two.components, 2);
  EXPECT_EQ(two.genus, 2);
  EXPECT_EQ(std::count(two.component.begin(), two.component.end(), 0), 35);
  EXPECT_EQ(std::count(two.component.begin(), two.component.end(), 1), 12);
}

TEST(TopologyTest, DiskHasOneLoopOfNeighbours) {
  const Soup grid = Grid(3, 4);
  const Topology disk = Of(grid);
  EXPECT_TRUE(disk.manifold);
  EXPECT_EQ(disk.genus, 0);
  ASSERT_EQ(disk.boundary_loops.size(), 1u);
  const std::vector<int>& loop = disk.boundary_loops[0];
  ASSERT_EQ(loop.size(), 14u);
  for (size_t i = 0; i < loop.size(); ++i) {
    const int a = loop[i], b = loop[(i + 1) % loop.size()];
    EXPECT_DOUBLE_EQ((grid.vertices.col(a) - grid.vertices.col(b)).norm(), 1.0);
  }
}

TEST(TopologyTest, RemovingAFaceOfATorusOpensALoop) {
  Soup torus = Torus(6, 6);
  torus.corners.resize(torus.corners.size() - 4);
  torus.polygon_begin.pop_back();
  const Topology open = Of(torus);
  EXPECT_EQ(open.genus, 1);
  ASSERT_EQ(open.boundary_loops.size(), 1u);
  EXPECT_EQ(open.boundary_loops[0].size(), 4u);
}

TEST(TopologyTest, UnusedVerticesBelongNowhereAndSegmentsJoin) {
  Soup soup = Union(Cube(), Cube());
  soup.vertices.conservativeResize(3, 17);
  EXPECT_EQ(Of(soup).components, 2);
  EXPECT_EQ(Of(soup).component[16], -1);
  soup.segments = {{0, 8}};
  const Topology joined = Of(soup);
  EXPECT_EQ(joined.components, 1);
  EXPECT_TRUE(joined.manifold);
  EXPECT_EQ(joined.genus, 0);
}

TEST(TopologyTest, NonManifolds) {
  const auto manifold = [](const std::vector<std::vector<int>>& polygons) {
    const Topology topology = Of(testing::MakeSoup(Shape::Random(3, 7), polygons));
    EXPECT_TRUE(topology.manifold || topology.boundary_loops.empty());
    return topology.manifold;
  };
  EXPECT_TRUE(manifold({{0, 1, 2}, {2, 1, 3}}));
  EXPECT_FALSE(manifold({{0, 1, 2}, {2, 1, 3}, {1, 2, 4}}));  // three triangles at an edge
  EXPECT_FALSE(manifold({{0, 1, 2}, {1, 2, 3}}));             // wound against each other
  EXPECT_FALSE(manifold({{0, 1, 2}, {0, 3, 4}}));             // two fans at a vertex
  EXPECT_FALSE(manifold({{0, 1, 2}, {1, 1, 2}}));             // a vertex at two corners
  EXPECT_FALSE(manifold({}));
}

TEST(TopologyTest, AnyOrderOfTrianglesWillDo) {
  // In this order, vertices have several fans for some time during the construction.
  Soup torus = Torus(8, 8), shuffled = torus;
  for (int p = 0; p < 64; ++p) {
    std::copy_n(torus.corners.begin() + 4 * (p * 29 % 64), 4, shuffled.corners.begin() + 4 * p);
  }
  EXPECT_TRUE(Of(shuffled).manifold);
  EXPECT_EQ(Of(shuffled).genus, 1);
}

/// Each loop from its smallest vertex on; the loops in order.
std::vector<std::vector<int>> FromSmallest(std::vector<std::vector<int>> loops) {
  for (std::vector<int>& loop : loops) {
    std::rotate(loop.begin(), std::min_element(loop.begin(), loop.end()), loop.end());
  }
  std::sort(loops.begin(), loops.end());
  return loops;
}

TEST(TopologyTest, LoopsHoldTheirVerticesInOrderAndRunAgainstThePolygons) {
  // 4 x 3 vertices, numbered row by row, without the middle square of the lower row.
  const std::vector<std::vector<int>> squares = {
      {0, 1, 5, 4}, {2, 3, 7, 6}, {4, 5, 9, 8}, {5, 6, 10, 9}, {6, 7, 11, 10}};
  const Topology open = Of(testing::MakeSoup(Shape::Random(3, 12), squares));
  EXPECT_TRUE(open.manifold);
  EXPECT_EQ(FromSmallest(open.boundary_loops),
            (std::vector<std::vector<int>>{{0, 4, 8, 9, 10, 11, 7, 3, 2, 6, 5, 1}}));
  // A prism of four sides without its two ends, and a triangle.
  const Topology tube = Of(testing::MakeSoup(
      Shape::Random(3, 12), {{0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}, {9, 11, 10}}));
  EXPECT_EQ(FromSmallest(tube.boundary_loops),
            (std::vector<std::vector<int>>{{0, 3, 2, 1}, {4, 5, 6, 7}, {9, 10, 11}}));
  EXPECT_EQ(tube.genus, 0);
  EXPECT_EQ(tube.component, (std::vector<int>{0, 0, 0, 0, 0, 0, 0, 0, -1, 1, 1, 1}));
}

TEST(TopologyTest, ComponentsAreNumberedByTheirFirstVerticesAndSegmentsHaveNoGenus) {
  Soup soup = Union(Torus(6, 5), Torus(4, 3));
  soup.vertices = Shape::Random(3, 47);
  soup.segments = {{46, 43}, {44, 43}};
  Topology topology = Of(soup);
  EXPECT_EQ(topology.components, 3);
  EXPECT_EQ(topology.genus, 2);
  EXPECT_EQ(topology.component[42], -1);
  EXPECT_EQ(topology.component[45], -1);
  EXPECT_EQ(topology.component[46], 2);
  // Without a polygon of each torus.
  soup.corners.erase(soup.corners.begin(), soup.corners.begin() + 4);
  soup.corners.resize(soup.corners.size() - 4);
  soup.polygon_begin.resize(soup.polygon_begin.size() - 2);
  topology = Of(soup);
  EXPECT_EQ(topology.genus, 2);
  EXPECT_EQ(topology.boundary_loops.size(), 2u);
  // The second polygon has the smaller vertices.
  EXPECT_EQ(Of(testing::MakeSoup(Shape::Random(3, 7), {{4, 5, 6}, {1, 3, 2}})).component,
            (std::vector<int>{-1, 0, 0, 0, 1, 1, 1}));
  Soup graph;
  graph.vertices = Shape::Random(3, 5);
  graph.segments = {{4, 1}, {2, 3}};
  topology = Of(graph);
  EXPECT_FALSE(topology.manifold);
  EXPECT_EQ(topology.component, (std::vector<int>{-1, 0, 1, 1, 0}));
}

TEST(TopologyTest, ATriangleWithTwoEqualCornersIsNoManifoldWhicheverTheyAre) {
  for (const std::vector<int>& polygon : {std::vector<int>{0, 0, 1}, {0, 1, 1}, {1, 0, 1}}) {
    EXPECT_FALSE(Of(testing::MakeSoup(Shape::Random(3, 2), {polygon})).manifold);
  }
}

}  // namespace
}  // namespace shapespace
