#ifndef SHAPESPACE_CONTACT_DETAIL_SEPARATION_POTENTIAL_H_
#define SHAPESPACE_CONTACT_DETAIL_SEPARATION_POTENTIAL_H_

#include <memory>
#include <vector>

#include <shapespace/metric/metric.h>
#include <shapespace/path/energy.h>

namespace shapespace::internal {

/// The potential w (1 - d^2 / r^2)^2 of two points at a distance d below r.
struct SeparationPair {
  int first, second;  ///< vertices
  double weight;      ///< w
  double reach2;      ///< r^2, above 0

  template <typename T>
  T operator()(const T* first_point, const T* second_point) const {
    T rest(1);
    for (int k = 0; k < 3; ++k) {
      const T apart = first_point[k] - second_point[k];
      rest -= apart * apart / reach2;
    }
    return rest > 0.0 ? T(weight * rest * rest) : T(0);
  }

  /// The same, and its derivatives, which are added to `gradient`.
  double Add(const Shape& shape, Tangent* gradient) const {
    const Eigen::Vector3d apart = shape.col(first) - shape.col(second);
    const double rest = 1 - apart.squaredNorm() / reach2;
    if (rest <= 0) return 0;
    const Eigen::Vector3d by_first = -4 * weight * rest / reach2 * apart;
    gradient->col(first) += by_first;
    gradient->col(second) -= by_first;
    return weight * rest * rest;
  }
};

/// What pushes parts of a body that pass through each other out again: unlike the potential of
/// contact it is finite there, and reaches about as far as parts are thick. It is the sum of
/// a_i a_j / A^2 (1 - d^2 / r^2)^2 over pairs of some hundreds of vertices, with their areas a, the
/// sum of these A, and the reach r, or nine tenths of their distance in a pose if that is less.
class SeparationPotential {
 public:
  /// For paths between these poses, to which `reach` is in proportion.
  SeparationPotential(const Metric& metric, const std::vector<Shape>& poses, double reach);

  /// `factor` times the mean over equidistant times of a path, straight between its shapes; the
  /// derivatives are added to `gradient`. Arrays as those of `energy`, to which `path` belongs; its
  /// inner shapes are overwritten.
  double Evaluate(const PathEnergy& energy, const double* unknowns, double factor,
                  std::vector<Shape>* path, double* gradient);

  /// Without those that are too near in a pose to count.
  const std::vector<SeparationPair>& Pairs() const { return pairs_; }

 private:
  std::vector<SeparationPair> pairs_;
  std::vector<Tangent> forces_;  // scratch, for each time
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CONTACT_DETAIL_SEPARATION_POTENTIAL_H_
