#ifndef SHAPESPACE_METRIC_VOLUME_H_
#define SHAPESPACE_METRIC_VOLUME_H_

#include <Eigen/Core>

#include <shapespace/metric/feature.h>

namespace shapespace {

struct MetricBasis;

/// The volume enclosed by a closed mesh, relative to the mean over the poses: one number, the sum
/// of det(p, q, r) / (6 V_ref) over the triangles.
struct VolumeFeature : ElementFeature<3, 1> {
  static constexpr bool kSum = true;
  static constexpr const char* kName = "volume";

  double reference = 1;  ///< V_ref

  /// \throw InvalidOptions if the mesh is not closed.
  static VolumeFeature Freeze(const MetricBasis& basis);

  template <typename Self, typename Visit>
  static void ForConstants(Self* self, const Visit& visit) {
    visit("reference", self->reference);
  }

  template <typename T>
  void operator()(const T* x, T* value) const {
    value[0] = (x[0] * (x[4] * x[8] - x[5] * x[7]) + x[1] * (x[5] * x[6] - x[3] * x[8]) +
                x[2] * (x[3] * x[7] - x[4] * x[6])) /
               (6 * reference);
  }
};

}  // namespace shapespace

#endif  // SHAPESPACE_METRIC_VOLUME_H_
