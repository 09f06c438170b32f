#ifndef SHAPESPACE_PATH_PATH_H_
#define SHAPESPACE_PATH_PATH_H_

#include <memory>
#include <string>
#include <vector>

#include <shapespace/mesh/appearance.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>

namespace shapespace {

/// A polyline in shape space: the result of solvers and the input of all outputs.
struct Path {
  std::shared_ptr<const Metric> metric;  ///< of the solve; with the connectivity

  /// The shapes, rigidly aligned, centred, in the metric's unit; they satisfy the geodesic
  /// equation. Use `Placed` for shapes in the user's frame and unit.
  std::vector<Shape> shapes;

  /// t of every shape, ascending from 0. The last pose of an interpolation is at 1; extrapolated
  /// shapes follow after it.
  std::vector<double> parameters;
  std::vector<RigidMotion> motions;  ///< of every shape, to the user's frame, in the user's unit
  std::vector<int> poses;            ///< indices of the given shapes, ascending

  /// A name for each of `poses`, such as that of its file without folder; or no name at all.
  std::vector<std::string> pose_names;
  int extrapolated = 0;    ///< number of shapes at the end that were extrapolated
  bool converged = true;   ///< false if a solve did not converge
  bool smooth = false;     ///< whether the velocity is continuous at inner poses (`Spline`)
  std::string provenance;  ///< the program and the inputs from which it was made
  Appearance appearance;   ///< of the connectivity's polygons: for outputs

  int NumShapes() const { return static_cast<int>(shapes.size()); }

  /// \throw MeshError if numbers of shapes, of vertices or of anything else do not fit together,
  ///        the appearance is not valid, or a number is not finite.
  void Validate() const;

  /// Shape i in the user's frame and unit.
  Shape Placed(int i) const;
  std::vector<Shape> Placed() const;
};

/// A path through `placed`, shapes in the user's frame and unit, at ascending `parameters`; if
/// empty, evenly from 0 to 1. Its poses are the first and the last shape; set `poses` if others
/// were given. \throw MeshError if there is no shape, or as `Path::Validate`.
Path MakePath(const std::shared_ptr<const Metric>& metric, const std::vector<Shape>& placed,
              std::vector<double> parameters = {});

/// Interpolates `shapes`, which belong to ascending `parameters`, at ascending `times` between the
/// first and the last of these, cubically in time through the four nearest shapes; at a shape's own
/// parameter the result is that shape.
/// \throw InvalidOptions if there is no shape, or not as many parameters as shapes, or if
///        parameters or times do not ascend, are not finite or lie outside of the path.
std::vector<Shape> Resample(const std::vector<Shape>& shapes, const std::vector<double>& parameters,
                            const std::vector<double>& times);

/// The path at other times, ascending between its first and its last: interpolated as above, but
/// never across a pose, where a path may have a corner, unless it is smooth. `poses` are those at
/// whose parameter there is a time, `extrapolated` counts the times after the last shape that was
/// not extrapolated.
/// \throw InvalidOptions if there is no time, or times do not ascend, are not finite or lie outside
///        of the path.
Path Resample(const Path& path, const std::vector<double>& times);

/// Some shapes of a path, by their indices, which ascend or descend: the same metric, the poses
/// among them, and times that begin at 0. Descending indices reverse the motion; none of its shapes
/// then counts as extrapolated.
/// \throw InvalidOptions if there is no index, one is not of the path, or they do not ascend or
///        descend.
Path SelectShapes(const Path& path, const std::vector<int>& indices);

/// The first `count` shapes of a path, for a continuation.
/// \throw InvalidOptions if `count` is not in 1 .. `path.NumShapes()`.
Path FirstShapes(const Path& path, int count);

}  // namespace shapespace

#endif  // SHAPESPACE_PATH_PATH_H_
