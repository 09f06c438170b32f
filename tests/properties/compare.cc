#include "properties/compare.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include <Eigen/Core>

#include <shapespace/mesh/rigid_motion.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/energy.h>

namespace shapespace::testing {

double Off(const RandomBody& body, const std::vector<Shape>& shapes,
           const std::vector<Shape>& expected) {
  if (shapes.empty() || shapes.size() != expected.size()) {
    return std::numeric_limits<double>::infinity();
  }
  const auto metric = FreezeMetric(body.metric, body.connectivity, body.poses);
  const auto length = [&](const Shape& from, const Shape& to) {
    return std::sqrt(SquaredLengths(metric, {from / metric->unit, to / metric->unit})[0]);
  };
  const Shape& first = body.poses[0];
  const Shape second = FitRigidMotion(body.poses[1], first, metric->vertex_area)(body.poses[1]);
  double largest = 0;
  for (size_t i = 0; i < shapes.size(); ++i) {
    if (!shapes[i].allFinite()) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, length(shapes[i], expected[i]));
  }
  return largest / length(first, second);
}

::testing::AssertionResult AreNear(const RandomBody& body, const std::vector<Shape>& shapes,
                                   const std::vector<Shape>& expected, double tolerance) {
  const double off = Off(body, shapes, expected);
  if (off <= tolerance) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "off by " << off;
}

::testing::AssertionResult AreCongruent(const RandomBody& body, const std::vector<Shape>& shapes,
                                        const std::vector<Shape>& expected, double tolerance) {
  std::vector<Shape> fitted = shapes;
  for (size_t i = 0; i < std::min(shapes.size(), expected.size()); ++i) {
    const Eigen::VectorXd weights = Eigen::VectorXd::Ones(shapes[i].cols());
    fitted[i] = FitRigidMotion(shapes[i], expected[i], weights)(shapes[i]);
  }
  return AreNear(body, fitted, expected, tolerance);
}

std::vector<Shape> Reversed(std::vector<Shape> shapes) {
  std::reverse(shapes.begin(), shapes.end());
  return shapes;
}

}  // namespace shapespace::testing
