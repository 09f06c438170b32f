#include <shapespace/output/detail/seams.h>

#include <algorithm>
#include <numeric>

namespace shapespace::internal {

std::vector<int> PolygonsOfTriangles(const Connectivity& connectivity) {
  const std::vector<int>& begin = connectivity.PolygonBegin();
  std::vector<int> polygons;
  polygons.reserve(connectivity.NumTriangles());
  for (int p = 0; p < connectivity.NumPolygons(); ++p) {
    polygons.insert(polygons.end(), begin[p + 1] - begin[p] - 2, p);
  }
  return polygons;
}

CutMesh CutAtSeams(const Connectivity& connectivity, const Appearance& appearance) {
  CutMesh mesh;
  mesh.source.resize(connectivity.NumVertices());
  std::iota(mesh.source.begin(), mesh.source.end(), 0);
  mesh.triangles = connectivity.FileTriangles();
  if (appearance.corner_texture.empty()) return mesh;

  // Per vertex: its texture coordinate if it has one, and the next copy of the same vertex.
  std::vector<Eigen::Vector2f> texture(mesh.source.size());
  std::vector<bool> textured(mesh.source.size(), false);
  std::vector<int> next(mesh.source.size(), -1);
  const auto vertex_with = [&](int vertex, const Eigen::Vector2f& coordinate) {
    if (!textured[vertex]) {
      textured[vertex] = true;
      texture[vertex] = coordinate;
      return vertex;
    }
    int copy = vertex;
    while (texture[copy] != coordinate && next[copy] >= 0) copy = next[copy];
    if (texture[copy] == coordinate) return copy;
    next[copy] = static_cast<int>(mesh.source.size());
    mesh.source.push_back(vertex);
    texture.push_back(coordinate);
    textured.push_back(true);
    next.push_back(-1);
    return next[copy];
  };

  const std::vector<int> polygons = PolygonsOfTriangles(connectivity);
  const std::vector<int>& corners = connectivity.Corners();
  for (int f = 0; f < connectivity.NumTriangles(); ++f) {
    const int begin = connectivity.PolygonBegin()[polygons[f]];
    for (int& vertex : mesh.triangles.col(f)) {
      const auto corner = std::find(corners.begin() + begin, corners.end(), vertex);
      const int index = appearance.corner_texture[corner - corners.begin()];
      if (index < 0) continue;
      const Eigen::Vector2d uv = appearance.texture_coordinates.col(index);
      // glTF's v points down.
      vertex = vertex_with(vertex, Eigen::Vector2d(uv.x(), 1 - uv.y()).cast<float>());
    }
  }
  mesh.texture.resize(2, texture.size());
  for (size_t v = 0; v < texture.size(); ++v) {
    mesh.texture.col(v) = textured[v] ? texture[v] : Eigen::Vector2f::Zero();
  }
  return mesh;
}

std::vector<std::vector<int>> CornersByMaterial(const Connectivity& connectivity,
                                                const CutMesh& mesh, const Appearance& appearance) {
  std::vector<std::vector<int>> corners(appearance.materials.names.size() + 1);
  const std::vector<int>& material_of = appearance.materials.of_polygon;
  const std::vector<int> polygons = PolygonsOfTriangles(connectivity);
  for (size_t f = 0; f < polygons.size(); ++f) {
    const int material = material_of.empty() ? -1 : material_of[polygons[f]];
    std::vector<int>& part = material < 0 ? corners.back() : corners[material];
    for (const int vertex : mesh.triangles.col(f)) part.push_back(vertex);
  }
  return corners;
}

}  // namespace shapespace::internal
