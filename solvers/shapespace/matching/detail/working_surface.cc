#include <shapespace/matching/detail/working_surface.h>

#include <algorithm>
#include <cmath>
#include <map>
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
// With fewer, maps go astray at heads and feet, which have too few vertices. Cut triangles help if
// there are so many then.
constexpr int kFewestTriangles = 4000;

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

// Cuts each triangle into four at the midpoints of its edges, which follow the other vertices.
void CutTriangles(WorkingSurface* surface) {
  const Connectivity& before = *surface->connectivity;
  const int count = before.NumVertices() + before.NumEdges();
  surface->shape.conservativeResize(Eigen::NoChange, count);
  std::map<std::pair<int, int>, int> midpoints;
  for (const auto& edge : before.Edges().colwise()) {
    const auto midpoint = static_cast<int>(surface->vertices.size());
    midpoints[{edge(0), edge(1)}] = midpoint;
    surface->shape.col(midpoint) = (surface->shape.col(edge(0)) + surface->shape.col(edge(1))) / 2;
    surface->vertices.push_back(surface->vertices[edge(0)]);
  }
  Eigen::Matrix3Xi triangles(3, 4 * before.NumTriangles());
  for (int f = 0; f < before.NumTriangles(); ++f) {
    const Eigen::Vector3i corners = before.Triangles().col(f);
    Eigen::Vector3i middle;
    for (int i = 0; i < 3; ++i) {
      middle(i) = midpoints.at(std::minmax({corners(i), corners((i + 1) % 3)}));
    }
    for (int i = 0; i < 3; ++i) {
      triangles.col(4 * f + i) << corners(i), middle(i), middle((i + 2) % 3);
    }
    triangles.col(4 * f + 3) = middle;
  }
  surface->connectivity = Connectivity::FromTriangles(count, triangles);
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
  surface.num_own = surface.NumVertices();
  const int triangles = surface.connectivity->NumTriangles();
  if (triangles < kFewestTriangles && 4 * triangles >= kFewestTriangles) CutTriangles(&surface);
  connectivity.CopyToTwins(&surface.nearest);
  ScaleToAreaOne(*surface.connectivity, &surface.shape);
  return surface;
}

}  // namespace shapespace::internal
