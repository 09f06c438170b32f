#include "arap.h"

#include <CGAL/Simple_cartesian.h>
#include <CGAL/Surface_mesh.h>
#include <CGAL/Surface_mesh_deformation.h>

#include <shapespace/base/error.h>

namespace shapespace::benchmarks {

using Kernel = CGAL::Simple_cartesian<double>;
using Mesh = CGAL::Surface_mesh<Kernel::Point_3>;
using Deformation =
    CGAL::Surface_mesh_deformation<Mesh, CGAL::Default, CGAL::Default, CGAL::SRE_ARAP>;

Shape DeformByArap(const Connectivity& connectivity, const Shape& rest,
                   const std::vector<DeformationHandle>& handles, int steps, int iterations) {
  Mesh mesh;
  std::vector<Mesh::Vertex_index> vertices;
  for (int v = 0; v < rest.cols(); ++v) {
    vertices.push_back(mesh.add_vertex({rest(0, v), rest(1, v), rest(2, v)}));
  }
  for (int f = 0; f < connectivity.NumTriangles(); ++f) {
    const Eigen::Vector3i t = connectivity.Triangles().col(f);
    mesh.add_face(vertices[t(0)], vertices[t(1)], vertices[t(2)]);
  }
  Deformation deformation(mesh);
  deformation.insert_roi_vertices(vertices.begin(), vertices.end());
  for (const DeformationHandle& handle : handles) {
    for (int v : handle.vertices) deformation.insert_control_vertex(vertices[v]);
  }
  if (!deformation.preprocess()) throw SolverError("CGAL's deformation cannot start");
  for (int step = 1; step <= steps; ++step) {
    const double t = static_cast<double>(step) / steps;
    for (const DeformationHandle& handle : handles) {
      for (size_t k = 0; k < handle.vertices.size(); ++k) {
        const int v = handle.vertices[k];
        const Eigen::Vector3d at = handle.Target(static_cast<int>(k), t, rest.col(v));
        deformation.set_target_position(vertices[v], {at.x(), at.y(), at.z()});
      }
    }
    deformation.deform(iterations, 1e-6);
  }
  Shape result(3, rest.cols());
  for (int v = 0; v < rest.cols(); ++v) {
    const Kernel::Point_3& p = mesh.point(vertices[v]);
    result.col(v) << p.x(), p.y(), p.z();
  }
  return result;
}

}  // namespace shapespace::benchmarks
