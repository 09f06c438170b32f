#ifndef SHAPESPACE_SPARSE_INTERNAL_GRADIENT_INTEGRATOR_H_
#define SHAPESPACE_SPARSE_INTERNAL_GRADIENT_INTEGRATOR_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/sparse/internal/cholesky.h>

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

  /// The stiffeners between components of the surface, which say where these are relative to each
  /// other, with a weight so small that they have no visible effect otherwise.
  static std::vector<Side> Ties(const Connectivity& connectivity);

  const std::vector<Side>& Sides() const { return sides_; }

  /// The vector that is wanted for a tie: `vector`, mapped by the mean of the gradients of the
  /// triangles at both ends. `gradient(f)` is a 3 x 3 matrix.
  template <typename Gradient>
  static Eigen::Vector3d AlongTie(const Connectivity& connectivity, const Side& tie,
                                  const Eigen::Vector3d& vector, const Gradient& gradient) {
    Eigen::Vector3d result = Eigen::Vector3d::Zero();
    for (const int end : {tie.from, tie.to}) {
      const IndexLists::Row around = connectivity.TrianglesOfVertices()[end];
      for (const int f : around) result += gradient(f) * vector / (2 * around.size());
    }
    return result;
  }

  /// `wanted` has a column for each side, `places` one for each vertex.
  Shape Integrate(const Eigen::Matrix3Xd& wanted, const Shape& places) const;

 private:
  const std::vector<Side> sides_;
  const double place_;
  const Cholesky factor_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SPARSE_INTERNAL_GRADIENT_INTEGRATOR_H_
