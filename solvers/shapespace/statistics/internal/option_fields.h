#ifndef SHAPESPACE_STATISTICS_INTERNAL_OPTION_FIELDS_H_
#define SHAPESPACE_STATISTICS_INTERNAL_OPTION_FIELDS_H_

#include <shapespace/base/internal/fields.h>
#include <shapespace/metric/internal/option_fields.h>
#include <shapespace/statistics/shape_model.h>

// The fields of options (base/internal/fields.h).

namespace shapespace::internal {

inline Words<PoseSize> WordsOf(Of<PoseSize>) {
  return {{"keep", PoseSize::kKeep}, {"remove", PoseSize::kRemove}};
}

/// Of the geodesics' options those that are of use here.
template <typename Visit>
void ForOptions(Of<AverageOptions>, const Visit& visit) {
  visit("weights", &AverageOptions::weights,
        "One per pose, not negative, of any sum. None: all equal.");
  visit("certify", &AverageOptions::certify,
        "Compare the mean with a lower bound, which takes a geodesic from it to each pose.");
  visit("refine", &AverageOptions::refine,
        "Lower the sum of squared lengths of geodesics from the mean to the poses.");
  visit("tolerance", &AverageOptions::tolerance,
        "Converged when an iteration lowers the squared distance from the mean features by less "
        "than this share of the variance.");
  visit("max_iterations", &AverageOptions::max_iterations,
        "Reaching them is reported as not converged.");
  visit(
      "metric", [](auto& options) -> auto& { return options.geodesic.metric; },
      "The metric, in which features are compared.");
  visit(
      "shapes", [](auto& options) -> auto& { return options.geodesic.shapes; },
      "Shapes between the mean and a pose, for the lower bound.");
  visit(
      "memory_limit", [](auto& options) -> auto& { return options.geodesic.memory_limit; },
      "Bytes that the solve may take; an estimate above it is refused at once.");
}

template <typename Visit>
void ForOptions(Of<ShapeModelOptions>, const Visit& visit) {
  visit("modes", &ShapeModelOptions::modes,
        "Number of modes, at most; 0: as many as the poses' variation has dimensions.");
  visit("size", &ShapeModelOptions::size,
        "A larger pose is another shape; or all are scaled to the same area.");
  ForOptionsOfPart(&ShapeModelOptions::average, visit);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_STATISTICS_INTERNAL_OPTION_FIELDS_H_
