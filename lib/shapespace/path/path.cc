#include <shapespace/path/path.h>

#include <algorithm>

#include <shapespace/base/parallel.h>

namespace shapespace {

std::vector<Shape> Path::Placed() const {
  std::vector<Shape> result(NumShapes());
  ParallelFor(NumShapes(), [&](int i) { result[i] = Placed(i); });
  return result;
}

std::vector<Shape> Resample(const std::vector<Shape>& shapes, const std::vector<double>& parameters,
                            const std::vector<double>& times) {
  const int count = static_cast<int>(shapes.size());
  const int window = std::min(4, count);
  std::vector<Shape> result(times.size());
  ParallelFor(static_cast<int>(times.size()), [&](int k) {
    const double t = times[k];
    const int after = static_cast<int>(std::lower_bound(parameters.begin(), parameters.end(), t) -
                                       parameters.begin());
    if (after < count && parameters[after] == t) {
      result[k] = shapes[after];
      return;
    }
    const int begin = std::clamp(after - window / 2, 0, count - window);
    result[k].setZero(3, shapes[0].cols());
    for (int i = begin; i < begin + window; ++i) {
      double weight = 1;  // Lagrange's polynomial of shape i
      for (int j = begin; j < begin + window; ++j) {
        if (j != i) weight *= (t - parameters[j]) / (parameters[i] - parameters[j]);
      }
      result[k] += weight * shapes[i];
    }
  });
  return result;
}

}  // namespace shapespace
