#ifndef SHAPESPACE_SOLVERS_HANDLE_H_
#define SHAPESPACE_SOLVERS_HANDLE_H_

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/shape.h>

namespace shapespace {

/// A rigid motion together with its way: at t in [0, 1] everything has turned by t times `angle`
/// about the direction `axis` through `point`, and has then moved by t times `translation`. Where
/// the translation runs along the axis this is a screw motion. Turns of 180 degrees and more are
/// what they say, and not the short way to the same place.
struct ScrewMotion {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< of any length but 0
  double angle = 0;                                 ///< radians
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  /// Where `x` is at `t`.
  Eigen::Vector3d At(double t, const Eigen::Vector3d& x) const;
};

/// Some vertices of a mesh, and where they are to be in the end. All lengths are in the user's unit
/// and frame.
struct Handle {
  std::string name;           ///< for messages and reports; may be empty
  std::vector<int> vertices;  ///< counted from 0, at least one, each once

  /// Where each of the vertices is to be in the end, 3 x vertices: the way there is left to the
  /// metric. Without, they move rigidly, as `motion` says; by default they stay where they are.
  std::optional<Shape> positions;
  ScrewMotion motion;

  /// A hard handle is met exactly: positions by the last shape of a path, a motion by all of its
  /// shapes. A soft one pulls at the last shape, in proportion to its weight.
  bool hard = true;
  double weight = 1;  ///< of a soft handle, positive

  /// Where the handle wants its vertices[place], which begins at `from`, at t in [0, 1]: positions
  /// are approached along straight lines.
  Eigen::Vector3d Target(int place, double t, const Eigen::Vector3d& from) const;
};

}  // namespace shapespace

#endif  // SHAPESPACE_SOLVERS_HANDLE_H_
