#include "properties/compare.h"

#include <algorithm>

#include <Eigen/Core>

#include <shapespace/mesh/rigid_motion.h>

#include "support/motions.h"

namespace shapespace::testing {

::testing::AssertionResult AreNear(const std::vector<Shape>& shapes,
                                   const std::vector<Shape>& expected, double tolerance) {
  if (shapes.empty() || shapes.size() != expected.size()) {
    return ::testing::AssertionFailure() << shapes.size() << " shapes, not " << expected.size();
  }
  double largest = 0;
  size_t at = 0;
  for (size_t i = 0; i < shapes.size(); ++i) {
    if (!shapes[i].allFinite()) return ::testing::AssertionFailure() << "not finite: shape " << i;
    const double off = Distance(shapes[i], expected[i]) / Diameter(expected[i]);
    if (off > largest) at = i, largest = off;
  }
  if (largest <= tolerance) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << "shape " << at << " is off by " << largest;
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
