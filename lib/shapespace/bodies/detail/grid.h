#ifndef SHAPESPACE_BODIES_DETAIL_GRID_H_
#define SHAPESPACE_BODIES_DETAIL_GRID_H_

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>

namespace shapespace::internal {

using TriangleList = std::vector<Eigen::Vector3i>;

/// Appends the 2 nu nv triangles of a grid whose node (i, j) is vertex `index(i, j)`; their normals
/// are along (direction of i) x (direction of j). Diagonals alternate, so that the mesh has no
/// preferred direction.
template <typename Index>
void AddGrid(int nu, int nv, const Index& index, TriangleList* triangles) {
  for (int i = 0; i < nu; ++i) {
    for (int j = 0; j < nv; ++j) {
      const int a = index(i, j), b = index(i + 1, j), c = index(i + 1, j + 1), d = index(i, j + 1);
      if ((i + j) % 2 == 0) {
        triangles->insert(triangles->end(), {{a, b, c}, {a, c, d}});
      } else {
        triangles->insert(triangles->end(), {{a, b, d}, {b, c, d}});
      }
    }
  }
}

inline std::shared_ptr<const Connectivity> ConnectivityOf(int num_vertices,
                                                          const TriangleList& triangles) {
  Eigen::Matrix3Xi columns(3, triangles.size());
  for (size_t f = 0; f < triangles.size(); ++f) columns.col(f) = triangles[f];
  return Connectivity::FromTriangles(num_vertices, columns);
}

/// Number of cells of about `size` along `length`, at least 1.
inline int CellsAlong(double length, double size) {
  return std::max(1, static_cast<int>(std::lround(length / size)));
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BODIES_DETAIL_GRID_H_
