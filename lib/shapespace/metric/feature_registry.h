#ifndef SHAPESPACE_METRIC_FEATURE_REGISTRY_H_
#define SHAPESPACE_METRIC_FEATURE_REGISTRY_H_

#include <functional>
#include <memory>
#include <string>
#include <typeinfo>
#include <vector>

#include <Eigen/Core>

#include <shapespace/metric/feature.h>
#include <shapespace/metric/metric_basis.h>

// Features by name. Programs call `RegisterFeature` (define_feature.h).

namespace shapespace {

/// Whether a feature of that name has been registered.
bool IsRegistered(const std::string& name);

namespace internal {

/// A registered feature.
struct FeatureKind {
  int vertices = 0;
  bool is_sum = false;
  int numbers = 0;  ///< of each element
  std::function<std::shared_ptr<const Feature>(const MetricBasis&, double coefficient)> freeze;
  /// From the content of a file; `constant` returns a number by its name.
  std::function<std::shared_ptr<const Feature>(
      const Eigen::MatrixXi& stencils, const Eigen::VectorXd& weights,
      const Eigen::MatrixXd& numbers, const std::function<double(const std::string&)>& constant)>
      restore;
};

/// \throw InvalidOptions if a feature of another type has that name.
void Register(const std::string& name, const std::type_info& type, FeatureKind kind);

/// \throw InvalidOptions, explaining how to register it, if there is no feature of that name.
FeatureKind FindFeature(const std::string& name);

/// \throw InvalidOptions naming the feature, if its stencils have a vertex that is not in the mesh,
///        its numbers are not finite ones for each element, or its weights are not one finite
///        number, zero or more, for each element.
void CheckFeature(const Feature& feature, int num_vertices);

}  // namespace internal
}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_FEATURE_REGISTRY_H_
