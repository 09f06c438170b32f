#ifndef SHAPESPACE_OUTPUT_DETAIL_PAGE_SCENE_H_
#define SHAPESPACE_OUTPUT_DETAIL_PAGE_SCENE_H_

#include <string>
#include <vector>

#include <shapespace/output/page.h>

// The data of a page's scene.

namespace shapespace::internal {

/// The data of one scene, compressed, as described in docs/file-formats.md under HTML. Sentences
/// about textures that cannot be shown are appended to `warnings`.
/// \throw MeshError if the scene is not valid.
std::string EncodeScene(const PagePath& scene, const PageView& view,
                        std::vector<std::string>* warnings);
std::string EncodeScene(const PageSpace& scene, const PageView& view);
std::string EncodeScene(const PageModes& scene, const PageView& view);
std::string EncodeScene(const PageMesh& scene, const PageView& view);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_PAGE_SCENE_H_
