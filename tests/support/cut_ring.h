#ifndef SHAPESPACE_TESTS_SUPPORT_CUT_RING_H_
#define SHAPESPACE_TESTS_SUPPORT_CUT_RING_H_

#include <algorithm>
#include <cmath>
#include <memory>
#include <vector>

#include <shapespace/analysis/intersections.h>
#include <shapespace/bodies/tube.h>
#include <shapespace/contact/obstacle.h>
#include <shapespace/geodesic/geodesic.h>
#include <shapespace/path/path.h>

namespace shapespace::testing {

/// The most pairs of intersecting triangles at 40 times between each two shapes.
inline std::int64_t MostIntersections(const Path& path) {
  std::vector<Shape> shapes;
  for (int i = 0; i + 1 < path.NumShapes(); ++i) {
    for (int k = 0; k <= 40; ++k) {
      shapes.push_back((1 - k / 40.) * path.shapes[i] + k / 40. * path.shapes[i + 1]);
    }
  }
  const auto counts = CountIntersections(*path.metric->connectivity, shapes);
  return *std::max_element(counts.begin(), counts.end());
}

/// The same with an obstacle, where the path is placed.
inline std::int64_t MostIntersections(const Path& path, const Obstacle& obstacle) {
  const std::vector<Shape> placed = path.Placed();
  std::vector<Shape> shapes;
  for (int i = 0; i + 1 < path.NumShapes(); ++i) {
    for (int k = 0; k <= 40; ++k) {
      shapes.push_back(obstacle.Joined(Shape((1 - k / 40.) * placed[i] + k / 40. * placed[i + 1])));
    }
  }
  const auto counts = CountIntersections(*obstacle.Joined(path.metric->connectivity), shapes);
  return *std::max_element(counts.begin(), counts.end());
}

/// A horizontal rectangle, of two triangles.
inline Obstacle Rectangle(const Eigen::Vector2d& low, const Eigen::Vector2d& high, double z) {
  Eigen::Matrix3Xi triangles(3, 2);
  triangles << 0, 0, 1, 2, 2, 3;
  Shape shape(3, 4);
  shape << low.x(), high.x(), high.x(), low.x(), low.y(), low.y(), high.y(), high.y(), z, z, z, z;
  return {Connectivity::FromTriangles(4, triangles), shape};
}

/// A ring that is cut open, whose round ends overlap by a tenth of a turn: the one in front of the
/// other, or behind it. The first is also a little farther outside, so that they slide over each
/// other.
struct CutRing {
  explicit CutRing(double of_unit = 1, double of_stoutness = 1)
      : unit(of_unit), stoutness(of_stoutness) {
    TubeForm form;
    form.length = 6.9 * unit;
    form.base_radius = form.tip_radius = 0.15 * unit;
    form.knuckle = 0;
    tube = MakeTube(1000, form);
    connectivity = tube.connectivity;
    poses = {Wound(0.6, 0.15), Wound(-0.6, 0.15)};
  }
  /// Straight along x, so many times as stout.
  Shape Rod() const {
    Shape shape = tube.pose(0);
    shape.bottomRows<2>() *= stoutness;
    return shape;
  }
  /// With a shift in front and outwards, per turn.
  Shape Wound(double front, double outwards) const {
    Shape shape = Rod();
    for (int v = 0; v < shape.cols(); ++v) {
      const double angle = (shape(0, v) / unit - 3.45), turns = angle / (2 * M_PI);
      const double radius = 1 + outwards * turns - shape(2, v) / unit;
      shape.col(v) << radius * std::sin(angle), shape(1, v) / unit + front * turns,
          -radius * std::cos(angle);
    }
    return unit * shape;
  }
  /// Half a turn only.
  Shape Open() const {
    const Shape rod = Rod();
    Shape shape = rod;
    for (int v = 0; v < shape.cols(); ++v) {
      const double angle = (rod(0, v) / unit - 3.45) / 2;
      const double radius = 2 - rod(2, v) / unit;
      shape.col(v) << radius * std::sin(angle), rod(1, v) / unit, -radius * std::cos(angle);
    }
    return unit * shape;
  }
  /// So many turns of a flat ring.
  Shape Bent(double turns) const {
    Shape shape = Rod();
    const double curvature = turns * 2 * M_PI / 6.9;
    for (int v = 0; v < shape.cols(); ++v) {
      const double angle = curvature * (shape(0, v) / unit - 3.45);
      const double radius = 1 / curvature - shape(2, v) / unit;
      shape.col(v) << radius * std::sin(angle), shape(1, v) / unit, -radius * std::cos(angle);
    }
    return unit * shape;
  }
  double unit, stoutness;
  ShapeFamily tube;
  std::shared_ptr<const Connectivity> connectivity;
  std::vector<Shape> poses;
};

/// Closes a ring from six to seven tenths of a turn, in two segments: gone on with, its ends meet.
inline Path ClosingPath(const CutRing& ring) {
  GeodesicOptions options;
  options.shapes = 1;
  options.tolerance = 1e-8;
  return Interpolate(ring.connectivity, {ring.Bent(0.6), ring.Bent(0.7)}, options).path;
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_CUT_RING_H_
