#ifndef SHAPESPACE_MESH_INTERNAL_SUBMESH_H_
#define SHAPESPACE_MESH_INTERNAL_SUBMESH_H_

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>

namespace shapespace::internal {

/// Some triangles of a mesh as a mesh of their own.
struct Submesh {
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<int> vertices;  ///< for each of its vertices the one of the mesh, ascending
  std::vector<int> index;     ///< for each vertex of the mesh its own one, or -1
};

/// The triangles for whose numbers `keep` is true.
template <typename Keep>
Submesh MakeSubmesh(const Connectivity& mesh, const Keep& keep) {
  Submesh part;
  part.index.assign(mesh.NumVertices(), -1);
  std::vector<int> triangles;
  for (int f = 0; f < mesh.NumTriangles(); ++f) {
    if (!keep(f)) continue;
    triangles.push_back(f);
    for (const int v : mesh.Triangles().col(f)) part.index[v] = 0;
  }
  for (int v = 0; v < mesh.NumVertices(); ++v) {
    if (part.index[v] < 0) continue;
    part.index[v] = static_cast<int>(part.vertices.size());
    part.vertices.push_back(v);
  }
  const Eigen::Matrix3Xi chosen = mesh.Triangles()(Eigen::all, triangles);
  part.connectivity =
      Connectivity::FromTriangles(static_cast<int>(part.vertices.size()),
                                  chosen.unaryExpr([&](int v) { return part.index[v]; }));
  return part;
}

/// The triangles of which all corners are kept.
inline Submesh MakeSubmesh(const Connectivity& mesh, const std::vector<bool>& keep) {
  return MakeSubmesh(mesh, [&](int f) {
    const auto triangle = mesh.Triangles().col(f);
    return keep[triangle(0)] && keep[triangle(1)] && keep[triangle(2)];
  });
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MESH_INTERNAL_SUBMESH_H_
