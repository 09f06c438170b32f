#include <shapespace/cost/tangent_projection.h>

#include <cmath>
#include <vector>

#include <ceres/cost_function.h>

#include <shapespace/base/error.h>
#include <shapespace/cost/internal/refuse_sums.h>

namespace shapespace::cost {
namespace {

// The rows of one element: a fixed matrix, its derivative at a shape, times the tangents of its
// vertices, minus `change`.
class ElementRows final : public ceres::CostFunction {
 public:
  // `derivative`: by vertex, by value, three numbers each (Feature::Evaluate), times the root of
  // the element's weight.
  ElementRows(std::vector<double> derivative, const double* change, int vertices, int values)
      : derivative_(std::move(derivative)), change_(change, change + values) {
    set_num_residuals(values);
    mutable_parameter_block_sizes()->assign(vertices, 3);
  }

  bool Evaluate(double const* const* tangents, double* residuals,
                double** jacobians) const override {
    const int values = num_residuals();
    for (int k = 0; k < values; ++k) residuals[k] = -change_[k];
    for (size_t corner = 0; corner < parameter_block_sizes().size(); ++corner) {
      for (int k = 0; k < values; ++k) {
        const double* const row = &derivative_[3 * (values * corner + k)];
        for (int axis = 0; axis < 3; ++axis) {
          residuals[k] += row[axis] * tangents[corner][axis];
          if (jacobians != nullptr && jacobians[corner] != nullptr) {
            jacobians[corner][3 * k + axis] = row[axis];
          }
        }
      }
    }
    return true;
  }

 private:
  const std::vector<double> derivative_, change_;
};

int NumValues(const Metric& metric) {
  int count = 0;
  for (const auto& feature : metric.features) {
    count += feature->NumElements() * feature->ValuesPerElement();
  }
  return count;
}

}  // namespace

void AddTangentProjection(const Metric& metric, const Shape& at, const Eigen::VectorXd& change,
                          Tangent* y, ceres::Problem* problem) {
  RefuseSums(metric, 0, "use Transport, or volume 0");
  if (metric.options.rigid > 0) throw InvalidOptions("rigid", "is no feature; use rigid 0");
  if (change.size() != NumValues(metric)) {
    throw MeshError("the change of the features has " + std::to_string(change.size()) +
                    " values instead of " + std::to_string(NumValues(metric)));
  }
  const double* next = change.data();
  for (const auto& feature : metric.features) {
    const int vertices = feature->VerticesPerElement(), values = feature->ValuesPerElement();
    double x[Feature::kMaxInputs], ignored[Feature::kMaxValues];
    for (int e = 0; e < feature->NumElements(); ++e, next += values) {
      std::vector<double> derivative(3 * vertices * values);
      feature->GatherCoordinates(e, e + 1, at, x);
      feature->Differentiate(1, x, ignored, derivative.data());
      for (double& entry : derivative) entry *= std::sqrt(feature->Weight(e));
      std::vector<double*> blocks;
      for (int k = 0; k < vertices; ++k) blocks.push_back(y->col(feature->Element(e)[k]).data());
      problem->AddResidualBlock(new ElementRows(std::move(derivative), next, vertices, values),
                                nullptr, blocks);
    }
  }
}

}  // namespace shapespace::cost
