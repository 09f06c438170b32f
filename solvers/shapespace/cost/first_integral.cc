#include <shapespace/cost/first_integral.h>

#include <vector>

#include <ceres/dynamic_autodiff_cost_function.h>

#include <shapespace/cost/detail/index_of.h>
#include <shapespace/cost/shooting_cost.h>

namespace shapespace::cost {

void AddFirstIntegral(const Eigen::SparseMatrix<double>& matrix, const Tangent& constants,
                      double scale, Tangent* velocity, ceres::Problem* problem) {
  for (int v = 0; v < velocity->cols(); ++v) {
    std::vector<int> neighbours = {v};
    FirstIntegralRows rows;
    rows.couplings.emplace_back(Eigen::Matrix3d::Zero());
    for (int axis = 0; axis < 3; ++axis) {
      for (Eigen::SparseMatrix<double>::InnerIterator entry(matrix, 3 * v + axis); entry; ++entry) {
        const size_t block = IndexOf(static_cast<int>(entry.row() / 3), &neighbours);
        if (block == rows.couplings.size()) rows.couplings.emplace_back(Eigen::Matrix3d::Zero());
        rows.couplings[block](axis, entry.row() % 3) = entry.value();
      }
    }
    rows.constants = constants.col(v);
    rows.scale = scale;
    auto* const cost =
        new ceres::DynamicAutoDiffCostFunction<FirstIntegralRows>(new FirstIntegralRows(rows));
    std::vector<double*> blocks;
    for (int neighbour : neighbours) {
      cost->AddParameterBlock(3);
      blocks.push_back(velocity->col(neighbour).data());
    }
    cost->SetNumResiduals(3);
    problem->AddResidualBlock(cost, nullptr, blocks);
  }
}

}  // namespace shapespace::cost
