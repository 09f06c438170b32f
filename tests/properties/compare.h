#ifndef SHAPESPACE_TESTS_PROPERTIES_COMPARE_H_
#define SHAPESPACE_TESTS_PROPERTIES_COMPARE_H_

#include <vector>

#include <gtest/gtest.h>

#include <shapespace/mesh/shape.h>

namespace shapespace::testing {

/// Whether shapes are the expected ones: no vertex is off by more than `tolerance` times the
/// diameter of its shape.
::testing::AssertionResult AreNear(const std::vector<Shape>& shapes,
                                   const std::vector<Shape>& expected, double tolerance);

/// The same, each shape after the rigid motion that brings it nearest to the expected one.
::testing::AssertionResult AreCongruent(const std::vector<Shape>& shapes,
                                        const std::vector<Shape>& expected, double tolerance);

/// The shapes in the opposite order.
std::vector<Shape> Reversed(std::vector<Shape> shapes);

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_PROPERTIES_COMPARE_H_
