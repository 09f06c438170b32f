#ifndef SHAPESPACE_PATH_DETAIL_ENERGY_TERM_H_
#define SHAPESPACE_PATH_DETAIL_ENERGY_TERM_H_

#include <functional>
#include <memory>
#include <vector>

#include <shapespace/metric/feature.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/detail/energy_kernels.h>

// Evaluates the elements of one feature on a whole path.

namespace shapespace::internal {

/// Some elements of a feature. `stencils` contains rows of a PathRows instead of vertices.
struct ElementGroup {
  std::vector<int> stencils;
  std::vector<double> weights;
  std::vector<double> numbers;  // of the elements, if the feature has any
  std::vector<double> ends;     // values at the first and the last shape, if the kernel uses them

  int Count() const { return static_cast<int>(weights.size()); }
};

/// Adds the gradient of a group's part of the energy and returns that part. `quartic` is the weight
/// of the trapezoid's quartic part, or 0.
using GroupKernel =
    std::function<double(const PathRows& rows, const ElementGroup& group, double quartic)>;

struct TermKernel {
  GroupKernel evaluate;
  bool takes_ends = false;
};

/// The hand-written kernel of a feature if there is one; otherwise its struct evaluated with Jets.
/// Not for sum features.
TermKernel KernelOf(std::shared_ptr<const Feature> feature);

/// The kernels of a sum feature: its values at all times, and its gradient.
struct SumKernel {
  /// Adds the sum over the group's elements at each time to `values`, inner + 2 numbers.
  std::function<void(const PathRows& rows, const ElementGroup& group, double* values)> add_values;
  /// Adds the gradient of sum_t slopes[t] value_t over the inner times.
  std::function<void(const PathRows& rows, const ElementGroup& group, const double* slopes)>
      add_gradients;
};

SumKernel SumKernelOf(const std::shared_ptr<const Feature>& feature);

/// Fills `ends` of a group with the values of its elements at the first and at the last shape.
void EvaluateEnds(const Feature& feature, const std::vector<double>& first,
                  const std::vector<double>& last, ElementGroup* group);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_PATH_DETAIL_ENERGY_TERM_H_
