#ifndef SHAPESPACE_OUTPUT_DETAIL_SEAMS_H_
#define SHAPESPACE_OUTPUT_DETAIL_SEAMS_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/appearance.h>
#include <shapespace/mesh/connectivity.h>

// A mesh for graphics hardware, with one texture coordinate per vertex.

namespace shapespace::internal {

struct CutMesh {
  /// Per vertex, the mesh's vertex that it represents. All vertices of the mesh come first, in
  /// their order, followed by a copy for each further texture coordinate of a vertex.
  std::vector<int> source;
  Eigen::Matrix2Xf texture;    ///< per vertex; (0, 0) if it has none; empty if the mesh has none
  Eigen::Matrix3Xi triangles;  ///< the connectivity's, with the indices of the vertices here
};

/// Cuts a mesh where its texture has seams. An empty appearance leaves it as it is.
CutMesh CutAtSeams(const Connectivity& connectivity, const Appearance& appearance);

/// The corners of the cut mesh's triangles, three each, in a list for each material of the
/// appearance, and as the last one those of triangles without a material.
std::vector<std::vector<int>> CornersByMaterial(const Connectivity& connectivity,
                                                const CutMesh& mesh, const Appearance& appearance);

/// The polygon to which each triangle of the connectivity belongs.
std::vector<int> PolygonsOfTriangles(const Connectivity& connectivity);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_SEAMS_H_
