#ifndef SHAPESPACE_TESTS_SUPPORT_FEATURES_H_
#define SHAPESPACE_TESTS_SUPPORT_FEATURES_H_

#include <stdexcept>

#include <shapespace/metric/metric.h>

namespace shapespace::testing {

/// The first feature of a metric that is a `Struct`.
template <typename Struct>
const Struct& Get(const Metric& metric) {
  for (const auto& feature : metric.features) {
    if (const auto* of_type = feature->As<Struct>()) return *of_type;
  }
  throw std::runtime_error("the metric lacks the feature");
}

/// Calls body(struct) with the struct of a library feature, for tests that differentiate it
/// independently.
template <typename Body>
void WithStruct(const Feature& feature, const Body& body) {
  const auto with = [&](const auto* of_type) {
    if (of_type != nullptr) body(*of_type);
    return of_type != nullptr;
  };
  if (!with(feature.As<EdgeLength>()) && !with(feature.As<LogLength>()) &&
      !with(feature.As<TriangleStrain>()) && !with(feature.As<PositionFeature>()) &&
      !with(feature.As<Dihedral>()) && !with(feature.As<VolumeFeature>())) {
    throw std::runtime_error("the feature is not one of the library's");
  }
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_FEATURES_H_
