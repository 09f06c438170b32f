#ifndef SHAPESPACE_OUTPUT_DETAIL_PAGE_SCENE_H_
#define SHAPESPACE_OUTPUT_DETAIL_PAGE_SCENE_H_

#include <string>

#include <shapespace/output/page.h>

// The data of a page's scene.

namespace shapespace::internal {

/// The data of one scene, compressed, as described in docs/file-formats.md under HTML.
/// \throw MeshError if the scene is not valid.
std::string EncodeScene(const PagePath& scene, const PageView& view);
std::string EncodeScene(const PageSpace& scene, const PageView& view);
std::string EncodeScene(const PageModes& scene, const PageView& view);
std::string EncodeScene(const PageMesh& scene, const PageView& view);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_OUTPUT_DETAIL_PAGE_SCENE_H_
