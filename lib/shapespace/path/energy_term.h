#ifndef SHAPESPACE_PATH_ENERGY_TERM_H_
#define SHAPESPACE_PATH_ENERGY_TERM_H_

#include <functional>
#include <memory>
#include <vector>

#include <shapespace/metric/feature.h>
#include <shapespace/metric/metric.h>
#include <shapespace/path/energy_kernels.h>

// Private: how the elements of one feature are evaluated on a whole path.

namespace shapespace::internal {

/// Some elements of a feature. `stencils` holds blocks of rows of a PathRows instead of vertices.
struct ElementGroup {
  std::vector<int> stencils;
  std::vector<double> weights;
  std::vector<double> ends;  // values at the first and the last shape, where the kernel takes them

  int Count() const { return static_cast<int>(weights.size()); }
};

/// Adds the gradient of a group's part of the energy and returns that part. `quartic` is the weight
/// of the trapezoid's quartic part, 0 without.
using GroupKernel =
    std::function<double(const PathRows& rows, const ElementGroup& group, double quartic)>;

struct TermKernel {
  GroupKernel evaluate;
  bool takes_ends = false;
};

/// The hand-written kernel of a feature that has one; else its struct on Jets. Not for sums.
TermKernel KernelOf(std::shared_ptr<const Feature> feature);

/// The kernels of a sum over all elements: its values at all times, and its gradient.
struct SumKernel {
  /// Adds to `values`, inner + 2 numbers, what the group's elements sum up to at each time.
  std::function<void(const PathRows& rows, const ElementGroup& group, double* values)> add_values;
  /// Adds the gradient of sum_t slopes[t] value_t over the inner times.
  std::function<void(const PathRows& rows, const ElementGroup& group, const double* slopes)>
      add_gradients;
};

SumKernel SumKernelOf(std::shared_ptr<const Feature> feature);

/// Fills `ends` of a group: the values of its elements at the first and at the last shape.
void EvaluateEnds(const Feature& feature, const std::vector<double>& first,
                  const std::vector<double>& last, ElementGroup* group);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_PATH_ENERGY_TERM_H_
