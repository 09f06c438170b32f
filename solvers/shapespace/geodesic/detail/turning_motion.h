#ifndef SHAPESPACE_GEODESIC_DETAIL_TURNING_MOTION_H_
#define SHAPESPACE_GEODESIC_DETAIL_TURNING_MOTION_H_

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/sparse/internal/gradient_integrator.h>

namespace shapespace::internal {

/// Whether a hinge turns by 180 degrees between two poses, to a thousandth of a radian.
bool HasFolds(const Connectivity& connectivity, const Shape& first, const Shape& last);

/// How the triangles turn from one pose to the other: the rotation of triangle f is first by column
/// f, a rotation vector, then by `whole`.
///
/// A part is a set of triangles of which neighbours turn by less than 90 degrees against each
/// other. `whole` is the rotation of a part with which most of the surface turns. Parts take the
/// shorter way round, all their triangles the same. A part to which both ways are equal, since it
/// turns by 180 degrees, takes the one on which its first fold, a hinge that turns by 180 degrees,
/// is flatter half-way: a lid opens outwards. If these are equal too, as in a sheet, it turns about
/// nearly the same axis as a part before it, so that parallel folds open like stairs, which cannot
/// meet each other. If there is none, it rises, seen in the pose in which its first fold is flat,
/// on the side of the normals. Parts follow in the order of their first folds among the hinges. The
/// turns thus depend on the mesh and its shapes alone, not on their frames.
struct Turns {
  Eigen::Matrix3Xd of_triangles;
  Eigen::Quaterniond whole = Eigen::Quaterniond::Identity();
};

Turns FindTurns(const Connectivity& connectivity, const Shape& first, const Shape& last);

/// A motion between two poses in which hinges turn by 180 degrees, such as those of a sheet that is
/// folded flat. Both ways round are equal, so that the blend of the poses, and often each pose, is
/// symmetric: the energy has no gradient out of the sheet, and descent never leaves it. This motion
/// turns every triangle about one axis instead (`FindTurns`), so that the sheet opens to one side,
/// and is where solves begin.
class TurningMotion {
 public:
  /// `connectivity` must outlive the motion.
  TurningMotion(const Connectivity& connectivity, const Shape& first, const Shape& last);

  /// The shape at a time in [0, 1]: that of the gradients that all triangles would have, each with
  /// a part of its turn and of its stretch.
  Shape At(double t) const;

 private:
  const Connectivity& connectivity_;
  const Turns turns_;
  const Shape first_, last_;  // without the rotation of the whole
  const SurfaceIntegrator integrator_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_GEODESIC_DETAIL_TURNING_MOTION_H_
