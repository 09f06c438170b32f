#ifndef SHAPESPACE_SOLVERS_COST_EULER_LAGRANGE_H_
#define SHAPESPACE_SOLVERS_COST_EULER_LAGRANGE_H_

#include <memory>
#include <vector>

#include <ceres/problem.h>
#include <Eigen/Core>

#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>
#include <shapespace/solvers/cost/shooting_cost.h>

namespace shapespace::cost {

/// The equation of a step of shooting, J(at)^T [Phi(P) - target] = 0, for a problem of Ceres: three
/// rows a vertex (EulerLagrangeRows), on the vertices that share an element with it. With
/// target = 2 Phi(P_i) - Phi(P_(i-1)) and at = P_i its root is the next shape of a geodesic (the
/// discrete Euler-Lagrange equation of the path energy).
class EulerLagrange {
 public:
  /// Shapes in the metric's unit; `target` has the layout of FeatureMap::Values. Rows are
  /// multiplied by `scale`: Ceres' limits are absolute, and want numbers of about one.
  EulerLagrange(const Metric& metric, const Shape& at, const Eigen::VectorXd& target,
                double scale = 1);

  /// How many values of sum features (volume) there are, each an unknown of its own.
  int NumSums() const { return static_cast<int>(sum_gradients_.size()); }

  /// Adds all rows to `problem`. Its parameter blocks are shape->col(v).data(), and each of `sums`,
  /// which is resized and set to the values at `shape`; one more row for each couples it with all
  /// vertices, of a weight by which an error of it counts as much as the error that it makes in the
  /// others. Both must outlive the problem.
  void AddTo(Shape* shape, std::vector<double>* sums, ceres::Problem* problem) const;

  /// What rounding of values and coordinates leaves of the scaled residual where it should be zero:
  /// an estimate from above, as if all of it had one sign.
  double Rounding() const;

 private:
  const double* Add(const std::shared_ptr<const Feature>& feature, const Shape& at,
                    const double* targets, double scale);
  VertexElements& Part(const std::shared_ptr<const Feature>& feature, int v);
  void AddSums(Shape* shape, std::vector<double>* sums, ceres::Problem* problem) const;

  const std::vector<std::shared_ptr<const Feature>> features_;
  const int num_sums_;
  std::vector<std::vector<VertexElements>> rows_;  // of each vertex
  std::vector<std::vector<int>> neighbours_;
  Tangent magnitude_;  // the sums of the absolute values of what the residual is made of
  std::vector<double> sum_gradients_;  // norm of the scaled gradient of each sum feature
};

}  // namespace shapespace::cost

#endif  // SHAPESPACE_SOLVERS_COST_EULER_LAGRANGE_H_
