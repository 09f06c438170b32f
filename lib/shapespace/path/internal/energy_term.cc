#include <shapespace/path/internal/energy_term.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace shapespace::internal {
namespace {

// The elements of one feature at all times of a path, processed one by one.
class ElementAtAllTimes {
 public:
  ElementAtAllTimes(const Feature& feature, const PathRows& rows)
      : feature_(feature),
        rows_(rows),
        size_(3 * feature.VerticesPerElement()),
        times_(rows.inner + 2),
        x_(static_cast<size_t>(times_) * size_),
        values_(static_cast<size_t>(times_) * feature.ValuesPerElement()),
        derivatives_(values_.size() * size_) {}

  int NumTimes() const { return times_; }
  double Value(int time, int k) const { return values_[feature_.ValuesPerElement() * time + k]; }

  void Evaluate(const ElementGroup& group, int element, bool with_derivatives) {
    stencil_ = &group.stencils[static_cast<size_t>(feature_.VerticesPerElement()) * element];
    for (int i = 0; i < size_; ++i) {
      const size_t row = Row(i);
      x_[i] = rows_.first[row];
      for (int t = 0; t < rows_.inner; ++t) {
        x_[static_cast<size_t>(t + 1) * size_ + i] = rows_.shapes[row * rows_.stride + t];
      }
      x_[static_cast<size_t>(times_ - 1) * size_ + i] = rows_.last[row];
    }
    feature_.Evaluate(times_, x_.data(), values_.data(),
                      with_derivatives ? derivatives_.data() : nullptr);
  }

  // Adds `slope` times the gradient of value k at an inner time.
  void AddGradient(int time, int k, double slope) {
    const int num_values = feature_.ValuesPerElement();
    const double* const at = &derivatives_[static_cast<size_t>(time) * size_ * num_values];
    for (int i = 0; i < size_; ++i) {
      rows_.gradient[Row(i) * rows_.stride + time - 1] +=
          slope * at[3 * (i / 3 * num_values + k) + i % 3];
    }
  }

 private:
  size_t Row(int i) const { return 3 * static_cast<size_t>(stencil_[i / 3]) + i % 3; }

  const Feature& feature_;
  const PathRows& rows_;
  const int size_, times_;
  const int* stencil_ = nullptr;
  std::vector<double> x_, values_, derivatives_;
};

// 2 sum w |Phi_{i+1} - Phi_i|^2 for any feature.
double GenericKernel(const Feature& feature, const PathRows& rows, const ElementGroup& group) {
  ElementAtAllTimes element(feature, rows);
  double energy = 0;
  for (int e = 0; e < group.Count(); ++e) {
    element.Evaluate(group, e, true);
    const double w = group.weights[e];
    for (int k = 0; k < feature.ValuesPerElement(); ++k) {
      for (int t = 0; t + 1 < element.NumTimes(); ++t) {
        energy += 2 * w * std::pow(element.Value(t + 1, k) - element.Value(t, k), 2);
      }
      for (int t = 1; t + 1 < element.NumTimes(); ++t) {
        element.AddGradient(
            t, k,
            4 * w * (2 * element.Value(t, k) - element.Value(t - 1, k) - element.Value(t + 1, k)));
      }
    }
  }
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
                                          group.ends.data(), group.Count(), epsilon);
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
            ElementAtAllTimes element(*feature, rows);
            for (int e = 0; e < group.Count(); ++e) {
              element.Evaluate(group, e, false);
              for (int t = 0; t < element.NumTimes(); ++t) values[t] += element.Value(t, 0);
            }
          },
          [feature](const PathRows& rows, const ElementGroup& group, const double* slopes) {
            ElementAtAllTimes element(*feature, rows);
            for (int e = 0; e < group.Count(); ++e) {
              element.Evaluate(group, e, true);
              for (int t = 1; t + 1 < element.NumTimes(); ++t) {
                element.AddGradient(t, 0, slopes[t]);
              }
            }
          }};
}

void EvaluateEnds(const Feature& feature, const std::vector<double>& first,
                  const std::vector<double>& last, ElementGroup* group) {
  const int num_vertices = feature.VerticesPerElement(), num_values = feature.ValuesPerElement();
  group->ends.resize(2 * static_cast<size_t>(num_values) * group->Count());
  double x[3 * Feature::kMaxVertices];
  for (int e = 0; e < group->Count(); ++e) {
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
