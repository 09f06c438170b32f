#ifndef SHAPESPACE_COST_SUM_COST_H_
#define SHAPESPACE_COST_SUM_COST_H_

#include <algorithm>
#include <functional>
#include <utility>

#include <ceres/cost_function.h>
#include <ceres/jet.h>

#include <shapespace/mesh/shape.h>
#include <shapespace/metric/feature.h>

namespace shapespace::cost {

/// Returns `scale` times the sum of a feature's values over all elements, where block v contains
/// vertex v. Adds the derivatives to those of `jacobians` that are not null; `jacobians` itself may
/// be null.
double AddSum(const Feature& feature, const double* const* blocks, double scale,
              double** jacobians);

/// The same for the inner product <Y, normal>, vertex by vertex.
double AddInnerProduct(const Tangent& normal, const double* const* blocks, double scale,
                       double** jacobians);

/// weight (sum - s), for a sum over all elements and a number s: the value of a sum feature, or the
/// bound of a linear constraint. Parameter blocks: all m vertices, then s (1 number). Each element
/// is differentiated with Jets of its own size, so that time and memory of the dense row are
/// proportional to m; with DynamicAutoDiffCostFunction they would be proportional to m^2.
class SumCost final : public ceres::CostFunction {
 public:
  /// One of the functions above, bound to a feature or normal that outlives this object.
  using Add = std::function<double(const double* const* blocks, double scale, double** jacobians)>;

  SumCost(Add add, int num_vertices, double weight)
      : add_(std::move(add)), num_vertices_(num_vertices), weight_(weight) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->assign(num_vertices, 3);
    mutable_parameter_block_sizes()->push_back(1);
  }

  bool Evaluate(const double* const* blocks, double* residual, double** jacobians) const override {
    for (int v = 0; jacobians != nullptr && v < num_vertices_; ++v) {
      if (jacobians[v] != nullptr) std::fill_n(jacobians[v], 3, 0.0);
    }
    *residual = add_(blocks, weight_, jacobians) - weight_ * blocks[num_vertices_][0];
    if (jacobians != nullptr && jacobians[num_vertices_] != nullptr) {
      jacobians[num_vertices_][0] = -weight_;
    }
    return true;
  }

 private:
  const Add add_;
  const int num_vertices_;
  const double weight_;
};

}  // namespace shapespace::cost

#endif  // SHAPESPACE_COST_SUM_COST_H_
