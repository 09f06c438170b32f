#include <shapespace/matching/detail/working_surface.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/hierarchy/hierarchy.h>
#include <shapespace/matching/detail/surface_graph.h>
#include <shapespace/matching/internal/check_body.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/mesh/internal/sides.h>
#include <shapespace/mesh/internal/submesh.h>

namespace shapespace::internal {
namespace {

// With 10000 triangles, the functions that are used (at most 100) have some 50 vertices for each
// of their waves.
constexpr int kDecimated = 10000;

// The vertices of the component whose area is largest; of equal ones, the one with the vertex of
// the smallest number.
std::vector<bool> LargestComponent(const Eigen::Matrix3Xi& triangles, const Eigen::VectorXd& areas,
                                   int num_vertices) {
  UnionFind components(num_vertices);
  for (const auto& triangle : triangles.colwise()) {
    components.Join(triangle(0), triangle(1));
    components.Join(triangle(0), triangle(2));
  }
  Eigen::VectorXd total = Eigen::VectorXd::Zero(num_vertices);
  for (int f = 0; f < triangles.cols(); ++f) total(components.Find(triangles(0, f))) += areas(f);
  Eigen::Index largest;
  total.maxCoeff(&largest);
  std::vector<bool> members(num_vertices);
  for (int v = 0; v < num_vertices; ++v) members[v] = components.Find(v) == largest;
  return members;
}

void ScaleToAreaOne(const Connectivity& connectivity, Shape* shape) {
  double area = 0;
  for (const auto& triangle : connectivity.Triangles().colwise()) {
    area += TriangleArea(*shape, triangle);
  }
  *shape /= std::sqrt(area);
}

}  // namespace

WorkingSurface MakeWorkingSurface(const std::string& name, const Connectivity& connectivity,
                                  const Shape& shape, Progress* progress) {
  CheckBody(name, connectivity, shape);
  // Near the origin and of size 1, lest digits be lost and squares overflow.
  const Eigen::Vector3d low = shape.rowwise().minCoeff();
  const double extent = (shape.rowwise().maxCoeff() - low).maxCoeff();
  const Shape near = (shape.colwise() - low) / extent;
  const Eigen::Matrix3Xi& all = connectivity.Triangles();
  Eigen::VectorXd areas(all.cols());
  for (int f = 0; f < all.cols(); ++f) areas(f) = TriangleArea(near, all.col(f));
  if (!(areas.sum() > 0)) throw MeshError("the " + name + " has no area");

  Submesh part =
      MakeSubmesh(connectivity, LargestComponent(all, areas, connectivity.NumVertices()));
  WorkingSurface surface;
  surface.connectivity = std::move(part.connectivity);
  surface.vertices = std::move(part.vertices);
  surface.nearest = std::move(part.index);
  surface.shape = near(Eigen::all, surface.vertices);

  if (surface.connectivity->NumTriangles() > 2 * kDecimated) {
    HierarchyOptions options;
    options.coarsest = kDecimated;
    const Hierarchy hierarchy(surface.connectivity, {surface.shape}, options, progress);
    const std::vector<int>& kept = hierarchy.Vertices(0);
    const std::vector<int> nearest =
        SurfaceGraph(*surface.connectivity, surface.shape).NearestOf(kept);
    for (int& v : surface.nearest) v = v < 0 ? -1 : nearest[v];
    surface.shape = hierarchy.Restrict(surface.shape, 0);
    surface.connectivity = hierarchy.LevelConnectivity(0);
    std::vector<int> vertices;
    for (const int v : kept) vertices.push_back(surface.vertices[v]);
    surface.vertices = std::move(vertices);
  }
  connectivity.CopyToTwins(&surface.nearest);
  ScaleToAreaOne(*surface.connectivity, &surface.shape);
  return surface;
}

}  // namespace shapespace::internal
