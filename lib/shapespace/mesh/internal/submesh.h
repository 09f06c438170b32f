#ifndef SHAPESPACE_MESH_INTERNAL_SUBMESH_H_
#define SHAPESPACE_MESH_INTERNAL_SUBMESH_H_

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>

namespace shapespace::internal {

/// Whole components of a mesh as a mesh of their own.
struct Submesh {
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<int> vertices;  ///< for each of its vertices the one of the mesh, ascending
  std::vector<int> index;     ///< for each vertex of the mesh its own one, or -1
};

/// The components whose vertices are kept.
inline Submesh MakeSubmesh(const Connectivity& mesh, const std::vector<bool>& keep) {
  Submesh part;
  part.index.assign(mesh.NumVertices(), -1);
  for (int v = 0; v < mesh.NumVertices(); ++v) {
    if (!keep[v]) continue;
    part.index[v] = static_cast<int>(part.vertices.size());
    part.vertices.push_back(v);
  }
  Eigen::Matrix3Xi triangles(3, mesh.NumTriangles());
  int count = 0;
  for (const auto& triangle : mesh.Triangles().colwise()) {
    if (!keep[triangle(0)]) continue;
    for (int k = 0; k < 3; ++k) triangles(k, count) = part.index[triangle(k)];
    ++count;
  }
  part.connectivity = Connectivity::FromTriangles(static_cast<int>(part.vertices.size()),
                                                  triangles.leftCols(count));
  return part;
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MESH_INTERNAL_SUBMESH_H_
