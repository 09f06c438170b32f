#ifndef SHAPESPACE_CORRESPONDENCE_SURFACE_MAP_H_
#define SHAPESPACE_CORRESPONDENCE_SURFACE_MAP_H_

#include <string>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// The position of each vertex of one mesh on the surface of another.
struct SurfacePoints {
  Eigen::VectorXi triangle;      ///< index into Connectivity::Triangles() of the other mesh, per
                                 ///< vertex
  Eigen::Matrix3Xd barycentric;  ///< in that triangle: non-negative, with sum 1

  int NumVertices() const { return static_cast<int>(triangle.size()); }
};

/// A map between the surfaces of two meshes of different connectivity, in both directions. The
/// directions are not exactly inverse to each other: both are sampled at vertices, and surfaces may
/// fold.
struct SurfaceMap {
  SurfacePoints to_target;    ///< of each vertex of the template
  SurfacePoints to_template;  ///< of each vertex of the target
  /// Per vertex of the template, the distance between the vertex and its image under the map to the
  /// target and back, as a share of the square root of the template's area. It is large where the
  /// map folds or the target has no corresponding part.
  Eigen::VectorXd round_trip;
  /// Per vertex of the target, its distance from the fitted template, as a share of the square root
  /// of the target's area; 1 where no part of the template is near. In that case `to_template` is
  /// that of the nearest vertex, along the target's surface, to which the template is near.
  Eigen::VectorXd gap;
};

/// Evaluates a function at `points`. The function is given on the vertices of the mesh on which the
/// points lie, as d x n values: positions (d = 3), colours, a scalar field; the result is d x m.
/// `triangles` are those of that mesh. So `to_target` terms a function on the target back to the
/// template, and `to_template` terms one on the template back to the target.
/// \throw MeshError if `function` has no column for a corner of the triangles, or if a point lies
///        on a triangle that does not exist.
Eigen::MatrixXd PullBack(const SurfacePoints& points, const Eigen::Matrix3Xi& triangles,
                         const Eigen::MatrixXd& function);

/// Moves a mesh whose vertices lie at or near `points` of a body while that body (of
/// `connectivity`) moves from `rest` to `moved`: every vertex keeps its offset from its point,
/// rotated with the body at that point. `own` are the positions of the mesh itself, 3 x m, for the
/// body at rest.
/// \throw MeshError if sizes do not fit.
Shape CarryAlong(const SurfacePoints& points, const Connectivity& connectivity, const Shape& rest,
                 const Shape& moved, const Shape& own);

/// Writes a map as text (docs/file-formats.md). The file is written completely or not at all.
/// \throw FileError.
void WriteSurfaceMap(const std::string& file, const SurfaceMap& map);

/// Reads such a file. Triangle indices are checked against the numbers of triangles of the two
/// meshes.
/// \throw FileError naming file and line.
SurfaceMap ReadSurfaceMap(const std::string& file, int template_triangles, int target_triangles);

}  // namespace shapespace

#endif  // SHAPESPACE_CORRESPONDENCE_SURFACE_MAP_H_
