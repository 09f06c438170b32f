#ifndef SHAPESPACE_COST_SHOOTING_COST_H_
#define SHAPESPACE_COST_SHOOTING_COST_H_

#include <memory>
#include <vector>

#include <ceres/cost_function.h>
#include <Eigen/Core>

#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>

namespace shapespace::cost {

// Ceres cost functions of shooting and of the paper's transport, automatically differentiated as
// those of segment_cost.h. Their parameter blocks are vertices (3 numbers).

/// The terms of one feature in the rows of vertex v of J(at)^T [Phi(P) - target] = 0.
struct VertexElements {
  std::shared_ptr<const Feature> feature;
  std::vector<int> elements;     ///< elements at v
  std::vector<int> blocks;       ///< per element, the parameter blocks of its vertices
  std::vector<double> targets;   ///< per element, its values
  std::vector<double> gradient;  ///< per value, its gradient with respect to v, at the shape `at`
};

/// The three rows of vertex v in J(at)^T [Phi(P) - target] = 0. Parameter blocks: the value of each
/// sum feature (1 number), which all rows share, then the vertices that share an element with v.
/// Each element is differentiated automatically with Jets of its own size; a row with bending has
/// about sixty unknowns, of which an element has twelve.
class EulerLagrangeRows final : public ceres::CostFunction {
 public:
  /// The first `num_sums` blocks are those of sums, `num_vertices` blocks follow.
  EulerLagrangeRows(std::vector<VertexElements> parts, int num_sums, int num_vertices);

  bool Evaluate(const double* const* blocks, double* residual, double** jacobians) const override;

 private:
  const std::vector<VertexElements> parts_;
};

/// Y_v - x_v.
struct Displacement {
  Eigen::Vector3d from;

  template <typename T>
  bool operator()(const T* y, T* residual) const {
    for (int axis = 0; axis < 3; ++axis) residual[axis] = y[axis] - from(axis);
    return true;
  }
};

/// Equation (7) for the three coordinates j of one vertex: F_0 - 2 x_j (G x)_j - C_j, where F_0 -
/// C_j = 2 a_j is stored as one number, because F_0 alone is much larger. Parameter blocks: the
/// velocities of the vertices that G couples with this one, beginning with itself.
struct FirstIntegralRows {
  std::vector<Eigen::Matrix3d> couplings;  ///< blocks of G, one per parameter block
  Eigen::Vector3d constants;               ///< a_j
  double scale = 1;                        ///< of the residuals

  template <typename T>
  bool operator()(const T* const* blocks, T* residual) const {
    T momentum[3] = {T(0.0), T(0.0), T(0.0)};
    for (size_t w = 0; w < couplings.size(); ++w) {
      for (int axis = 0; axis < 3; ++axis) {
        for (int k = 0; k < 3; ++k) momentum[axis] += couplings[w](axis, k) * blocks[w][k];
      }
    }
    for (int axis = 0; axis < 3; ++axis) {
      residual[axis] = scale * (2 * constants(axis) - 2.0 * blocks[0][axis] * momentum[axis]);
    }
    return true;
  }
};

}  // namespace shapespace::cost

#endif  // SHAPESPACE_COST_SHOOTING_COST_H_
