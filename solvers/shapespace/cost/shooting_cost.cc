#include <shapespace/cost/shooting_cost.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <shapespace/cost/gather_blocks.h>

namespace shapespace::cost {

EulerLagrangeRows::EulerLagrangeRows(std::vector<VertexElements> parts, int num_sums,
                                     int num_vertices)
    : parts_(std::move(parts)) {
  set_num_residuals(3);
  mutable_parameter_block_sizes()->assign(num_sums, 1);
  mutable_parameter_block_sizes()->resize(num_sums + num_vertices, 3);
}

bool EulerLagrangeRows::Evaluate(const double* const* blocks, double* residual,
                                 double** jacobians) const {
  std::fill_n(residual, 3, 0.0);
  const std::vector<int32_t>& sizes = parameter_block_sizes();
  for (size_t block = 0; jacobians != nullptr && block < sizes.size(); ++block) {
    if (jacobians[block] != nullptr) std::fill_n(jacobians[block], 3 * sizes[block], 0.0);
  }
  const auto jacobian_of = [&](int block) {
    return jacobians != nullptr ? jacobians[block] : nullptr;
  };
  for (const VertexElements& part : parts_) {
    const Feature& feature = *part.feature;
    const int* block = part.blocks.data();
    const double* target = part.targets.data();
    const double* gradient = part.gradient.data();
    if (feature.IsSum()) {
      double* const jacobian = jacobian_of(*block);
      for (int axis = 0; axis < 3; ++axis) {
        residual[axis] += gradient[axis] * (blocks[*block][0] - *target);
        if (jacobian != nullptr) jacobian[axis] += gradient[axis];
      }
      continue;
    }
    const int num_vertices = feature.VerticesPerElement(), num_values = feature.ValuesPerElement();
    double x[Feature::kMaxInputs], values[Feature::kMaxValues];
    double derivatives[3 * Feature::kMaxVertices * Feature::kMaxValues];
    for (const int element : part.elements) {
      GatherBlocks(
          feature, element, [&](int k) { return blocks[block[k]]; }, x);
      feature.Differentiate(1, x, values, jacobians != nullptr ? derivatives : nullptr);
      const double root = std::sqrt(feature.Weight(element));
      for (int value = 0; value < num_values; ++value, gradient += 3) {
        const double change = root * values[value] - *target++;
        for (int axis = 0; axis < 3; ++axis) residual[axis] += gradient[axis] * change;
        for (int k = 0; k < num_vertices; ++k) {
          double* const jacobian = jacobian_of(block[k]);
          if (jacobian == nullptr) continue;
          const double* const along = derivatives + 3 * (num_values * k + value);
          for (int axis = 0; axis < 3; ++axis) {
            for (int by = 0; by < 3; ++by) {
              jacobian[3 * axis + by] += root * gradient[axis] * along[by];
            }
          }
        }
      }
      block += num_vertices;
    }
  }
  return true;
}

}  // namespace shapespace::cost
