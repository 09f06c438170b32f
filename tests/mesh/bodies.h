#ifndef TESTS_MESH_BODIES_H_
#define TESTS_MESH_BODIES_H_

#include <cmath>
#include <memory>
#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/soup.h>

namespace shapespace::testing {

inline Soup MakeSoup(const Shape& vertices, const std::vector<std::vector<int>>& polygons) {
  Soup soup;
  soup.vertices = vertices;
  for (const std::vector<int>& polygon : polygons) {
    soup.corners.insert(soup.corners.end(), polygon.begin(), polygon.end());
    soup.polygon_begin.push_back(static_cast<int>(soup.corners.size()));
  }
  return soup;
}

/// With polygons triangulated as fans.
inline std::shared_ptr<const Connectivity> Connected(const Soup& soup) {
  return Connectivity::Make(soup.NumVertices(), soup.polygon_begin, soup.corners, soup.segments);
}

/// The unit cube of six quadrilaterals, wound outwards. Vertex x + 2 y + 4 z lies at (x, y, z).
inline Soup Cube() {
  Shape vertices(3, 8);
  for (int v = 0; v < 8; ++v) vertices.col(v) << (v & 1), (v >> 1 & 1), (v >> 2 & 1);
  return MakeSoup(
      vertices,
      {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}});
}

/// A torus of n x m quadrilaterals.
inline Soup Torus(int n, int m) {
  const double turn = 2.0 * std::acos(-1.0);
  Shape vertices(3, n * m);
  std::vector<std::vector<int>> polygons;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const double u = turn * i / n, v = turn * j / m, r = 2.0 + std::cos(v);
      vertices.col(i * m + j) << r * std::cos(u), r * std::sin(u), std::sin(v);
      const int k = (i + 1) % n, l = (j + 1) % m;
      polygons.push_back({i * m + j, k * m + j, k * m + l, i * m + l});
    }
  }
  return MakeSoup(vertices, polygons);
}

/// A flat grid of n x m squares of side 1, two triangles each.
inline Soup Grid(int n, int m) {
  Shape vertices(3, (n + 1) * (m + 1));
  std::vector<std::vector<int>> polygons;
  for (int i = 0; i <= n; ++i) {
    for (int j = 0; j <= m; ++j) vertices.col(i * (m + 1) + j) << i, j, 0.0;
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const int a = i * (m + 1) + j, b = a + m + 1;
      polygons.push_back({a, b, b + 1});
      polygons.push_back({a, b + 1, a + 1});
    }
  }
  return MakeSoup(vertices, polygons);
}

}  // namespace shapespace::testing

#endif  // TESTS_MESH_BODIES_H_
