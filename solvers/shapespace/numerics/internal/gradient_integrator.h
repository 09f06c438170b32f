#ifndef SHAPESPACE_NUMERICS_INTERNAL_GRADIENT_INTEGRATOR_H_
#define SHAPESPACE_NUMERICS_INTERNAL_GRADIENT_INTEGRATOR_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/numerics/internal/cholesky.h>

namespace shapespace::internal {

/// The shape whose sides are nearest to given vectors: the minimum of
///   sum_i w_i |p_b - p_a - side_i|^2 + e / n sum_v |p_v - q_v|^2
/// over all sides i from a to b and all n vertices, with an e (1e-4) so small that the wanted
/// positions q determine where components are, and have no visible effect otherwise. Its matrix is
/// the same for all vectors and is factored once.
class GradientIntegrator {
 public:
  struct Side {
    int from, to;
    double weight;
  };

  GradientIntegrator(int num_vertices, std::vector<Side> sides);

  /// The edges with an end in no triangle, with weight 1.
  static std::vector<Side> SidesWithoutTriangles(const Connectivity& connectivity);

  const std::vector<Side>& Sides() const { return sides_; }

  /// `wanted` has a column for each side, `places` one for each vertex.
  Shape Integrate(const Eigen::Matrix3Xd& wanted, const Shape& places) const;

 private:
  const std::vector<Side> sides_;
  const double place_;
  const Cholesky factor_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_NUMERICS_INTERNAL_GRADIENT_INTEGRATOR_H_
