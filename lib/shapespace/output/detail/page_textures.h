#ifndef SHAPESPACE_OUTPUT_DETAIL_PAGE_TEXTURES_H_
#define SHAPESPACE_OUTPUT_DETAIL_PAGE_TEXTURES_H_

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/appearance.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/output/detail/materials.h>

// The textures of a page.

namespace shapespace::internal {

/// A textured surface as it is drawn: cut where its texture has seams, in parts of one texture or
/// colour each.
struct PageTextures {
  struct Part {
    int triangles = 0;
    int image = -1;                                        ///< of `images`; -1: none
    std::optional<Eigen::Vector3d> colour = std::nullopt;  ///< of a material without image, in sRGB
  };

  std::vector<int> source;       ///< the vertex of the connectivity for each that is drawn
  Eigen::Matrix2Xf coordinates;  ///< of those that are drawn; v points down
  std::vector<int> corners;      ///< vertices that are drawn, three for each triangle of the parts
  std::vector<Part> parts;
  std::vector<TextureImage> images;
};

/// Nothing if no triangle has an image that can be shown. Sentences about images and material
/// libraries that cannot be read are appended to `warnings`.
std::optional<PageTextures> FindPageTextures(const Connectivity& connectivity,
                                             const Appearance& appearance, bool allow_outside_files,
                                             std::vector<std::string>* warnings);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_PAGE_TEXTURES_H_
