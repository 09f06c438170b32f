#ifndef SHAPESPACE_PATH_PATH_H_
#define SHAPESPACE_PATH_PATH_H_

#include <memory>
#include <string>
#include <vector>

#include <shapespace/mesh/appearance.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/rigid_motion.h>

namespace shapespace {

/// A polyline in shape space: what a solver returns and every output is made from.
struct Path {
  std::shared_ptr<const Metric> metric;  ///< the one that made the path; has the connectivity

  /// The shapes, aligned rigidly, centred, in the metric's unit: on these the geodesic equation
  /// holds. Use `Placed` for shapes where, and as large as, the user's are.
  std::vector<Shape> shapes;

  /// t of every shape, rising from 0. The poses of an interpolation end at 1: what was extrapolated
  /// from the last goes on beyond.
  std::vector<double> parameters;
  std::vector<RigidMotion> motions;  ///< of every shape, to its place, in the user's unit
  std::vector<int> poses;            ///< indices of the shapes that were given, rising
  int extrapolated = 0;              ///< how many of the last shapes were extrapolated
  bool converged = true;             ///< false if a solve ended before it was done
  std::string provenance;            ///< who made the path, from what
  Appearance appearance;             ///< of the connectivity's polygons: for outputs

  int NumShapes() const { return static_cast<int>(shapes.size()); }

  /// \throw MeshError if numbers of shapes, of vertices or of anything else do not fit together,
  /// the
  ///        appearance is not valid, or a number is not finite.
  void Validate() const;

  /// Shape i in the user's frame and unit.
  Shape Placed(int i) const { return motions[i](metric->unit * shapes[i]); }
  std::vector<Shape> Placed() const;
};

/// A path through `placed`, shapes in the user's frame and unit, at rising `parameters`; empty:
/// evenly from 0 to 1. Its poses are the first and the last shape; set `poses` if others were
/// given. \throw MeshError if there is no shape, or as `Path::Validate`.
Path MakePath(const std::shared_ptr<const Metric>& metric, const std::vector<Shape>& placed,
              std::vector<double> parameters = {});

/// `shapes`, which lie at rising `parameters`, at rising `times` between the first and the last of
/// these, by cubic interpolation in time through the four nearest shapes; a time that is a shape's
/// own gives that shape.
/// \throw InvalidOptions if there is no shape, or not as many parameters as shapes, or if
///        parameters or times do not rise, are not finite or leave the path.
std::vector<Shape> Resample(const std::vector<Shape>& shapes, const std::vector<double>& parameters,
                            const std::vector<double>& times);

/// The path seen at other times, rising between its first and its last: shapes as above, but never
/// across a pose, where a path may have a corner. `poses` are those that a time hits exactly,
/// `extrapolated` counts the times after the last shape that was not.
/// \throw InvalidOptions if there is no time, or times do not rise, are not finite or leave the
/// path.
Path Resample(const Path& path, const std::vector<double>& times);

/// The first `count` shapes of a path, to go on from: the same metric and times, and the poses that
/// are among them. \throw InvalidOptions if `count` is not in 1 .. `path.NumShapes()`.
Path FirstShapes(const Path& path, int count);

}  // namespace shapespace

#endif  // SHAPESPACE_PATH_PATH_H_
