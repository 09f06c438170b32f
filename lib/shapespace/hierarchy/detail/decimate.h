#ifndef SHAPESPACE_HIERARCHY_DETAIL_DECIMATE_H_
#define SHAPESPACE_HIERARCHY_DETAIL_DECIMATE_H_

#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// Vertex `from` moves onto its neighbour `to` and disappears, with the triangles at their edge.
struct Collapse {
  int from, to;
  int triangles;  ///< left after it
};

/// Edge collapses, in order, that reduce a mesh to few triangles, the same for all `poses` (3 x m
/// each, in any unit): paired progressive meshes (Hoppe, "Progressive Meshes", SIGGRAPH 1996;
/// Kilian et al. 2007, section 3). The vertices whose removal costs least are removed first, in
/// rounds of collapses that are independent of each other and made on all threads; the cost is the
/// quadric error summed over the poses, each scaled to area 1, with additional planes along
/// boundaries. No collapse changes the topology, flips a triangle or makes a sliver in any pose.
/// Vertices of `pinned`, non-manifold vertices and vertices without triangles are kept, and so are
/// vertices with more than 54 triangles as long as they have so many. Ends when `triangles` are
/// left, or earlier if no collapse is possible. O(m log m).
/// \throw MeshError if a pose has the wrong number of vertices; InvalidOptions if `pinned` contains
///        an invalid vertex; Cancelled.
std::vector<Collapse> PlanCollapses(const Connectivity& connectivity,
                                    const std::vector<Shape>& poses, int triangles,
                                    const std::vector<int>& pinned = {},
                                    Progress* progress = nullptr);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_HIERARCHY_DETAIL_DECIMATE_H_
