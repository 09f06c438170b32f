#ifndef SHAPESPACE_CONTACT_DETAIL_PAIR_POTENTIAL_H_
#define SHAPESPACE_CONTACT_DETAIL_PAIR_POTENTIAL_H_

#include <cmath>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <shapespace/analysis/distance.h>

namespace shapespace::internal {

/// The potential of a pair of elements that are near to each other: w b(d / reach) with the barrier
/// b(u) = (1 - u)^3 / (3 u^2), which is 0 from u = 1 on, twice continuously differentiable there,
/// and infinite at 0. For two edges it is multiplied by a factor that vanishes where they are
/// parallel, because there the derivative of their distance is not continuous (Li et al.,
/// Incremental Potential Contact, 2020, sections 4.2 and 5.2, with another barrier: that one is of
/// a logarithm, and so weak that parts come within hundredths of the reach).
struct PairPotential {
  PairKind kind;
  double weight;    ///< w
  double reach;     ///< the distance from which on there is no potential, above 0
  double parallel;  ///< squared areas spanned by two edges below this count as nearly parallel

  /// `x` has the coordinates of the four points, one after the other. The nearest points are those
  /// of the numbers' values, whose motion on the elements does not change the distance to first
  /// order: first derivatives are exact.
  template <typename T>
  T operator()(const T* x, const Separation& separation) const {
    using std::sqrt;
    const Eigen::Map<const Eigen::Matrix<T, 3, 4>> points(x);
    const Eigen::Matrix<T, 3, 1> difference = points * separation.coefficients.template cast<T>();
    const T u = sqrt(difference.squaredNorm()) / reach;
    if (!(u < 1.0)) return T(0);
    return weight / 3 * Parallelism(points) * (1.0 - u) * (1.0 - u) * (1.0 - u) / (u * u);
  }

  /// The value at points that are `separation` apart, and its derivatives, which are added to
  /// `gradient` times `factor`; the same in closed form.
  double Add(const FourPoints& points, const Separation& separation, double factor,
             FourPoints* gradient) const {
    const double distance = separation.Distance(), u = distance / reach;
    if (!(u < 1)) return 0;
    double barrier = (1 - u) * (1 - u) * (1 - u) / (3 * u * u);
    double slope = -(1 - u) * (1 - u) * (2 + u) / (3 * u * u * u * reach);
    if (kind == PairKind::kEdgeEdge) {
      const Eigen::Vector3d a = points.col(1) - points.col(0), b = points.col(3) - points.col(2);
      const Eigen::Vector3d normal = a.cross(b);
      const double ratio = normal.squaredNorm() / parallel;
      if (ratio < 1) {
        const double change = factor * weight * barrier * 4 * (1 - ratio) / parallel;
        const Eigen::Vector3d by_a = change * b.cross(normal), by_b = change * normal.cross(a);
        gradient->col(0) -= by_a;
        gradient->col(1) += by_a;
        gradient->col(2) -= by_b;
        gradient->col(3) += by_b;
        barrier *= (2 - ratio) * ratio;
        slope *= (2 - ratio) * ratio;
      }
    }
    *gradient += (factor * weight * slope / distance) * separation.difference *
                 separation.coefficients.transpose();
    return factor * weight * barrier;
  }

 private:
  template <typename T>
  T Parallelism(const Eigen::Map<const Eigen::Matrix<T, 3, 4>>& points) const {
    if (kind != PairKind::kEdgeEdge) return T(1);
    const Eigen::Matrix<T, 3, 1> a = points.col(1) - points.col(0),
                                 b = points.col(3) - points.col(2);
    const T ratio = a.cross(b).squaredNorm() / parallel;
    return ratio < 1.0 ? T((2.0 - ratio) * ratio) : T(1);
  }
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_CONTACT_DETAIL_PAIR_POTENTIAL_H_
