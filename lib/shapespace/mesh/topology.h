#ifndef SHAPESPACE_MESH_TOPOLOGY_H_
#define SHAPESPACE_MESH_TOPOLOGY_H_

#include <vector>

#include <shapespace/mesh/connectivity.h>

namespace shapespace {

/// The topology of a mesh as a surface.
struct Topology {
  int components = 0;          ///< connected pieces of vertices that some element uses
  std::vector<int> component;  ///< per vertex; -1 for a vertex that no element uses
  bool manifold = false;       ///< every edge has one or two triangles, wound consistently, and
                               ///< the triangles of every vertex form one fan
  std::vector<std::vector<int>> boundary_loops;  ///< vertices in order; empty if not manifold
  int genus = 0;                                 ///< summed over the components; 0 if not manifold
};

/// Built through OpenMesh where the mesh is a manifold. Segments and stiffeners join components but
/// are no part of the surface; a graph is no manifold.
Topology ComputeTopology(const Connectivity& connectivity);

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_TOPOLOGY_H_
