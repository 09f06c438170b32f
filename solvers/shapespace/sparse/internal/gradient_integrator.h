#ifndef SHAPESPACE_SPARSE_INTERNAL_GRADIENT_INTEGRATOR_H_
#define SHAPESPACE_SPARSE_INTERNAL_GRADIENT_INTEGRATOR_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/base/internal/ranges.h>
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

  const std::vector<Side>& Sides() const { return sides_; }

  /// `wanted` has a column for each side, `positions` one for each vertex.
  Shape Integrate(const Eigen::Matrix3Xd& wanted, const Shape& positions) const;

 private:
  const std::vector<Side> sides_;
  const double position_weight_;
  const Cholesky factor_;
};

/// The sides of a triangle, from each corner to the next.
inline Eigen::Matrix3d TriangleSides(const Shape& shape, const Eigen::Vector3i& corners) {
  Eigen::Matrix3d sides;
  for (int k = 0; k < 3; ++k) {
    sides.col(k) = shape.col(corners((k + 1) % 3)) - shape.col(corners(k));
  }
  return sides;
}

/// The shape whose triangles have sides nearest to given ones. An edge with an end in no triangle
/// is what it is between the wanted positions. A stiffener between components of the surface, which
/// says where these are relative to each other, is what the mean gradient of the triangles at its
/// ends makes of it, with a weight so small that it has no visible effect otherwise.
class SurfaceIntegrator {
 public:
  /// `weights`, 3 x triangles, are those of the sides. `connectivity` must outlive the object.
  SurfaceIntegrator(const Connectivity& connectivity, const Eigen::Matrix3Xd& weights);

  /// `sides(f)` are the wanted ones of triangle f, as `TriangleSides` has them, and `gradient(f)`
  /// is the 3 x 3 matrix that a stiffener of `base` is multiplied by; `positions` are the wanted
  /// positions.
  template <typename Sides, typename Gradient>
  Shape Integrate(const Shape& base, const Shape& positions, const Sides& sides,
                  const Gradient& gradient) const {
    Eigen::Matrix3Xd wanted(3, integrator_.Sides().size());
    ForIndices(connectivity_.NumTriangles(),
               [&](int f) { wanted.middleCols<3>(3 * f) = sides(f); });
    for (Eigen::Index i = 3 * connectivity_.NumTriangles(); i < wanted.cols(); ++i) {
      const GradientIntegrator::Side& side = integrator_.Sides()[i];
      if (i < first_tie_) {
        wanted.col(i) = positions.col(side.to) - positions.col(side.from);
        continue;
      }
      wanted.col(i).setZero();
      for (const int end : {side.from, side.to}) {
        const IndexLists::Row around = connectivity_.TrianglesOfVertices()[end];
        for (const int f : around) {
          wanted.col(i) +=
              gradient(f) * (base.col(side.to) - base.col(side.from)) / (2. * around.size());
        }
      }
    }
    Shape shape = integrator_.Integrate(wanted, positions);
    connectivity_.CopyToTwins(&shape);
    return shape;
  }

 private:
  const Connectivity& connectivity_;
  Eigen::Index first_tie_ = 0;  // among the sides
  const GradientIntegrator integrator_;
};

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SPARSE_INTERNAL_GRADIENT_INTEGRATOR_H_
