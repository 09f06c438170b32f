#ifndef SHAPESPACE_COST_EULER_LAGRANGE_H_
#define SHAPESPACE_COST_EULER_LAGRANGE_H_

#include <memory>
#include <vector>

#include <ceres/problem.h>
#include <Eigen/Core>

#include <shapespace/cost/shooting_cost.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>

namespace shapespace::cost {

/// Adds the equation of a step of shooting, J(at)^T [Phi(P) - target] = 0, to a Ceres problem:
/// three rows per vertex (EulerLagrangeRows), which depend on the vertices that share an element
/// with it. With target = 2 Phi(P_i) - Phi(P_(i-1)) and at = P_i its root is the next shape of a
/// geodesic (the discrete Euler-Lagrange equation of the path energy).
class EulerLagrange {
 public:
  /// Shapes are in the metric's unit; `target` has the layout of FeatureMap::Values. Rows are
  /// multiplied by `scale`, because Ceres' limits are absolute and assume numbers of the order of
  /// one.
  EulerLagrange(const Metric& metric, const Shape& at, const Eigen::VectorXd& target,
                double scale = 1);

  /// Number of sum features' values (volume), each an additional unknown.
  int NumSums() const { return static_cast<int>(sum_gradients_.size()); }

  /// Adds all rows to `problem`. Its parameter blocks are shape->col(v).data() and each of `sums`,
  /// which is resized and set to the values at `shape`. One more row for each of `sums` couples it
  /// with all vertices; its weight is such that an error of the sum counts as much as the error
  /// that it causes in the other rows. Both must outlive the problem.
  void AddTo(Shape* shape, std::vector<double>* sums, ceres::Problem* problem) const;

  /// An upper estimate of the scaled residual that is due to the rounding of values and
  /// coordinates, as if all errors had the same sign.
  double Rounding() const;

 private:
  const double* Add(const std::shared_ptr<const Feature>& feature, const Shape& at,
                    const double* targets, double scale);
  VertexElements& Part(const std::shared_ptr<const Feature>& feature, int v);
  void AddSums(Shape* shape, std::vector<double>* sums, ceres::Problem* problem) const;

  const std::vector<std::shared_ptr<const Feature>> features_;
  const int num_sums_;
  std::vector<std::vector<VertexElements>> rows_;  // per vertex
  std::vector<std::vector<int>> neighbours_;
  Tangent magnitude_;                  // sums of the absolute values of the residual's terms
  std::vector<double> sum_gradients_;  // norm of the scaled gradient of each sum feature
};

}  // namespace shapespace::cost

#endif  // SHAPESPACE_COST_EULER_LAGRANGE_H_
