#ifndef SHAPESPACE_TESTS_SUPPORT_CRUMPLED_H_
#define SHAPESPACE_TESTS_SUPPORT_CRUMPLED_H_

#include <random>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::testing {

/// The shape with each coordinate moved at random by up to this share of the mean edge length, so
/// that the surface has folds as in a poor scan. The same everywhere for the same seed.
inline Shape Crumpled(const Connectivity& connectivity, const Shape& shape, double share,
                      unsigned seed) {
  double length = 0;
  for (const auto& edge : connectivity.Edges().colwise()) {
    length += (shape.col(edge(0)) - shape.col(edge(1))).norm() / connectivity.NumEdges();
  }
  std::mt19937_64 random(seed);
  const double reach = share * length;
  Shape crumpled = shape;
  for (double& x : crumpled.reshaped()) {
    x += reach * (2 * (static_cast<double>(random() >> 11) * 0x1p-53) - 1);
  }
  return crumpled;
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_CRUMPLED_H_
