#ifndef SHAPESPACE_SOLVERS_SURFACE_MAP_H_
#define SHAPESPACE_SOLVERS_SURFACE_MAP_H_

#include <string>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// Where each vertex of one mesh lies on the surface of another.
struct SurfacePoints {
  Eigen::VectorXi triangle;      ///< of the other's Connectivity::Triangles(), a vertex
  Eigen::Matrix3Xd barycentric;  ///< of that triangle's corners: not negative, of sum 1

  int NumVertices() const { return static_cast<int>(triangle.size()); }
};

/// A map between the surfaces of two meshes of different connectivity, both ways. The one way is
/// not exactly the other's inverse: both are given at vertices, and surfaces may fold.
struct SurfaceMap {
  SurfacePoints to_target;    ///< of each vertex of the template
  SurfacePoints to_template;  ///< of each vertex of the target
  /// Of each vertex of the template how far from itself it comes back, there and back again, as a
  /// share of the root of the template's area: large where the map folds or the target has nothing
  /// that belongs there.
  Eigen::VectorXd round_trip;
  /// Of each vertex of the target how far the fitted template is from it, as a share of the root of
  /// the target's area; 1 where no part of it came near. `to_template` is then that of the nearest
  /// vertex, along the target's surface, to which it came.
  Eigen::VectorXd gap;
};

/// A function on the vertices of the mesh on which `points` lie, d x n, as its values at those
/// points, d x m: positions (d = 3), colours, a scalar field. `triangles` are those of that mesh.
/// So a function on the target is pulled back to the template by `to_target`, and one on the
/// template is carried to the target by `to_template`.
/// \throw MeshError if `function` has no column for a corner of the triangles, or if a point lies
/// on a triangle that there is not.
Eigen::MatrixXd Pull(const SurfacePoints& points, const Eigen::Matrix3Xi& triangles,
                     const Eigen::MatrixXd& function);

/// Moves a mesh whose vertices lie at or near `points` of a body as that body moves from `rest` to
/// `moved` (of `connectivity`): every vertex keeps its offset from its point, which turns with the
/// body there. `own` is the mesh itself, 3 x m, while the body is at rest.
/// \throw MeshError if sizes do not fit.
Shape CarryAlong(const SurfacePoints& points, const Connectivity& connectivity, const Shape& rest,
                 const Shape& moved, const Shape& own);

/// Writes a map as text (docs/file-formats.md). The file appears whole or not at all.
/// \throw FileError.
void WriteSurfaceMap(const std::string& file, const SurfaceMap& map);

/// Reads one. Triangles are checked against the numbers of triangles of the two meshes.
/// \throw FileError naming file and line.
SurfaceMap ReadSurfaceMap(const std::string& file, int template_triangles, int target_triangles);

}  // namespace shapespace

#endif  // SHAPESPACE_SOLVERS_SURFACE_MAP_H_
