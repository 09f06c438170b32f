#include <shapespace/mesh/openmesh.h>

#include <limits>

#include <OpenMesh/Core/Mesh/PolyMesh_ArrayKernelT.hh>
#include <OpenMesh/Core/Mesh/TriMesh_ArrayKernelT.hh>

#include <shapespace/files/read.h>

#include "mesh/bodies.h"
#include "mesh/files.h"

namespace shapespace {
namespace {

using testing::Connected;
using testing::Cube;
using testing::ExpectError;
using testing::Grid;

struct DoubleTraits : OpenMesh::DefaultTraits {
  using Point = OpenMesh::Vec3d;
  using Normal = OpenMesh::Vec3d;
};
using TriangleMesh = OpenMesh::TriMesh_ArrayKernelT<DoubleTraits>;
using PolygonMesh = OpenMesh::PolyMesh_ArrayKernelT<DoubleTraits>;
using FloatMesh = OpenMesh::PolyMesh_ArrayKernelT<>;

TEST(OpenMeshTest, PolygonsComeBackAsTheyWere) {
  Soup cube = Cube();
  cube.vertices.array() += 1.0 / 3;  // no float
  const auto mesh = ToOpenMesh<PolygonMesh>(*Connected(cube), cube.vertices);
  EXPECT_EQ(mesh.n_vertices(), 8U);
  EXPECT_EQ(mesh.n_edges(), 12U);
  EXPECT_EQ(mesh.n_faces(), 6U);
  const Soup back = FromOpenMesh(mesh, "cube");
  EXPECT_EQ(back.file, "cube");
  EXPECT_EQ(back.vertices, cube.vertices);
  EXPECT_EQ(back.corners, cube.corners);
  EXPECT_EQ(back.polygon_begin, cube.polygon_begin);
  EXPECT_EQ(MakePoses({back, back}).connectivity->NumPolygons(), 6);
}

TEST(OpenMeshTest, TriangleMeshesGetTheTriangles) {
  const Soup grid = Grid(3, 4);
  const auto connectivity = Connected(grid);
  const Soup back = FromOpenMesh(ToOpenMesh<TriangleMesh>(*connectivity, grid.vertices));
  const Eigen::Matrix3Xi& triangles = connectivity->Triangles();
  EXPECT_EQ(back.corners, std::vector<int>(triangles.data(), triangles.data() + triangles.size()));
  EXPECT_EQ(back.vertices, grid.vertices);
}

TEST(OpenMeshTest, FloatsAreTakenAsTheyAre) {
  FloatMesh mesh;
  const auto a = mesh.add_vertex({0.1F, 0, 0}), b = mesh.add_vertex({1, 0, 0}),
             c = mesh.add_vertex({0, 1, 0});
  mesh.add_face(a, b, c);
  const Soup soup = FromOpenMesh(mesh);
  EXPECT_EQ(soup.vertices(0, 0), static_cast<double>(0.1F));
  Shape huge = soup.vertices;
  huge(2, 1) = 1e300;
  ExpectError<MeshError>([&] { ToOpenMesh<FloatMesh>(*Connected(soup), huge); }, {"vertex 2"});
}

TEST(OpenMeshTest, DeletedElementsAreRefusedUntilTheyAreGone) {
  auto mesh = ToOpenMesh<PolygonMesh>(*Connected(Cube()), Cube().vertices);
  mesh.request_vertex_status();
  mesh.request_edge_status();
  mesh.request_face_status();
  mesh.delete_face(mesh.face_handle(2), false);
  ExpectError<MeshError>([&] { FromOpenMesh(mesh, "cube"); },
                         {"cube", "polygon 3", "garbage_collection"});
  mesh.garbage_collection();
  EXPECT_EQ(FromOpenMesh(mesh).NumPolygons(), 5);
}

TEST(OpenMeshTest, WhatOpenMeshCannotHoldIsNamed) {
  // Three triangles at one edge.
  Eigen::Matrix3Xi book(3, 3);
  book << 0, 1, 0, 1, 0, 1, 2, 3, 4;
  const auto connectivity = Connectivity::FromTriangles(5, book);
  const Shape shape = Shape::Random(3, 5);
  ExpectError<MeshError>([&] { ToOpenMesh<TriangleMesh>(*connectivity, shape); }, {"triangle 3"});
  ExpectError<MeshError>([&] { ToOpenMesh<PolygonMesh>(*connectivity, shape.leftCols(4)); },
                         {"4 vertices", "5"});
}

}  // namespace
}  // namespace shapespace
