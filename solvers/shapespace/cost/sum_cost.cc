#include <shapespace/cost/sum_cost.h>

#include <shapespace/cost/gather_blocks.h>

namespace shapespace::cost {

double AddSum(const Feature& feature, const double* const* blocks, double scale,
              double** jacobians) {
  const int num_vertices = feature.VerticesPerElement();
  double sum = 0;
  double x[Feature::kMaxInputs], derivatives[3 * Feature::kMaxVertices];
  for (int e = 0; e < feature.NumElements(); ++e) {
    const int* const vertices = feature.Element(e);
    GatherBlocks(
        feature, e, [&](int k) { return blocks[vertices[k]]; }, x);
    double value;
    feature.Differentiate(1, x, &value, jacobians != nullptr ? derivatives : nullptr);
    sum += value;
    for (int k = 0; jacobians != nullptr && k < num_vertices; ++k) {
      double* const jacobian = jacobians[vertices[k]];
      for (int axis = 0; jacobian != nullptr && axis < 3; ++axis) {
        jacobian[axis] += scale * derivatives[3 * k + axis];
      }
    }
  }
  return scale * sum;
}

double AddInnerProduct(const Tangent& normal, const double* const* blocks, double scale,
                       double** jacobians) {
  using Jet = ceres::Jet<double, 3>;
  double sum = 0;
  for (int v = 0; v < normal.cols(); ++v) {
    Jet product(0.0);
    for (int axis = 0; axis < 3; ++axis) product += normal(axis, v) * Jet(blocks[v][axis], axis);
    sum += product.a;
    double* const jacobian = jacobians != nullptr ? jacobians[v] : nullptr;
    for (int axis = 0; jacobian != nullptr && axis < 3; ++axis) {
      jacobian[axis] += scale * product.v(axis);
    }
  }
  return scale * sum;
}

}  // namespace shapespace::cost
