#ifndef SHAPESPACE_OUTPUT_PAGE_H_
#define SHAPESPACE_OUTPUT_PAGE_H_

#include <array>
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/path/path.h>

namespace shapespace {

/// A path as a page shows it: the shapes as placed by the path; for every shape the deviation of
/// its edges from the first, for every segment its energy. Vertex colours are shown, materials and
/// textures are not; what is transparent is drawn opaque.
struct PagePath {
  const Path* path = nullptr;  ///< must outlive the call
  std::string name;            ///< as the page calls it, such as the file's
};

/// A binary glTF file, embedded as it is. The page samples its first animation.
struct PageGlb {
  std::string bytes;
  std::string name;
};

/// Shapes at points of a plane, blended linearly in between.
struct PageSpace {
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<Shape> nodes;        ///< the shape of every node, in the user's unit; the poses first
  std::vector<std::string> names;  ///< of the poses: how many there are tells where they end
  Eigen::Matrix2Xd points;         ///< the place of every node in the plane
  Eigen::Matrix3Xi triangles;      ///< of nodes, counterclockwise; empty where all lie on a line
  Eigen::Matrix2Xi segments;       ///< of nodes: instead of triangles where all lie on a line

  /// Of every node after the poses: it lies half way between these two, which come before it.
  std::vector<std::array<int, 2>> parents;
  Eigen::MatrixXd vertex_colours;  ///< as in an Appearance; may be empty
  std::string name;
};

using PageScene = std::variant<PagePath, PageGlb, PageSpace>;

/// Writes an HTML page that shows `scenes` and needs nothing else: no server and no network. There
/// is one scene, or two of paths and glb files, which the page shows side by side.
///
/// `page_template` is the content of the viewer that `./dev viewer` builds,
/// tools/viewer/dist/viewer.html, which is installed as share/shapespace/viewer.html. The tool
/// shape-view has it in itself.
///
/// Positions are rounded to 1/65535 of the longest side of the box around all shapes of a scene,
/// and are relative to that box, so that nothing is lost far from the origin; docs/file-formats.md
/// tells how they are coded. The file appears whole or not at all.
/// \throw InvalidOptions if `page_template` is no such viewer, or the number or kinds of scenes are
///        others than said; MeshError if a path or space is not valid, or too large for a page;
///        FileError if the file cannot be written.
void WritePage(const std::string& file, const std::string& page_template,
               const std::vector<PageScene>& scenes);

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_PAGE_H_
