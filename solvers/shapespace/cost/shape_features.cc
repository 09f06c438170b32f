#include <shapespace/cost/shape_features.h>

#include <algorithm>
#include <utility>

#include <shapespace/base/parallel.h>

namespace shapespace::cost {
namespace {

constexpr int kElements = 64;  // evaluated at a time

}  // namespace

ShapeFeatures::ShapeFeatures(std::shared_ptr<const Metric> metric, const std::vector<Shape>* shapes)
    : metric_(std::move(metric)),
      shapes_(*shapes),
      values_(metric_->features.size() * shapes->size()) {
  for (size_t i = 0; i < values_.size(); ++i) {
    const Feature& feature = *metric_->features[i / shapes_.size()];
    if (feature.IsSum()) continue;
    const size_t count = static_cast<size_t>(feature.NumElements()) * feature.ValuesPerElement();
    values_[i].values.resize(count);
    values_[i].derivatives.resize(3 * feature.VerticesPerElement() * count);
  }
}

void ShapeFeatures::PrepareForEvaluation(bool evaluate_jacobians, bool new_evaluation_point) {
  if (!new_evaluation_point && (have_derivatives_ || !evaluate_jacobians)) return;
  have_derivatives_ = evaluate_jacobians;
  ParallelFor(static_cast<int>(values_.size()), [&](int i) {
    const Feature& feature = *metric_->features[i / shapes_.size()];
    if (feature.IsSum()) return;
    const int coordinates = 3 * feature.VerticesPerElement(), values = feature.ValuesPerElement();
    double x[kElements * Feature::kMaxInputs];
    for (int begin = 0; begin < feature.NumElements(); begin += kElements) {
      const int end = std::min(begin + kElements, feature.NumElements());
      feature.GatherCoordinates(begin, end, shapes_[i % shapes_.size()], x);
      feature.Differentiate(
          end - begin, x, values_[i].values.data() + static_cast<size_t>(begin) * values,
          evaluate_jacobians
              ? values_[i].derivatives.data() + static_cast<size_t>(begin) * coordinates * values
              : nullptr);
    }
  });
}

}  // namespace shapespace::cost
