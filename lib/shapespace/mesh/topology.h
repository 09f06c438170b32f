#ifndef SHAPESPACE_MESH_TOPOLOGY_H_
#define SHAPESPACE_MESH_TOPOLOGY_H_

#include <vector>

#include <shapespace/mesh/connectivity.h>

namespace shapespace {

/// The topology of a mesh as a surface.
struct Topology {
  int components = 0;          ///< connected components of the vertices that some element uses
  std::vector<int> component;  ///< per vertex; -1 for a vertex that no element uses
  bool manifold = false;       ///< every edge has one or two triangles of consistent orientation,
                               ///< and the triangles of every vertex form one fan
  std::vector<std::vector<int>> boundary_loops;  ///< vertices in order; empty if not manifold
  int genus = 0;                                 ///< sum over the components; 0 if not manifold
};

/// Computed with OpenMesh if the mesh is a manifold. Segments and stiffeners connect components but
/// are not part of the surface; a graph is not a manifold.
Topology ComputeTopology(const Connectivity& connectivity);

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_TOPOLOGY_H_
