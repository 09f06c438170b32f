#ifndef SHAPESPACE_MESH_SELECTION_H_
#define SHAPESPACE_MESH_SELECTION_H_

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/appearance.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

/// A set of vertices, defined by conditions. Fields that are not set are no condition; if several
/// are set, all must be satisfied. Lengths and positions are in the user's unit and frame.
struct Selection {
  struct Ball {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    double radius = 0;  ///< zero or more
  };
  struct Box {
    Eigen::Vector3d low = Eigen::Vector3d::Zero(), high = Eigen::Vector3d::Zero();
  };
  /// The points on the side of a plane through `point` to which `normal` points.
  struct HalfSpace {
    Eigen::Vector3d point = Eigen::Vector3d::Zero();
    Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< of any length but 0
  };

  /// Ranges of vertices, each from its first to its last, counted from 0.
  std::vector<std::pair<int, int>> vertices;
  std::optional<Ball> ball;
  std::optional<Box> box;
  std::optional<HalfSpace> halfspace;

  /// The vertices of the polygons with this OBJ group (`g`) or object (`o`): all names of a
  /// polygon, or one of them, if blanks separate several.
  std::optional<std::string> group;

  std::vector<Selection> any;  ///< the vertices selected by at least one of these

  /// \throw InvalidOptions naming the field: no field is set, or a number is not finite, beyond
  ///        `kLargestCoordinate` or out of its range.
  void Validate() const;
};

/// Reads a selection in its text form, which is JSON: {"ball": {"centre": [0, 0, 0], "radius": 2}}.
/// In it vertices are counted from 1. See docs/file-formats.md.
/// \throw InvalidOptions naming the field, or the line if the text is not valid JSON.
Selection ReadSelection(const std::string& text);

/// The text form, on one line; `ReadSelection` reads it back.
std::string ToText(const Selection& selection);

/// The vertices selected in `shape`, counted from 0, ascending and without repetitions. The
/// boundary of a ball, a box or a half-space belongs to it, within a billionth of the shape's
/// diameter.
/// \throw InvalidOptions as `Validate`; also if a vertex does not exist, no polygon has the group,
///        or the selection, or one of those in an `any`, has no vertex. MeshError if the arguments
///        do not belong to one mesh.
std::vector<int> SelectVertices(const Selection& selection, const Shape& shape,
                                const Connectivity& connectivity, const Appearance& appearance);

}  // namespace shapespace

#endif  // SHAPESPACE_MESH_SELECTION_H_
