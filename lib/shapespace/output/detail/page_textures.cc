#include <shapespace/output/detail/page_textures.h>

#include <map>

#include <shapespace/output/detail/seams.h>

namespace shapespace::internal {

std::optional<PageTextures> FindPageTextures(const Connectivity& connectivity,
                                             const Appearance& appearance, bool allow_outside_files,
                                             std::vector<std::string>* warnings) {
  const PolygonNames& materials = appearance.materials;
  if (appearance.corner_texture.empty() || materials.of_polygon.empty()) return {};
  PageTextures textures;
  textures.parts.resize(materials.names.size() + 1);  // last: of no material
  const std::vector<std::optional<Material>> described =
      ReadMaterials(appearance, allow_outside_files, warnings);
  std::map<std::string, int> known;
  for (size_t i = 0; i < described.size(); ++i) {
    if (!described[i]) continue;
    PageTextures::Part& part = textures.parts[i];
    if (const std::string& file = described[i]->texture; !file.empty()) {
      const auto [found, is_new] = known.try_emplace(file, -1);
      if (is_new) {
        if (auto image = ReadTexture(file, appearance, allow_outside_files, warnings)) {
          found->second = static_cast<int>(textures.images.size());
          textures.images.push_back(std::move(*image));
        }
      }
      part.image = found->second;
    }
    if (part.image < 0) part.colour = described[i]->colour;
  }
  if (textures.images.empty()) return {};

  const CutMesh cut = CutAtSeams(connectivity, appearance);
  textures.source = cut.source;
  textures.coordinates = cut.texture;
  const std::vector<int> polygons = PolygonsOfTriangles(connectivity);
  std::vector<std::vector<int>> triangles(textures.parts.size());
  for (int f = 0; f < connectivity.NumTriangles(); ++f) {
    const int material = materials.of_polygon[polygons[f]];
    triangles[material < 0 ? triangles.size() - 1 : material].push_back(f);
  }
  for (size_t i = 0; i < triangles.size(); ++i) {
    textures.parts[i].triangles = static_cast<int>(triangles[i].size());
    for (const int f : triangles[i]) {
      for (int k = 0; k < 3; ++k) {
        const int drawn = cut.triangles(k, f);
        textures.corners.push_back(drawn);
        // Of vertices that a file stores several times, the surface has the first.
        textures.source[drawn] = connectivity.Triangles()(k, f);
      }
    }
  }
  return textures;
}

}  // namespace shapespace::internal
