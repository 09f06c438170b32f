#ifndef SHAPESPACE_TESTS_PROPERTIES_COMPARE_H_
#define SHAPESPACE_TESTS_PROPERTIES_COMPARE_H_

#include <vector>

#include <gtest/gtest.h>

#include <shapespace/mesh/shape.h>

namespace shapespace::testing {

/// How far vertices are from the expected ones at most, as a share of the diameter of their shape;
/// infinite if the numbers of shapes differ or a coordinate is not finite.
double Off(const std::vector<Shape>& shapes, const std::vector<Shape>& expected);

/// Whether this is no more than `tolerance`.
::testing::AssertionResult AreNear(const std::vector<Shape>& shapes,
                                   const std::vector<Shape>& expected, double tolerance);

/// The same, each shape after the rigid motion that brings it nearest to the expected one.
::testing::AssertionResult AreCongruent(const std::vector<Shape>& shapes,
                                        const std::vector<Shape>& expected, double tolerance);

/// The shapes in the opposite order.
std::vector<Shape> Reversed(std::vector<Shape> shapes);

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_PROPERTIES_COMPARE_H_
