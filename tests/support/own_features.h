#ifndef SHAPESPACE_TESTS_SUPPORT_OWN_FEATURES_H_
#define SHAPESPACE_TESTS_SUPPORT_OWN_FEATURES_H_

#include <shapespace/metric/define_feature.h>
#include <shapespace/metric/metric.h>

// Features as a user defines them. Two say the same as features of the library, which have kernels,
// bounds and preconditioners of their own: results of both must agree.

namespace shapespace::testing {

struct OwnStrain : ElementFeature<3, 3> {
  static constexpr const char* kName = "own strain";
  TriangleStrain strain;

  static OwnStrain Freeze(const MetricBasis& basis) {
    OwnStrain feature;
    feature.strain = TriangleStrain::Freeze(basis);
    feature.stencils = feature.strain.stencils;
    feature.weights = feature.strain.weights;
    return feature;
  }
  template <typename Self, typename Visit>
  static void ForConstants(Self* self, const Visit& visit) {
    visit("epsilon", self->strain.epsilon_squared);
  }
  template <typename T>
  void operator()(const T* x, T* value) const {
    strain(x, value);
  }
};

struct OwnVolume : ElementFeature<3, 1> {
  static constexpr bool kSum = true;
  static constexpr const char* kName = "own volume";
  Volume volume;

  static OwnVolume Freeze(const MetricBasis& basis) {
    OwnVolume feature;
    feature.volume = Volume::Freeze(basis);
    feature.stencils = feature.volume.stencils;
    feature.weights = feature.volume.weights;
    return feature;
  }
  template <typename Self, typename Visit>
  static void ForConstants(Self* self, const Visit& visit) {
    visit("reference", self->volume.reference);
  }
  template <typename T>
  void operator()(const T* x, T* value) const {
    volume(x, value);
  }
};

/// The height of a vertex: not the same after a rotation.
struct Height : ElementFeature<1, 1> {
  static constexpr bool kRigidInvariant = false;
  static constexpr const char* kName = "height";

  static Height Freeze(const MetricBasis& basis) {
    Height feature;
    const int num_vertices = basis.connectivity->NumVertices();
    feature.stencils.setLinSpaced(num_vertices, 0, num_vertices - 1);
    feature.weights = basis.vertex_area;
    return feature;
  }
  template <typename T>
  void operator()(const T* x, T* value) const {
    value[0] = x[2];
  }
};

inline void RegisterOwnFeatures() {
  RegisterFeature<OwnStrain>();
  RegisterFeature<OwnVolume>();
  RegisterFeature<Height>();
}

/// Strain and volume, by the library's features.
inline MetricOptions LibraryBlend() {
  MetricOptions options;
  options.isometric = 0.3;
  options.strain = 0.7;
  options.volume = 0.2;
  return options;
}

/// The same by features of one's own.
inline MetricOptions OwnBlend() {
  RegisterOwnFeatures();
  MetricOptions options = LibraryBlend();
  options.strain = options.volume = 0;
  options.features = {{"own strain", 0.7}, {"own volume", 0.2}};
  return options;
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_OWN_FEATURES_H_
