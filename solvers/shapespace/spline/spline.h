#ifndef SHAPESPACE_SPLINE_SPLINE_H_
#define SHAPESPACE_SPLINE_SPLINE_H_

#include <memory>
#include <string>
#include <vector>

#include <shapespace/base/not_computed.h>
#include <shapespace/geodesic/geodesic.h>

namespace shapespace {

/// What determines the velocity at the ends of a spline.
enum class SplineEnds {
  kNatural,   ///< no acceleration at the ends
  kClamped,   ///< SplineOptions::first_velocity and last_velocity
  kNotAKnot,  ///< the first two intervals are one cubic, and so are the last two: exact for motions
              ///< that are cubic in time, but it swings further on sparse data
  kPeriodic,  ///< the motion goes on from the last pose to the first, as a walk cycle does
};

struct SplineOptions {
  SplineEnds ends = SplineEnds::kNatural;

  /// When the poses are met: ascending, in any unit of time, one for each pose, and for periodic
  /// splines one more, when the first pose is met again. Between two shapes there must be more than
  /// 1e-12 of the whole time. Empty: evenly spaced, or `by_length`.
  std::vector<double> times;

  /// Without `times`, the time between two poses is in proportion to the length of the geodesic
  /// between them, so that the mean speed is the same everywhere.
  bool by_length = false;

  /// For kClamped, 3 x m, in the user's unit per unit of `times` (per interval, if these are
  /// empty).
  Tangent first_velocity, last_velocity;

  /// Velocities at a pose are at most this number times the slower of the two mean velocities
  /// beside it, part by part, so that a pose that is held is held; 0: no limit.
  double hold_limit = 3;

  /// Of the geodesics between neighbouring poses. Fewer than seven shapes make the spline less
  /// smooth, because velocities are measured on them.
  GeodesicOptions geodesic;

  /// \throw InvalidOptions naming the field.
  void Validate() const;
};

/// Outcome of a spline.
struct SplineSummary {
  GeodesicSummary geodesic;  ///< of the chain of geodesics from which the spline is made
  SplineEnds ends = SplineEnds::kNatural;
  /// Whether the path is smooth. False if the call was stopped, or if there are only two poses: the
  /// path is then the chain.
  bool smooth = false;
  /// Greatest jump of velocity at a pose, as a share of the mean speed: of the chain, and of the
  /// spline; 0 if nothing moves. Measured on the shapes, so that it falls by 4 if their number
  /// doubles; a great one of the spline is warned of.
  double jump_before = kNotComputed, jump_after = kNotComputed;
  /// With GeodesicOptions::avoid_contact, as those of GeodesicSummary, of the path returned.
  int uncertified_segments = -1;
  double contact_distance = kNotComputed;
  double energy =
      kNotComputed;     ///< of the path returned, in the sense of `geodesic.energy`, the least
  PathQuality quality;  ///< of the path returned
  std::vector<std::string> warnings;
  double estimated_bytes = 0;  ///< of memory, before the solve
  double spline_seconds = 0, total_seconds = 0;

  bool Converged() const { return geodesic.termination == Termination::kConverged; }
  std::string BriefReport() const;  ///< one line
  std::string FullReport() const;   ///< a page
  std::string ToJson() const;
};

struct SplineResult {
  Path path;
  SplineSummary summary;
};

/// A smooth motion through poses. The geodesics between neighbouring poses (`Interpolate`), in
/// which the velocity jumps at every pose, are corrected: in each triangle, the rotation and the
/// logarithm of the stretch relative to the mean of the poses follow cubic splines through these,
/// and the shape is the one whose triangles are nearest to these (docs/mathematics.md, section 15).
/// The path meets the poses, and its velocity is continuous. No pose is distinguished: reversed
/// poses and times give the reversed motion, and a periodic one may begin at any of its poses. Two
/// poses give the geodesic. Vertices without triangles follow cubic splines in space. With
/// GeodesicOptions::avoid_contact, a motion between two poses that would pass through itself, or
/// the obstacle, is led round. If `progress` asks to stop after the first solve has begun, the
/// chain is returned, as far as it was found, and the summary says so.
/// \throw as Interpolate; InvalidOptions (times that do not ascend, are too near each other, or are
///        not one for each pose; kClamped without velocities; `by_length`, and two neighbouring
///        poses are the same), MeshError (kPeriodic if the last pose is the first).
SplineResult Spline(const std::shared_ptr<const Connectivity>& connectivity,
                    const std::vector<Shape>& poses, const SplineOptions& options = {},
                    Progress* progress = nullptr);
SplineResult Spline(const Poses& poses, const SplineOptions& options = {},
                    Progress* progress = nullptr);

}  // namespace shapespace

#endif  // SHAPESPACE_SPLINE_SPLINE_H_
