#include "properties/compare.h"

#include <algorithm>
#include <limits>

#include <Eigen/Core>

#include <shapespace/mesh/rigid_motion.h>

#include "support/motions.h"

namespace shapespace::testing {

double Off(const std::vector<Shape>& shapes, const std::vector<Shape>& expected) {
  if (shapes.empty() || shapes.size() != expected.size()) {
    return std::numeric_limits<double>::infinity();
  }
  double largest = 0;
  for (size_t i = 0; i < shapes.size(); ++i) {
    if (!shapes[i].allFinite()) return std::numeric_limits<double>::infinity();
    largest = std::max(largest, Distance(shapes[i], expected[i]) / Diameter(expected[i]));
  }
  return largest;
}

::testing::AssertionResult AreNear(const std::vector<Shape>& shapes,
                                   const std::vector<Shape>& expected, double tolerance) {
  const double off = Off(shapes, expected);
  if (off <= tolerance) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "off by " << off;
}

::testing::AssertionResult AreCongruent(const std::vector<Shape>& shapes,
                                        const std::vector<Shape>& expected, double tolerance) {
  std::vector<Shape> fitted = shapes;
  for (size_t i = 0; i < std::min(shapes.size(), expected.size()); ++i) {
    const Eigen::VectorXd weights = Eigen::VectorXd::Ones(shapes[i].cols());
    fitted[i] = FitRigidMotion(shapes[i], expected[i], weights)(shapes[i]);
  }
  return AreNear(fitted, expected, tolerance);
}

std::vector<Shape> Reversed(std::vector<Shape> shapes) {
  std::reverse(shapes.begin(), shapes.end());
  return shapes;
}

}  // namespace shapespace::testing
