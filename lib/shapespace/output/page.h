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

/// A path on a page: the shapes as placed by the path, the deviation of each shape's edges from the
/// first shape, the energy of each segment and at each vertex, near-rigid parts, and the triangles
/// that intersect. Vertex colours and textures are shown, the colours of materials only beside
/// textures; transparent surfaces are drawn opaque.
struct PagePath {
  const Path* path = nullptr;  ///< must outlive the call
  std::string name;            ///< its name on the page, such as the file's
  std::string file = {};       ///< with its folder, for command lines on the page; empty: none
  /// Whether material libraries and textures are also read from outside of
  /// `Appearance::own_folder`.
  bool allow_outside_files = false;
};

/// A binary glTF file, embedded unchanged. The page samples its first animation.
struct PageGlb {
  std::string bytes;
  std::string name;
};

/// Shapes at points of a plane, blended linearly in between.
struct PageSpace {
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<Shape> nodes;        ///< the shape of every node, in the user's unit; the poses first
  std::vector<std::string> names;  ///< of the poses; their number is that of the poses
  Eigen::Matrix2Xd points;         ///< the position of every node on the plane
  Eigen::Matrix3Xi triangles;      ///< of nodes, counterclockwise; empty if all lie on a line
  Eigen::Matrix2Xi segments;       ///< of nodes, instead of triangles if all lie on a line

  /// For every node after the poses: the two earlier nodes of which it is the midpoint.
  std::vector<std::array<int, 2>> parents;
  Eigen::MatrixXd vertex_colours;  ///< as in an Appearance; may be empty
  std::string name;
};

/// Shapes at coordinates, one for each mode, which sliders set; what is shown is made of keys: with
/// the mean M, the shape of mode k at coordinate p_j K_kj, and that of two modes k < l P_kl,
///   M + sum_kj L_j(c_k) (K_kj - M) + sum_kl c_k c_l / p^2 (P_kl - M),
/// where L_j is the polynomial that is 1 at p_j and 0 at the other places and at 0.
struct PageModes {
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<double> places;  ///< p_j, in ascending order, without 0; the sliders' ends are the
                               ///< first and the last
  double pair_place = 1;       ///< p
  /// M, then all K of the first mode, of the second ..., then all P: of modes 1 and 2, 1 and 3,
  /// ..., 2 and 3, ... In the user's unit.
  std::vector<Shape> keys;
  Eigen::Vector3d up = Eigen::Vector3d::Zero();  ///< what points up; zero: chosen from the keys
  double error = 0;            ///< distance of what is shown from exact shapes, as a share of the
                               ///< mean's diagonal
  std::vector<double> shares;  ///< of the variance, one for each mode
  std::vector<std::string> names;  ///< of the poses
  Eigen::MatrixXd coordinates;     ///< a row for each pose, a column for each mode

  /// Coordinates are intercept + slopes * values of scalars, if there are any.
  struct Scalar {
    std::string name;
    double least = 0, most = 0, value = 0;  ///< the range of its slider, and where it starts
  };
  std::vector<Scalar> scalars;
  Eigen::VectorXd intercept;
  Eigen::MatrixXd slopes;

  std::string file;                ///< of the model, with its folder, for command lines on the page
  Eigen::MatrixXd vertex_colours;  ///< as in an Appearance; may be empty
  std::string name;

  int NumModes() const { return static_cast<int>(shares.size()); }
};

/// A mesh whose vertices are picked on the page, which saves them as files that the tools read:
/// markers of two meshes, handles and selections of one. The page numbers vertices as the
/// connectivity does.
struct PageMesh {
  std::shared_ptr<const Connectivity> connectivity;
  Shape shape;                     ///< in the user's unit
  Eigen::MatrixXd vertex_colours;  ///< as in an Appearance; may be empty
  std::string name;
  std::string file = {};  ///< with its folder, for command lines on the page
  /// Vertices that are picked at first: those of two meshes with the same place here are a marker.
  std::vector<int> markers = {};
};

/// From where a page shows its scenes at first. What is zero is chosen from the shapes.
struct PageView {
  Eigen::Vector3d up = Eigen::Vector3d::Zero();   ///< what points up
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();  ///< the direction from the body to the eye

  /// \throw InvalidOptions naming the field: not finite, or `up` parallel to `eye`.
  void Validate() const;
};

using PageScene = std::variant<PagePath, PageGlb, PageSpace, PageModes, PageMesh>;

/// A self-contained HTML page that shows `scenes` without a server or a network. There may be one
/// scene, or two paths or glb files, or two meshes, which are shown side by side.
///
/// `page_template` is the content of the viewer that `./dev viewer` builds,
/// tools/viewer/dist/viewer.html, which is installed as share/shapespace/viewer.html. The tool
/// shape-view contains it.
///
/// Positions are relative to the box around all shapes of a scene and rounded to 1/65535 of its
/// longest side, so that accuracy does not depend on the distance from the origin;
/// docs/file-formats.md describes the encoding. `view` is that of all scenes but glb files.
/// Sentences about textures that cannot be shown are appended to `warnings`, which may be null.
/// \throw InvalidOptions if `page_template` is not such a viewer, or the number or kinds of scenes
///        are not permitted; MeshError if a path or space is not valid, or too large for a page.
std::string MakePage(const std::string& page_template, const std::vector<PageScene>& scenes,
                     const PageView& view = {}, std::vector<std::string>* warnings = nullptr);

/// Writes such a page, completely or not at all.
/// \throw as above; FileError if the file cannot be written.
void WritePage(const std::string& file, const std::string& page_template,
               const std::vector<PageScene>& scenes, const PageView& view = {},
               std::vector<std::string>* warnings = nullptr);

}  // namespace shapespace

#endif  // SHAPESPACE_OUTPUT_PAGE_H_
