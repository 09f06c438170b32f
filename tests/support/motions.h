#ifndef SHAPESPACE_TESTS_SUPPORT_MOTIONS_H_
#define SHAPESPACE_TESTS_SUPPORT_MOTIONS_H_

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <shapespace/bodies/body.h>
#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/path.h>

namespace shapespace::testing {

inline Eigen::Matrix3d Rotation(double degrees, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(degrees * M_PI / 180, axis.normalized()).toRotationMatrix();
}

inline double Diameter(const Shape& shape) {
  return (shape.rowwise().maxCoeff() - shape.rowwise().minCoeff()).norm();
}

/// Largest distance between corresponding vertices.
inline double Distance(const Shape& a, const Shape& b) {
  return (a - b).colwise().norm().maxCoeff();
}

/// The same of two paths with equally many shapes, as placed.
inline double Distance(const Path& a, const Path& b) {
  double largest = 0;
  for (int i = 0; i < a.NumShapes(); ++i) {
    largest = std::max(largest, Distance(a.Placed(i), b.Placed(i)));
  }
  return largest;
}

/// For shooting that nothing cancels.
inline const std::function<void()> kNeverCancelled = [] {};

/// The vertices at which a condition on their position holds.
inline std::vector<int> Where(const Shape& shape,
                              const std::function<bool(const Eigen::Vector3d&)>& holds) {
  std::vector<int> vertices;
  for (int v = 0; v < shape.cols(); ++v) {
    if (holds(shape.col(v))) vertices.push_back(v);
  }
  return vertices;
}

/// A shape with an initial velocity for shooting, in the user's unit per unit of time.
struct Motion {
  std::string name;
  std::shared_ptr<const Metric> metric;  ///< frozen on the shape
  Shape shape;
  Tangent velocity;

  /// The same motion at another speed.
  Motion Times(double factor) const { return {name, metric, shape, factor * velocity}; }
};

/// The velocity of a rotation about the centroid, in degrees per unit of time.
inline Tangent Spin(const Metric& metric, const Shape& shape, double degrees,
                    const Eigen::Vector3d& axis) {
  const Eigen::Vector3d omega = degrees * M_PI / 180 * axis.normalized();
  const Shape arm = shape.colwise() - Centroid(shape, metric.vertex_area);
  Tangent velocity(3, shape.cols());
  for (int v = 0; v < shape.cols(); ++v) {
    const Eigen::Vector3d radius = arm.col(v);
    velocity.col(v) = omega.cross(radius);
  }
  return velocity;
}

/// A rotating body, in its shape at parameter `at`.
inline Motion Turning(const ShapeFamily& body, double at, double degrees,
                      const MetricOptions& options) {
  const Shape shape = body.pose(at);
  const auto metric = FreezeMetric(options, body.connectivity, {shape});
  return {body.name + ", turning", metric, shape, Spin(*metric, shape, degrees, {0.3, 1, 0.5})};
}

/// A body that deforms along its own family at parameter `at`, by `rate` parameter values per unit
/// of time.
inline Motion Deforming(const ShapeFamily& body, double at, double rate,
                        const MetricOptions& options) {
  // By central differences, for which edges of an isometric family grow by less than h^2.
  const double h = 1e-5 * (body.end - body.begin);
  const Shape shape = body.pose(at);
  const Tangent velocity = rate / (2 * h) * (body.pose(at + h) - body.pose(at - h));
  return {body.name + ", deforming", FreezeMetric(options, body.connectivity, {shape}), shape,
          velocity};
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_MOTIONS_H_
