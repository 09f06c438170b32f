#include <shapespace/path/detail/energy_term.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace shapespace::internal {
namespace {

// Some elements of one feature at all times of a path, evaluated together: as many as have about
// kNumbers derivatives, which fit into the cache.
class ElementsAtAllTimes {
 public:
  ElementsAtAllTimes(const Feature& feature, const PathRows& rows)
      : feature_(feature),
        rows_(rows),
        size_(3 * feature.VerticesPerElement()),
        inputs_(feature.InputsPerElement()),
        times_(rows.inner + 2),
        most_(std::max(1, kNumbers / (times_ * size_ * feature.ValuesPerElement()))) {}

  int NumTimes() const { return times_; }
  // Of an element for which ForElements has called its body.
  double Value(int element, int time, int k) const {
    return values_[feature_.ValuesPerElement() * Place(element, time) + k];
  }

  // Calls body(element) for every element of the group, in order, when it has been evaluated.
  template <typename Body>
  void ForElements(const ElementGroup& group, bool with_derivatives, const Body& body) {
    for (begin_ = 0; begin_ < group.Count(); begin_ += most_) {
      const int end = std::min(begin_ + most_, group.Count());
      Evaluate(group, end, with_derivatives);
      for (int e = begin_; e < end; ++e) body(e);
    }
  }

  // Adds `slope` times the gradient of value k at an inner time.
  void AddGradient(const ElementGroup& group, int element, int time, int k, double slope) {
    const int num_values = feature_.ValuesPerElement();
    const double* const at = &derivatives_[Place(element, time) * size_ * num_values];
    for (int i = 0; i < size_; ++i) {
      rows_.gradient[Row(group, element, i) * rows_.stride + time - 1] +=
          slope * at[3 * (i / 3 * num_values + k) + i % 3];
    }
  }

 private:
  static constexpr int kNumbers = 1 << 14;

  size_t Place(int element, int time) const {
    return static_cast<size_t>(element - begin_) * times_ + time;
  }
  size_t Row(const ElementGroup& group, int element, int i) const {
    const size_t first = static_cast<size_t>(feature_.VerticesPerElement()) * element;
    return 3 * static_cast<size_t>(group.stencils[first + i / 3]) + i % 3;
  }

  void Evaluate(const ElementGroup& group, int end, bool with_derivatives) {
    const size_t sites = static_cast<size_t>(end - begin_) * times_;
    x_.resize(sites * inputs_);
    values_.resize(sites * feature_.ValuesPerElement());
    if (with_derivatives) derivatives_.resize(values_.size() * size_);
    for (int e = begin_; e < end; ++e) {
      for (int i = 0; i < size_; ++i) {
        const size_t row = Row(group, e, i);
        const auto at = [&](int time) -> double& { return x_[Place(e, time) * inputs_ + i]; };
        at(0) = rows_.first[row];
        for (int t = 0; t < rows_.inner; ++t) at(t + 1) = rows_.shapes[row * rows_.stride + t];
        at(times_ - 1) = rows_.last[row];
      }
      for (int time = 0; time < times_; ++time) {
        std::copy_n(group.numbers.data() + static_cast<size_t>(inputs_ - size_) * e,
                    inputs_ - size_, x_.data() + Place(e, time) * inputs_ + size_);
      }
    }
    feature_.Evaluate(static_cast<int>(sites), x_.data(), values_.data(),
                      with_derivatives ? derivatives_.data() : nullptr);
  }

  const Feature& feature_;
  const PathRows& rows_;
  const int size_, inputs_, times_, most_;
  int begin_ = 0;  // of the elements that have been evaluated
  std::vector<double> x_, values_, derivatives_;
};

// 2 sum w |Phi_{i+1} - Phi_i|^2 for any feature.
double GenericKernel(const Feature& feature, const PathRows& rows, const ElementGroup& group) {
  ElementsAtAllTimes elements(feature, rows);
  double energy = 0;
  elements.ForElements(group, true, [&](int e) {
    const double w = group.weights[e];
    const auto value = [&](int time, int k) { return elements.Value(e, time, k); };
    for (int k = 0; k < feature.ValuesPerElement(); ++k) {
      for (int t = 0; t + 1 < elements.NumTimes(); ++t) {
        energy += 2 * w * std::pow(value(t + 1, k) - value(t, k), 2);
      }
      for (int t = 1; t + 1 < elements.NumTimes(); ++t) {
        elements.AddGradient(group, e, t, k,
                             4 * w * (2 * value(t, k) - value(t - 1, k) - value(t + 1, k)));
      }
    }
  });
  return energy;
}

}  // namespace

TermKernel KernelOf(std::shared_ptr<const Feature> feature) {
  if (feature->As<EdgeLength>() != nullptr) {
    return {[](const PathRows& rows, const ElementGroup& group, double quartic) {
      return EdgeLengthKernel(rows, group.stencils.data(), group.weights.data(), group.Count(),
                              quartic);
    }};
  }
  if (feature->As<PositionFeature>() != nullptr) {
    return {[](const PathRows& rows, const ElementGroup& group, double) {
      return PositionKernel(rows, group.stencils.data(), group.weights.data(), group.Count());
    }};
  }
  if (const auto* dihedral = feature->As<Dihedral>()) {
    return {[normal = dihedral->normal_epsilon_squared, edge = dihedral->edge_epsilon_squared](
                const PathRows& rows, const ElementGroup& group, double) {
              return DihedralKernel(rows, group.stencils.data(), group.weights.data(),
                                    group.ends.data(), group.Count(), normal, edge);
            },
            true};
  }
  if (const auto* strain = feature->As<TriangleStrain>()) {
    return {[epsilon = strain->epsilon_squared](const PathRows& rows, const ElementGroup& group,
                                                double) {
              return TriangleStrainKernel(rows, group.stencils.data(), group.weights.data(),
                                          group.numbers.data(), group.ends.data(), group.Count(),
                                          epsilon);
            },
            true};
  }
  return {[feature = std::move(feature)](const PathRows& rows, const ElementGroup& group, double) {
    return GenericKernel(*feature, rows, group);
  }};
}

SumKernel SumKernelOf(const std::shared_ptr<const Feature>& feature) {
  if (const auto* volume = feature->As<VolumeFeature>()) {
    const double reference = volume->reference;
    return {[reference](const PathRows& rows, const ElementGroup& group, double* values) {
              AddVolumes(rows, group.stencils.data(), group.Count(), reference, values);
            },
            [reference](const PathRows& rows, const ElementGroup& group, const double* slopes) {
              AddVolumeGradients(rows, group.stencils.data(), group.Count(), reference, slopes);
            }};
  }
  return {[feature](const PathRows& rows, const ElementGroup& group, double* values) {
            ElementsAtAllTimes elements(*feature, rows);
            elements.ForElements(group, false, [&](int e) {
              for (int t = 0; t < elements.NumTimes(); ++t) values[t] += elements.Value(e, t, 0);
            });
          },
          [feature](const PathRows& rows, const ElementGroup& group, const double* slopes) {
            ElementsAtAllTimes elements(*feature, rows);
            elements.ForElements(group, true, [&](int e) {
              for (int t = 1; t + 1 < elements.NumTimes(); ++t) {
                elements.AddGradient(group, e, t, 0, slopes[t]);
              }
            });
          }};
}

void EvaluateEnds(const Feature& feature, const std::vector<double>& first,
                  const std::vector<double>& last, ElementGroup* group) {
  const int num_vertices = feature.VerticesPerElement(), num_values = feature.ValuesPerElement();
  group->ends.resize(2 * static_cast<size_t>(num_values) * group->Count());
  const int num_numbers = feature.NumbersPerElement();
  double x[Feature::kMaxInputs];
  for (int e = 0; e < group->Count(); ++e) {
    std::copy_n(group->numbers.data() + static_cast<size_t>(num_numbers) * e, num_numbers,
                x + 3 * num_vertices);
    const int* const stencil = &group->stencils[static_cast<size_t>(num_vertices) * e];
    double* values = &group->ends[2 * static_cast<size_t>(num_values) * e];
    for (const std::vector<double>* end : {&first, &last}) {
      for (int k = 0; k < num_vertices; ++k) {
        std::copy_n(&(*end)[3 * static_cast<size_t>(stencil[k])], 3, x + 3 * k);
      }
      feature.Evaluate(1, x, values);
      values += num_values;
    }
  }
}

}  // namespace shapespace::internal
