#ifndef SHAPESPACE_MESH_OPENMESH_H_
#define SHAPESPACE_MESH_OPENMESH_H_

#include <cmath>
#include <string>
#include <vector>

#include <shapespace/base/error.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/mesh/soup.h>

// Conversion from and to OpenMesh's mesh types. This header includes nothing of OpenMesh: the
// caller includes the headers of the type, and links OpenMesh.

namespace shapespace {

/// Converts any triangle or polygon mesh of OpenMesh (`TriMesh_ArrayKernelT`,
/// `PolyMesh_ArrayKernelT`, with any traits) to a soup: vertex and polygon i are the handles of
/// index i. Coordinates become doubles. `name` is the name of the mesh in messages.
/// \throw MeshError if it contains deleted elements: call `garbage_collection` first, which
///        renumbers the others.
template <typename Mesh>
Soup FromOpenMesh(const Mesh& mesh, const std::string& name = "mesh") {
  const auto check = [&](bool has_status, const auto& handles, const char* what) {
    if (!has_status) return;
    for (const auto handle : handles) {
      if (mesh.status(handle).deleted()) {
        throw MeshError(name + ": " + what + " " + std::to_string(handle.idx() + 1) +
                        " was deleted and is still there; call garbage_collection() first");
      }
    }
  };
  check(mesh.has_vertex_status(), mesh.all_vertices(), "vertex");
  check(mesh.has_face_status(), mesh.all_faces(), "polygon");
  Soup soup;
  soup.file = name;
  soup.vertices.resize(3, static_cast<Eigen::Index>(mesh.n_vertices()));
  for (const auto vertex : mesh.all_vertices()) {
    const auto& point = mesh.point(vertex);
    for (int axis = 0; axis < 3; ++axis) {
      soup.vertices(axis, vertex.idx()) = static_cast<double>(point[axis]);
    }
  }
  for (const auto face : mesh.all_faces()) {
    for (auto corner = mesh.cfv_iter(face); corner.is_valid(); ++corner) {
      soup.corners.push_back(corner->idx());
    }
    soup.polygon_begin.push_back(static_cast<int>(soup.corners.size()));
  }
  return soup;
}

/// Converts to a mesh of OpenMesh's type `Mesh`. Its vertex handle of index i is vertex i of
/// `shape`; its face handle of index i is polygon i of the connectivity or, for a triangle mesh,
/// triangle i of `Connectivity::Triangles`. Coordinates are rounded if the type's are floats.
/// Segments and stiffeners are omitted, because OpenMesh has no edges without faces.
/// \throw MeshError if the shape has another number of vertices, a coordinate is outside of the
///        type's range, or OpenMesh rejects a face: it does not support non-manifold edges or
///        vertices.
template <typename Mesh>
Mesh ToOpenMesh(const Connectivity& connectivity, const Shape& shape) {
  if (shape.cols() != connectivity.NumVertices()) {
    throw MeshError("the shape has " + std::to_string(shape.cols()) +
                    " vertices, its connectivity " + std::to_string(connectivity.NumVertices()));
  }
  Mesh mesh;
  for (int v = 0; v < connectivity.NumVertices(); ++v) {
    typename Mesh::Point point;
    for (int axis = 0; axis < 3; ++axis) {
      point[axis] = static_cast<typename Mesh::Scalar>(shape(axis, v));
      if (!std::isfinite(point[axis])) {
        throw MeshError("vertex " + std::to_string(v + 1) +
                        " has a coordinate that this type of mesh cannot hold");
      }
    }
    mesh.add_vertex(point);
  }
  constexpr bool triangles = Mesh::is_trimesh();
  const int num_faces = triangles ? connectivity.NumTriangles() : connectivity.NumPolygons();
  std::vector<typename Mesh::VertexHandle> corners;
  for (int f = 0; f < num_faces; ++f) {
    const int* const data = triangles
                                ? connectivity.FileTriangles().col(f).data()
                                : connectivity.Corners().data() + connectivity.PolygonBegin()[f];
    const int size =
        triangles ? 3 : connectivity.PolygonBegin()[f + 1] - connectivity.PolygonBegin()[f];
    corners.clear();
    for (int k = 0; k < size; ++k) corners.emplace_back(data[k]);
    if (!mesh.add_face(corners).is_valid()) {
      throw MeshError(std::string(triangles ? "triangle " : "polygon ") + std::to_string(f + 1) +
                      " makes the mesh non-manifold, which OpenMesh cannot hold");
    }
  }
  return mesh;
}

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_OPENMESH_H_
