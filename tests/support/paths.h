#ifndef SHAPESPACE_TESTS_SUPPORT_PATHS_H_
#define SHAPESPACE_TESTS_SUPPORT_PATHS_H_

#include <random>
#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>

namespace shapespace::testing {

/// Normal noise of the given standard deviation, the same for the same seed.
inline Shape Noise(int vertices, double deviation, int seed) {
  std::mt19937 generator(seed);
  std::normal_distribution<double> normal;
  Shape noise(3, vertices);
  for (double& x : noise.reshaped()) x = deviation * normal(generator);
  return noise;
}

/// The linear blend from `first` to `last` in inner + 2 shapes, the inner ones with noise.
inline std::vector<Shape> NoisyBlend(const Shape& first, const Shape& last, int inner,
                                     double deviation) {
  std::vector<Shape> shapes;
  for (int i = 0; i < inner + 2; ++i) {
    const double t = static_cast<double>(i) / (inner + 1);
    shapes.push_back((1 - t) * first + t * last);
    if (i > 0 && i <= inner) {
      shapes.back() += Noise(static_cast<int>(first.cols()), deviation, i);
    }
  }
  return shapes;
}

/// Two vertices and the edge between them.
inline std::shared_ptr<const Connectivity> SingleEdge() {
  return Connectivity::Make(2, {0}, {}, {{0, 1}});
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_PATHS_H_
