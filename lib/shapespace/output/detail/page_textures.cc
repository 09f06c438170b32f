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
  // Of vertices that a file stores several times, the surface has the first.
  for (Eigen::Index corner = 0; corner < cut.triangles.size(); ++corner) {
    textures.source[cut.triangles(corner)] = connectivity.Triangles()(corner);
  }
  const std::vector<std::vector<int>> corners = CornersByMaterial(connectivity, cut, appearance);
  for (size_t i = 0; i < corners.size(); ++i) {
    textures.parts[i].triangles = static_cast<int>(corners[i].size() / 3);
    textures.corners.insert(textures.corners.end(), corners[i].begin(), corners[i].end());
  }
  return textures;
}

}  // namespace shapespace::internal
