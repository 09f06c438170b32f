#include <shapespace/cost/transport_constraint.h>

#include <utility>
#include <vector>

#include <ceres/autodiff_cost_function.h>

#include <shapespace/cost/shooting_cost.h>
#include <shapespace/cost/sum_cost.h>

namespace shapespace::cost {

void AddTransportConstraint(Tangent normal, double weight, double* bound, Tangent* y,
                            ceres::Problem* problem) {
  std::vector<double*> blocks;
  for (int v = 0; v < y->cols(); ++v) {
    blocks.push_back(y->col(v).data());
    problem->AddResidualBlock(
        new ceres::AutoDiffCostFunction<Displacement, 3, 3>(new Displacement{y->col(v)}), nullptr,
        blocks.back());
  }
  blocks.push_back(bound);
  problem->AddResidualBlock(
      new SumCost(
          [normal = std::move(normal)](const double* const* at, double scale, double** jacobians) {
            return AddInnerProduct(normal, at, scale, jacobians);
          },
          static_cast<int>(y->cols()), weight),
      nullptr, blocks);
  problem->SetParameterBlockConstant(bound);
}

}  // namespace shapespace::cost
