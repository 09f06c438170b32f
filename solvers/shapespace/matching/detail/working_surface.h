#ifndef SHAPESPACE_MATCHING_DETAIL_WORKING_SURFACE_H_
#define SHAPESPACE_MATCHING_DETAIL_WORKING_SURFACE_H_

#include <memory>
#include <string>
#include <vector>

#include <shapespace/base/progress.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::internal {

/// What matching works on: the connected component of a body that has the largest area, with its
/// vertices numbered anew, decimated if it has many triangles, with its triangles cut into four if
/// it has few, and scaled to area 1.
struct WorkingSurface {
  std::shared_ptr<const Connectivity> connectivity;  ///< triangles alone, no twins
  Shape shape;
  int num_own = 0;            ///< vertices of the body; midpoints of edges follow them
  std::vector<int> vertices;  ///< per vertex, its number in the body; of a midpoint, that of an end
  /// Per vertex of the body, the nearest vertex here along the surface; -1 if the body's vertex is
  /// not connected to any.
  std::vector<int> nearest;

  int NumVertices() const { return connectivity->NumVertices(); }
  /// The vertex itself, or an end of the edge whose midpoint it is.
  int Own(int vertex) const { return nearest[vertices[vertex]]; }
};

/// `name` ("template" or "target") is the body's in messages. Surfaces of more than 20000 triangles
/// are decimated to about 10000: what is sought is coarse, and costs time in proportion. Those of
/// 1000 to 4000 are cut into four: of fewer, nothing is gained.
/// \throw MeshError if the body has no triangles or no area, or if the shape is not finite or has
///        another number of vertices; Cancelled.
WorkingSurface MakeWorkingSurface(const std::string& name, const Connectivity& connectivity,
                                  const Shape& shape, Progress* progress);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_WORKING_SURFACE_H_
