// Converts an OpenMesh mesh to poses, and a pose back to an OpenMesh mesh.
#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>

#include <shapespace/files/read.h>
#include <shapespace/mesh/openmesh.h>

int main() {
  using Mesh = OpenMesh::PolyMesh_ArrayKernelT<>;
  Mesh mesh;
  const auto a = mesh.add_vertex({0, 0, 0}), b = mesh.add_vertex({1, 0, 0}),
             c = mesh.add_vertex({1, 1, 0}), d = mesh.add_vertex({0, 1, 0});
  mesh.add_face(a, b, c, d);
  const shapespace::Poses poses = shapespace::MakePoses(
      {shapespace::FromOpenMesh(mesh, "flat"), shapespace::FromOpenMesh(mesh, "again")});
  const auto back = shapespace::ToOpenMesh<Mesh>(*poses.connectivity, 2 * poses.shapes[1]);
  return back.n_faces() == 1 && back.point(c) == Mesh::Point(2, 2, 0) ? 0 : 1;
}
