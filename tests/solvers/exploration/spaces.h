#ifndef SHAPESPACE_TESTS_SOLVERS_EXPLORATION_SPACES_H_
#define SHAPESPACE_TESTS_SOLVERS_EXPLORATION_SPACES_H_

#include <cmath>
#include <memory>
#include <vector>

#include <Eigen/Geometry>

#include <shapespace/bodies/tube.h>
#include <shapespace/exploration/space.h>

namespace shapespace::testing {

inline ShapeFamily SmallTube() { return MakeTube(300); }

/// A tube bent by an angle, then twisted along x by another, in degrees.
inline Shape BentAndTwisted(const ShapeFamily& tube, double bend, double twist) {
  Shape shape = tube.pose(bend);
  for (int v = 0; v < shape.cols(); ++v) {
    const double turn = twist * M_PI / 180 * shape(0, v) / 6;
    shape.col(v) = Eigen::AngleAxisd(turn, Eigen::Vector3d::UnitX()) * shape.col(v).eval();
  }
  return shape;
}

/// Four poses that vary in two parameters.
inline std::vector<Shape> TubePoses(const ShapeFamily& tube) {
  return {BentAndTwisted(tube, 0, 0), BentAndTwisted(tube, 70, 0), BentAndTwisted(tube, 0, 120),
          BentAndTwisted(tube, 50, 90)};
}

/// A space without solved geodesics: the unit square, cut in two, with the four poses at its
/// corners and the centre of its diagonal as a fifth node that belongs to no triangle.
inline PoseSpace MadeUpSpace(const ShapeFamily& tube,
                             const Eigen::Vector3d& translation = {1, 2, 3}) {
  PoseSpace space;
  const std::vector<Shape> poses = TubePoses(tube);
  auto metric = FreezeMetric({}, tube.connectivity, poses);
  space.metric = metric;
  for (const Shape& pose : poses) space.nodes.emplace_back(pose / metric->unit);
  space.nodes.emplace_back((space.nodes[0] + space.nodes[2]) / 2);
  space.names = {"a", "b", "c", "d"};
  space.translation = translation;
  space.points.resize(2, 5);
  space.points << 0, 1, 1, 0, .5, 0, 0, 1, 1, .5;
  space.triangles.resize(3, 2);
  space.triangles << 0, 0, 1, 2, 2, 3;
  space.parents = {{0, 2}};
  space.distances = Eigen::MatrixXd::Ones(4, 4) - Eigen::MatrixXd::Identity(4, 4).eval();
  space.stress = 0.25;
  space.provenance = "made up";
  return space;
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SOLVERS_EXPLORATION_SPACES_H_
