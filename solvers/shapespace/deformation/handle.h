#ifndef SHAPESPACE_DEFORMATION_HANDLE_H_
#define SHAPESPACE_DEFORMATION_HANDLE_H_

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/shape.h>

namespace shapespace {

/// A rigid motion with its course in time: at t in [0, 1] everything is rotated by t times `angle`
/// about the direction `axis` through `point` and then translated by t times `translation`. If the
/// translation is parallel to the axis this is a screw motion. Angles of 180 degrees and more are
/// not reduced to the shorter way.
struct ScrewMotion {
  Eigen::Vector3d axis = Eigen::Vector3d::UnitZ();  ///< of any length but 0
  double angle = 0;                                 ///< radians
  Eigen::Vector3d point = Eigen::Vector3d::Zero();
  Eigen::Vector3d translation = Eigen::Vector3d::Zero();

  /// Where `x` is at `t`.
  Eigen::Vector3d At(double t, const Eigen::Vector3d& x) const;
};

/// Some vertices of a mesh and their target positions. All lengths are in the user's unit and
/// frame.
struct DeformationHandle {
  std::string name;           ///< for messages and reports; may be empty
  std::vector<int> vertices;  ///< counted from 0; at least one, no repetitions

  /// Target position of each of the vertices, 3 x vertices; their course in time is determined by
  /// the metric. If absent, the vertices move rigidly by `motion`, whose default leaves them where
  /// they are.
  std::optional<Shape> positions;
  ScrewMotion motion;

  /// A hard handle is satisfied exactly: positions in the last shape of a path, a motion in all of
  /// its shapes. A soft one is a penalty on the last shape, proportional to its weight.
  bool hard = true;
  double weight = 1;  ///< of a soft handle, positive

  /// Target at t in [0, 1] of vertices[place], whose position at t = 0 is `from`; `positions` are
  /// approached along straight lines.
  Eigen::Vector3d Target(int place, double t, const Eigen::Vector3d& from) const;
};

}  // namespace shapespace

#endif  // SHAPESPACE_DEFORMATION_HANDLE_H_
