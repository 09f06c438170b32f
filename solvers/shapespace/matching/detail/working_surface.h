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
/// vertices numbered anew, decimated if it has many triangles, and scaled to area 1.
struct WorkingSurface {
  std::shared_ptr<const Connectivity> connectivity;  ///< triangles alone, no twins
  Shape shape;
  std::vector<int> vertices;  ///< per vertex, its number in the body
  /// Per vertex of the body, the nearest vertex here along the surface; -1 if the body's vertex is
  /// not connected to any.
  std::vector<int> nearest;

  int NumVertices() const { return connectivity->NumVertices(); }
};

/// `name` ("template" or "target") is the body's in messages. Surfaces of more than 20000 triangles
/// are decimated to about 10000: what is sought is coarse, and costs time in proportion.
/// \throw MeshError if the body has no triangles or no area, or if the shape is not finite or has
///        another number of vertices; Cancelled.
WorkingSurface MakeWorkingSurface(const std::string& name, const Connectivity& connectivity,
                                  const Shape& shape, Progress* progress);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MATCHING_DETAIL_WORKING_SURFACE_H_
