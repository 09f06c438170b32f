#ifndef SHAPESPACE_MESH_SURFACE_H_
#define SHAPESPACE_MESH_SURFACE_H_

#include <functional>
#include <limits>
#include <memory>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// A point of a triangle mesh.
struct ClosestPoint {
  int triangle = -1;  ///< index into Connectivity::Triangles(); -1: none
  Eigen::Vector3d barycentric = Eigen::Vector3d::Zero();
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  double distance = 0;
};

/// Unit normals of a shape's vertices, weighted by the triangles' areas; zero for vertices without
/// a normal.
Shape VertexNormals(const Connectivity& connectivity, const Shape& shape);
/// Unit normals of its triangles; zero for triangles without area.
Shape TriangleNormals(const Connectivity& connectivity, const Shape& shape);

/// A shape of a mesh, prepared for queries of the nearest point. Candidates are found by a
/// hierarchy of boxes, distances are computed in double precision. Nearest() may be called from
/// several threads at once.
class MeshSurface {
 public:
  /// The shape must be finite and have an extent; triangles without area are never found.
  /// \throw Error if Embree cannot start or runs out of memory.
  MeshSurface(std::shared_ptr<const Connectivity> connectivity, const Shape& shape);
  MeshSurface(MeshSurface&&) noexcept;
  ~MeshSurface();

  /// The nearest point on the triangles for which `admits(triangle)` is true (all, if it is null),
  /// not farther than `within`. Of equally near points the one on the triangle with the smallest
  /// index.
  ClosestPoint Nearest(const Eigen::Vector3d& point,
                       const std::function<bool(int triangle)>& admits = nullptr,
                       double within = std::numeric_limits<double>::infinity()) const;

  const Connectivity& GetConnectivity() const;
  const Shape& GetShape() const;
  const Shape& GetTriangleNormals() const;

 private:
  struct Scene;
  std::unique_ptr<Scene> scene_;
};

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_SURFACE_H_
