#ifndef SHAPESPACE_OUTPUT_SEAMS_H_
#define SHAPESPACE_OUTPUT_SEAMS_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/appearance.h>
#include <shapespace/mesh/connectivity.h>

// Private: a mesh as graphics hardware takes it, with one texture coordinate a vertex.

namespace shapespace::internal {

struct CutMesh {
  /// The vertex of the mesh that each vertex here is. First come all the mesh's own, in their
  /// order; after them a copy for each further texture coordinate that one has in a corner.
  std::vector<int> source;
  Eigen::Matrix2Xf texture;    ///< of each vertex, (0, 0) where it has none; empty without any
  Eigen::Matrix3Xi triangles;  ///< the connectivity's, between the vertices here
};

/// Cuts a mesh where its texture has seams. An empty appearance leaves it as it is.
CutMesh CutAtSeams(const Connectivity& connectivity, const Appearance& appearance);

/// The polygon that each triangle of the connectivity is a part of.
std::vector<int> PolygonsOfTriangles(const Connectivity& connectivity);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_SEAMS_H_
