#ifndef SHAPESPACE_COST_SEGMENT_COST_H_
#define SHAPESPACE_COST_SEGMENT_COST_H_

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include <ceres/autodiff_cost_function.h>
#include <ceres/cost_function.h>

#include <shapespace/cost/gather_blocks.h>
#include <shapespace/cost/shape_features.h>
#include <shapespace/cost/sum_cost.h>
#include <shapespace/metric/metric.h>
#include <shapespace/metric/trapezoid.h>

namespace shapespace::cost {

// Ceres cost functions of one segment of a path, automatically differentiated, whether or not a
// feature has derivatives of its own (Feature::Differentiate). Their parameter blocks are vertices
// (3 numbers): first the element's vertices in shape i, then the same in shape i + 1. Residuals are
// scaled so that Ceres' cost, half the sum of squares, is a quarter of the energy.

/// sqrt(w) (Phi_{i+1} - Phi_i) of one element of a feature. Each end is differentiated with Jets of
/// its own, which are half as long as those of the whole segment would be.
class FeatureSegment final : public ceres::CostFunction {
 public:
  FeatureSegment(std::shared_ptr<const Feature> feature, int element)
      : feature_(std::move(feature)),
        element_(element),
        root_weight_(std::sqrt(feature_->Weight(element))) {
    set_num_residuals(feature_->ValuesPerElement());
    mutable_parameter_block_sizes()->assign(2 * feature_->VerticesPerElement(), 3);
  }

  bool Evaluate(const double* const* blocks, double* residual, double** jacobians) const override {
    const int num_vertices = feature_->VerticesPerElement();
    const int num_values = feature_->ValuesPerElement();
    double x[2 * Feature::kMaxInputs], values[2 * Feature::kMaxValues];
    double derivatives[2 * 3 * Feature::kMaxVertices * Feature::kMaxValues];
    for (int end = 0; end < 2; ++end) {
      GatherBlocks(
          *feature_, element_, [&](int k) { return blocks[end * num_vertices + k]; },
          x + end * feature_->InputsPerElement());
    }
    feature_->Differentiate(2, x, values, jacobians != nullptr ? derivatives : nullptr);
    for (int k = 0; k < num_values; ++k) {
      residual[k] = root_weight_ * (values[num_values + k] - values[k]);
    }
    if (jacobians == nullptr) return true;
    for (int block = 0; block < 2 * num_vertices; ++block) {
      if (jacobians[block] == nullptr) continue;
      const double factor = block < num_vertices ? -root_weight_ : root_weight_;
      const double* const of_block = derivatives + 3 * num_values * block;
      for (int k = 0; k < 3 * num_values; ++k) jacobians[block][k] = factor * of_block[k];
    }
    return true;
  }

 private:
  const std::shared_ptr<const Feature> feature_;
  const int element_;
  const double root_weight_;
};

/// The same, from values that are evaluated once for both segments of a shape.
class SharedFeatureSegment final : public ceres::CostFunction {
 public:
  /// `from` and `to` must outlive the cost function.
  SharedFeatureSegment(const Feature& feature, int element, const ShapeFeatures::Values& from,
                       const ShapeFeatures::Values& to)
      : num_vertices_(feature.VerticesPerElement()),
        num_values_(feature.ValuesPerElement()),
        element_(element),
        root_weight_(std::sqrt(feature.Weight(element))),
        from_(from),
        to_(to) {
    set_num_residuals(num_values_);
    mutable_parameter_block_sizes()->assign(2 * num_vertices_, 3);
  }

  bool Evaluate(const double* const* /*blocks*/, double* residual,
                double** jacobians) const override {
    const size_t first = static_cast<size_t>(element_) * num_values_;
    for (int k = 0; k < num_values_; ++k) {
      residual[k] = root_weight_ * (to_.values[first + k] - from_.values[first + k]);
    }
    for (int block = 0; jacobians != nullptr && block < 2 * num_vertices_; ++block) {
      if (jacobians[block] == nullptr) continue;
      const bool at_from = block < num_vertices_;
      const double factor = at_from ? -root_weight_ : root_weight_;
      const double* const of_block =
          (at_from ? from_ : to_).derivatives.data() +
          3 * (first * num_vertices_ + num_values_ * (block % num_vertices_));
      for (int k = 0; k < 3 * num_values_; ++k) jacobians[block][k] = factor * of_block[k];
    }
    return true;
  }

 private:
  const int num_vertices_, num_values_, element_;
  const double root_weight_;
  const ShapeFeatures::Values &from_, &to_;
};

/// The paper's (6) for one edge, with a weight for its quartic part (PathEnergy::SetQuarticWeight):
/// the residuals are a - b and a + b with the midpoint's a and a quartic b.
struct TrapezoidSegment {
  double root_weight, root_quartic_weight;

  template <typename T>
  bool operator()(const T* p0, const T* q0, const T* p1, const T* q1, T* residual) const {
    T from[6], to[6], ends[2];
    std::copy_n(p0, 3, from);
    std::copy_n(q0, 3, from + 3);
    std::copy_n(p1, 3, to);
    std::copy_n(q1, 3, to + 3);
    TrapezoidResiduals(from, to, ends);
    const T a = 0.5 * root_weight * M_SQRT1_2 * (ends[1] + ends[0]);
    const T b = 0.5 * root_weight * M_SQRT1_2 * root_quartic_weight * (ends[1] - ends[0]);
    residual[0] = a - b;
    residual[1] = a + b;
    return true;
  }
};

/// A sum feature couples all vertices: the blocks are all m vertices of shape i, followed by those
/// of shape i + 1.
class SumSegment final : public ceres::CostFunction {
 public:
  SumSegment(std::shared_ptr<const Feature> feature, int num_vertices)
      : feature_(std::move(feature)), num_vertices_(num_vertices) {
    set_num_residuals(1);
    mutable_parameter_block_sizes()->assign(2 * num_vertices, 3);
  }

  bool Evaluate(const double* const* blocks, double* residual, double** jacobians) const override {
    for (int block = 0; jacobians != nullptr && block < 2 * num_vertices_; ++block) {
      if (jacobians[block] != nullptr) std::fill_n(jacobians[block], 3, 0.0);
    }
    const double root = std::sqrt(feature_->Weight(0));
    double** const of_to = jacobians != nullptr ? jacobians + num_vertices_ : nullptr;
    *residual = AddSum(*feature_, blocks + num_vertices_, root, of_to) +
                AddSum(*feature_, blocks, -root, jacobians);
    return true;
  }

 private:
  const std::shared_ptr<const Feature> feature_;
  const int num_vertices_;
};

/// The rigid metric (3) for one vertex, with (c, c_bar) of the segment as an additional block of 6.
struct RigidSegment {
  double root_weight;

  template <typename T>
  bool operator()(const T* from, const T* to, const T* motion, T* residual) const {
    RigidForm::Residual(from, to, motion, motion + 3, residual);
    for (int k = 0; k < 3; ++k) residual[k] *= root_weight;
    return true;
  }
};

}  // namespace shapespace::cost

#endif  // SHAPESPACE_COST_SEGMENT_COST_H_
