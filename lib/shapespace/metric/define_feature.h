#ifndef SHAPESPACE_METRIC_DEFINE_FEATURE_H_
#define SHAPESPACE_METRIC_DEFINE_FEATURE_H_

#include <functional>
#include <memory>
#include <string>
#include <typeinfo>
#include <utility>
#include <vector>

#if !__has_include(<ceres/jet.h>)
#error "shapespace/metric/define_feature.h needs the headers of Ceres: link ShapeSpace::features"
#endif
#include <ceres/jet.h>
#include <Eigen/Core>

#include <shapespace/metric/feature.h>
#include <shapespace/metric/feature_registry.h>
#include <shapespace/metric/line_jet.h>

// Converts a struct that derives from `ElementFeature` to a `Feature`, and registers it by name. To
// be included only where a feature is defined, because it includes ceres/jet.h for automatic
// derivatives. It is the only header of ShapeSpace::core that needs Ceres; the target
// ShapeSpace::features provides the headers of Ceres, and links none of its libraries.

namespace shapespace {
namespace internal {

/// The values of an element and their derivatives (as Feature::Evaluate) by Ceres' Jets.
template <typename Struct>
void DeriveAutomatically(const Struct& feature, const double* x, double* values,
                         double* derivatives) {
  constexpr int kSize = 3 * Struct::kVertices, kValues = Struct::kValues;
  using Jet = ceres::Jet<double, kSize>;
  Jet jet[Struct::kInputs], value[kValues];
  for (int k = 0; k < kSize; ++k) jet[k] = Jet(x[k], k);
  for (int k = kSize; k < Struct::kInputs; ++k) jet[k] = Jet(x[k]);
  feature(jet, value);
  for (int k = 0; k < kValues; ++k) values[k] = value[k].a;
  for (int corner = 0; corner < Struct::kVertices; ++corner) {
    for (int k = 0; k < kValues; ++k) {
      for (int axis = 0; axis < 3; ++axis) *derivatives++ = value[k].v[3 * corner + axis];
    }
  }
}

template <typename Struct>
class FeatureOf final : public Feature {
 public:
  explicit FeatureOf(Struct feature) : feature_(std::move(feature)) {
    static_assert(kVertices <= kMaxVertices && kValues <= kMaxValues && kInputs <= kMaxInputs,
                  "Feature::kMaxVertices, kMaxValues and kMaxInputs limit the size of an element");
    static_assert(!Struct::kSum || kValues == 1, "a sum has one value");
    name_ = Struct::kName;
    vertices_ = kVertices;
    values_ = kValues;
    numbers_per_element_ = Struct::kNumbers;
    num_elements_ = static_cast<int>(feature_.stencils.cols());
    scalar_rows_ = kHasRows ? Struct::kScalarRows : 3 * kValues;
    is_sum_ = Struct::kSum;
    is_rigid_invariant_ = Struct::kRigidInvariant;
    stencils_ = feature_.stencils.data();
    if (feature_.numbers.cols() == num_elements_) numbers_ = feature_.numbers.data();
    weights_ = &feature_.weights;
  }

  void Evaluate(int count, const double* x, double* values, double* derivatives) const override {
    for (int e = 0; e < count; ++e, x += kInputs, values += kValues) {
      if (derivatives == nullptr) {
        feature_(x, values);
        continue;
      }
      if constexpr (Struct::kHasDerivatives) {
        feature_.Derivatives(x, values, derivatives);
      } else {
        DeriveAutomatically(feature_, x, values, derivatives);
      }
      derivatives += kSize * kValues;
    }
  }

  void Differentiate(int count, const double* x, double* values,
                     double* derivatives) const override {
    if (derivatives == nullptr) return Evaluate(count, x, values, nullptr);
    for (int e = 0; e < count; ++e, x += kInputs, values += kValues) {
      DeriveAutomatically(feature_, x, values, derivatives);
      derivatives += kSize * kValues;
    }
  }

  void SecondDerivatives(int count, const double* x, const double* along,
                         double* values) const override {
    for (int e = 0; e < count; ++e, x += kInputs, along += kInputs) {
      LineJet jet[kInputs], value[kValues];
      for (int k = 0; k < kInputs; ++k) jet[k] = {x[k], k < kSize ? along[k] : 0, 0};
      feature_(jet, value);
      for (int k = 0; k < kValues; ++k) *values++ = value[k].second;
    }
  }

  double LeastChange(int count, const double* a, const double* b, const double* weights,
                     int segments) const override {
    double sum = 0;
    for (int e = 0; e < count; ++e) {
      sum += weights[e] * feature_.LeastChange(a + kValues * e, b + kValues * e, segments);
    }
    return sum;
  }

  void ScalarRows(int count, const double* x, double* rows) const override {
    if constexpr (kHasRows) {
      for (int e = 0; e < count; ++e, x += kInputs, rows += kVertices * scalar_rows_) {
        Eigen::Vector3d vertices[kVertices];
        for (int k = 0; k < kVertices; ++k)
          vertices[k] = Eigen::Map<const Eigen::Vector3d>(x + 3 * k);
        feature_.ScalarRows(vertices, rows);
      }
    } else {
      Feature::ScalarRows(count, x, rows);
    }
  }

  std::vector<std::pair<std::string, double>> Constants() const override {
    std::vector<std::pair<std::string, double>> result;
    Struct::ForConstants(&feature_, [&](const char* name, const double& number) {
      result.emplace_back(name, number);
    });
    return result;
  }

 private:
  static constexpr int kVertices = Struct::kVertices, kValues = Struct::kValues;
  static constexpr int kSize = 3 * kVertices, kInputs = Struct::kInputs;
  static constexpr bool kHasRows = Struct::kScalarRows > 0;

  const void* StructIf(const std::type_info& type) const override {
    return type == typeid(Struct) ? &feature_ : nullptr;
  }

  const Struct feature_;
};

}  // namespace internal

/// Makes a feature of a struct. It is checked when a metric with it is frozen or read.
template <typename Struct>
std::shared_ptr<const Feature> MakeFeature(Struct feature) {
  return std::make_shared<const internal::FeatureOf<Struct>>(std::move(feature));
}

namespace internal {

template <typename Struct>
FeatureKind KindOf(std::function<Struct(const MetricBasis&)> freeze) {
  FeatureKind kind;
  kind.vertices = Struct::kVertices;
  kind.numbers = Struct::kNumbers;
  kind.is_sum = Struct::kSum;
  kind.freeze = [freeze](const MetricBasis& basis, double coefficient) {
    Struct feature = freeze(basis);
    feature.weights *= coefficient;
    return MakeFeature(std::move(feature));
  };
  kind.restore = [](const Eigen::MatrixXi& stencils, const Eigen::VectorXd& weights,
                    const Eigen::MatrixXd& numbers,
                    const std::function<double(const std::string&)>& constant) {
    Struct feature;
    feature.stencils = stencils;
    feature.weights = weights;
    feature.numbers = numbers;
    Struct::ForConstants(&feature,
                         [&](const char* name, double& number) { number = constant(name); });
    return MakeFeature(std::move(feature));
  };
  return kind;
}

}  // namespace internal

/// Registers a feature by its name, Struct::kName, for `MetricOptions::features`, every level of
/// every solver, and readers of files. `freeze` returns the feature on a mesh: its stencils, its
/// weights for a coefficient of 1, and its constants. It is called for every coarser mesh too, also
/// from several threads, and must depend on its argument only. A feature without elements is not
/// used in the metric.
/// \throw InvalidOptions if a feature of another type has that name.
template <typename Struct>
void RegisterFeature(std::function<Struct(const MetricBasis&)> freeze = &Struct::Freeze) {
  internal::Register(Struct::kName, typeid(Struct), internal::KindOf<Struct>(std::move(freeze)));
}

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_DEFINE_FEATURE_H_
