#include <shapespace/metric/feature_registry.h>

#include <cmath>
#include <map>
#include <mutex>
#include <typeindex>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/metric/define_feature.h>
#include <shapespace/metric/dihedral.h>
#include <shapespace/metric/edge_length.h>
#include <shapespace/metric/position.h>
#include <shapespace/metric/triangle_strain.h>
#include <shapespace/metric/turning_angle.h>
#include <shapespace/metric/volume.h>

namespace shapespace {
namespace {

struct Entry {
  std::type_index type;
  internal::FeatureKind kind;
};

template <typename Struct>
std::pair<const std::string, Entry> BuiltIn() {
  return {Struct::kName, {typeid(Struct), internal::KindOf<Struct>(&Struct::Freeze)}};
}

struct Registry {
  std::mutex mutex;
  std::map<std::string, Entry> entries = {BuiltIn<EdgeLength>(),     BuiltIn<LogLength>(),
                                          BuiltIn<TriangleStrain>(), BuiltIn<PositionFeature>(),
                                          BuiltIn<Dihedral>(),       BuiltIn<TurningAngle>(),
                                          BuiltIn<VolumeFeature>()};
};

Registry& TheRegistry() {
  static Registry registry;
  return registry;
}

}  // namespace

bool IsRegistered(const std::string& name) {
  Registry& registry = TheRegistry();
  const std::lock_guard<std::mutex> lock(registry.mutex);
  return registry.entries.count(name) > 0;
}

namespace internal {

void Register(const std::string& name, const std::type_info& type, FeatureKind kind) {
  Registry& registry = TheRegistry();
  const std::lock_guard<std::mutex> lock(registry.mutex);
  const auto found = registry.entries.find(name);
  if (found != registry.entries.end() && found->second.type != std::type_index(type)) {
    throw InvalidOptions("feature " + name,
                         "a feature of another type has that name; choose another kName");
  }
  registry.entries.insert_or_assign(name, Entry{type, std::move(kind)});
}

FeatureKind FindFeature(const std::string& name) {
  Registry& registry = TheRegistry();
  const std::lock_guard<std::mutex> lock(registry.mutex);
  const auto found = registry.entries.find(name);
  if (found == registry.entries.end()) {
    throw InvalidOptions("feature " + name,
                         "is not known to this program; a program that defines it calls "
                         "RegisterFeature (shapespace/metric/define_feature.h), or "
                         "define_feature in Python, first");
  }
  return found->second.kind;
}

void CheckFeature(const Feature& feature, int num_vertices) {
  const std::string name = "feature " + feature.Name();
  for (int e = 0; e < feature.NumElements(); ++e) {
    for (int k = 0; k < feature.VerticesPerElement(); ++k) {
      const int v = feature.Element(e)[k];
      if (v < 0 || v >= num_vertices) {
        throw InvalidOptions(name, "element " + std::to_string(e) + " has vertex " +
                                       std::to_string(v) + ", which is not one of the mesh's " +
                                       std::to_string(num_vertices));
      }
    }
  }
  if (!feature.HasNumbers()) {
    throw InvalidOptions(
        name, "needs " + std::to_string(feature.NumbersPerElement()) + " numbers for each of its " +
                  std::to_string(feature.NumElements()) + " elements, one column each");
  }
  for (int e = 0; e < feature.NumElements(); ++e) {
    for (int k = 0; k < feature.NumbersPerElement(); ++k) {
      if (!std::isfinite(feature.Numbers(e)[k])) {
        throw InvalidOptions(name, "number " + std::to_string(k) + " of element " +
                                       std::to_string(e) + " is not finite");
      }
    }
  }
  const Eigen::VectorXd& weights = feature.Weights();
  const int wanted = feature.IsSum() ? 1 : feature.NumElements();
  if (weights.size() != wanted) {
    throw InvalidOptions(name, "has " + std::to_string(weights.size()) + " weights, its " +
                                   (feature.IsSum() ? "sum needs " : "elements need ") +
                                   std::to_string(wanted));
  }
  for (int e = 0; e < weights.size(); ++e) {
    if (!(weights(e) >= 0) || !std::isfinite(weights(e))) {
      throw InvalidOptions(name,
                           "weight " + std::to_string(e) + " is not a number of zero or more");
    }
  }
}

}  // namespace internal
}  // namespace shapespace
