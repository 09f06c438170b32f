#ifndef SHAPESPACE_TESTS_SUPPORT_OWN_FEATURES_H_
#define SHAPESPACE_TESTS_SUPPORT_OWN_FEATURES_H_

#include <shapespace/metric/define_feature.h>
#include <shapespace/metric/metric.h>

// User-defined features. Two of them equal features of the library, which have kernels, bounds and
// preconditioners of their own: results of both must agree.

namespace shapespace::testing {

/// A feature of the library as a user would define it, with only the members that are required.
template <typename Struct, typename Own>
struct CopyOf : ElementFeature<Struct::kVertices, Struct::kValues, Struct::kNumbers> {
  static constexpr bool kSum = Struct::kSum;
  Struct original;

  static Own Freeze(const MetricBasis& basis) {
    Own feature;
    feature.original = Struct::Freeze(basis);
    feature.stencils = feature.original.stencils;
    feature.weights = feature.original.weights;
    feature.numbers = feature.original.numbers;
    return feature;
  }
  template <typename Self, typename Visit>
  static void ForConstants(Self* self, const Visit& visit) {
    Struct::ForConstants(&self->original, visit);
  }
  template <typename T>
  void operator()(const T* x, T* value) const {
    original(x, value);
  }
};

struct OwnStrain : CopyOf<TriangleStrain, OwnStrain> {
  static constexpr const char* kName = "own strain";
};
struct OwnVolume : CopyOf<VolumeFeature, OwnVolume> {
  static constexpr const char* kName = "own volume";
};

/// The height of a vertex, which is not invariant under rotation.
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

/// The sum of the squared lengths of all edges.
struct Spread : ElementFeature<2, 1> {
  static constexpr bool kSum = true;
  static constexpr const char* kName = "spread";

  static Spread Freeze(const MetricBasis& basis) {
    Spread feature;
    feature.stencils = basis.connectivity->Edges();
    feature.weights = Eigen::VectorXd::Constant(1, 0.1);
    return feature;
  }
  template <typename T>
  void operator()(const T* x, T* value) const {
    value[0] = T(0);
    for (int axis = 0; axis < 3; ++axis) {
      const T difference = x[3 + axis] - x[axis];
      value[0] += difference * difference;
    }
  }
};

inline void RegisterOwnFeatures() {
  RegisterFeature<OwnStrain>();
  RegisterFeature<OwnVolume>();
  RegisterFeature<Height>();
  RegisterFeature<Spread>();
}

/// Strain and volume, with the library's features.
inline MetricOptions LibraryBlend() {
  MetricOptions options;
  options.isometric = 0.3;
  options.strain = 0.7;
  options.volume = 0.2;
  return options;
}

/// The same with user-defined features.
inline MetricOptions OwnBlend() {
  RegisterOwnFeatures();
  MetricOptions options = LibraryBlend();
  options.strain = options.volume = 0;
  options.features = {{"own strain", 0.7}, {"own volume", 0.2}};
  return options;
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_OWN_FEATURES_H_
