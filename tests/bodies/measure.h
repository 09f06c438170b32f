#ifndef SHAPESPACE_TESTS_BODIES_MEASURE_H_
#define SHAPESPACE_TESTS_BODIES_MEASURE_H_

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <string>
#include <utility>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace {

constexpr double kDegrees = 180 / 3.14159265358979323846;  ///< degrees in a radian

/// Signed volume; positive where closed meshes are wound outwards.
inline double VolumeOf(const Connectivity& connectivity, const Shape& shape) {
  double sum = 0;
  for (const auto& t : connectivity.Triangles().colwise()) {
    sum += shape.col(t(0)).dot(shape.col(t(1)).cross(shape.col(t(2)))) / 6;
  }
  return sum;
}

inline double Area(const Connectivity& connectivity, const Shape& shape) {
  double sum = 0;
  for (const auto& t : connectivity.Triangles().colwise()) {
    const Eigen::Vector3d u = shape.col(t(1)) - shape.col(t(0));
    const Eigen::Vector3d v = shape.col(t(2)) - shape.col(t(0));
    sum += u.cross(v).norm() / 2;
  }
  return sum;
}

inline Eigen::VectorXd EdgeLengths(const Connectivity& connectivity, const Shape& shape) {
  Eigen::VectorXd lengths(connectivity.NumEdges());
  for (int e = 0; e < lengths.size(); ++e) {
    const auto edge = connectivity.Edges().col(e);
    lengths(e) = (shape.col(edge(1)) - shape.col(edge(0))).norm();
  }
  return lengths;
}

/// The largest relative change of an edge's length between two shapes.
inline double LargestStrain(const Connectivity& connectivity, const Shape& rest,
                            const Shape& other) {
  const Eigen::ArrayXd before = EdgeLengths(connectivity, rest);
  const Eigen::ArrayXd after = EdgeLengths(connectivity, other);
  return (after / before - 1).abs().maxCoeff();
}

/// Signed angles, in degrees, between the normals of the triangles at every hinge: 0 if flat,
/// positive if folded towards the normals.
inline Eigen::VectorXd HingeAngles(const Connectivity& connectivity, const Shape& shape) {
  Eigen::VectorXd angles(connectivity.NumHinges());
  for (int h = 0; h < angles.size(); ++h) {
    const auto hinge = connectivity.Hinges().col(h);
    const Eigen::Vector3d origin = shape.col(hinge(0));
    const Eigen::Vector3d axis = shape.col(hinge(1)) - origin;
    const Eigen::Vector3d n = axis.cross(Eigen::Vector3d(shape.col(hinge(2)) - origin));
    const Eigen::Vector3d m = Eigen::Vector3d(shape.col(hinge(3)) - origin).cross(axis);
    angles(h) = -std::atan2(n.cross(m).dot(axis.normalized()), n.dot(m)) * kDegrees;
  }
  return angles;
}

/// The smallest angle of a triangle, in degrees.
inline double SmallestAngle(const Connectivity& connectivity, const Shape& shape) {
  double smallest = 180;
  for (const auto& t : connectivity.Triangles().colwise()) {
    for (int k = 0; k < 3; ++k) {
      const Eigen::Vector3d u = shape.col(t((k + 1) % 3)) - shape.col(t(k));
      const Eigen::Vector3d v = shape.col(t((k + 2) % 3)) - shape.col(t(k));
      smallest = std::min(smallest, std::atan2(u.cross(v).norm(), u.dot(v)) * kDegrees);
    }
  }
  return smallest;
}

/// Number of sides of triangles without a side in the opposite direction, plus sides that occur
/// twice in one direction: 0 for a closed, consistently oriented surface.
inline int UnmatchedSides(const Connectivity& connectivity) {
  std::map<std::pair<int, int>, int> count;
  for (const auto& t : connectivity.Triangles().colwise()) {
    for (int k = 0; k < 3; ++k) ++count[{t(k), t((k + 1) % 3)}];
  }
  int unmatched = 0;
  for (const auto& [side, times] : count) {
    if (times != 1 || count.count({side.second, side.first}) == 0) ++unmatched;
  }
  return unmatched;
}

inline int EulerCharacteristic(const Connectivity& connectivity) {
  return connectivity.NumVertices() - connectivity.NumEdges() + connectivity.NumTriangles();
}

/// The smallest distance between two vertices; slow, for small meshes.
inline double SmallestDistance(const Shape& shape) {
  double smallest = std::numeric_limits<double>::infinity();
  for (int v = 0; v < shape.cols(); ++v) {
    for (int w = 0; w < v; ++w) {
      smallest = std::min(smallest, (shape.col(v) - shape.col(w)).norm());
    }
  }
  return smallest;
}

/// The message of the `InvalidOptions` that `call` throws; if there is none, a text that no test
/// expects.
inline std::string Refusal(const std::function<void()>& call) {
  try {
    call();
  } catch (const InvalidOptions& error) {
    return error.what();
  }
  return "(not refused)";
}

}  // namespace shapespace

#endif  // SHAPESPACE_TESTS_BODIES_MEASURE_H_
