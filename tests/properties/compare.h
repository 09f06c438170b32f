#ifndef SHAPESPACE_TESTS_PROPERTIES_COMPARE_H_
#define SHAPESPACE_TESTS_PROPERTIES_COMPARE_H_

#include <vector>

#include <gtest/gtest.h>

#include <shapespace/mesh/shape.h>

#include "properties/random_body.h"

namespace shapespace::testing {

/// How far shapes are from the expected ones at most: the length in the metric of the straight way
/// between them, as a share of that between the first two poses of the body, turned onto each
/// other. Solvers lower the energy, so that this is what they determine; motions that cost next to
/// nothing hardly count. Infinite if the numbers of shapes differ or a coordinate is not finite.
double Off(const RandomBody& body, const std::vector<Shape>& shapes,
           const std::vector<Shape>& expected);

/// Whether this is no more than `tolerance`.
::testing::AssertionResult AreNear(const RandomBody& body, const std::vector<Shape>& shapes,
                                   const std::vector<Shape>& expected, double tolerance);

/// The same, each shape after the rigid motion that brings it nearest to the expected one.
::testing::AssertionResult AreCongruent(const RandomBody& body, const std::vector<Shape>& shapes,
                                        const std::vector<Shape>& expected, double tolerance);

/// Calls `test` with a random body of each kind for each of the seeds, in so many poses.
template <class Test>
void ForAllKinds(const std::vector<int>& seeds, int poses, const Test& test) {
  for (int kind = 0; kind < kNumBodyKinds; ++kind) {
    for (const int seed : seeds) {
      const RandomBody body = MakeRandomBody(static_cast<BodyKind>(kind), seed, poses);
      SCOPED_TRACE(body.name);
      test(body);
    }
  }
}

/// The shapes in the opposite order.
std::vector<Shape> Reversed(std::vector<Shape> shapes);

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_PROPERTIES_COMPARE_H_
