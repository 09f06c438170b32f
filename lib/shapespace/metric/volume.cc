#include <shapespace/metric/volume.h>

#include <cmath>

#include <shapespace/base/error.h>
#include <shapespace/mesh/volume.h>
#include <shapespace/metric/metric_basis.h>

namespace shapespace {

VolumeFeature VolumeFeature::Freeze(const MetricBasis& basis) {
  const Eigen::Matrix3Xi& triangles = basis.connectivity->Triangles();
  if (!IsClosed(triangles)) {
    throw InvalidOptions(
        "volume",
        "the mesh is not closed, so it encloses no volume; use volume 0, or fill its "
        "holes");
  }
  VolumeFeature feature;
  feature.stencils = triangles;
  double volume = 0;
  for (const Shape& pose : basis.poses) {
    volume += EnclosedVolume(triangles, pose) / basis.poses.size();
  }
  if (std::abs(volume) < MetricBasis::kCollapsed) {
    throw InvalidOptions("volume", "the mesh encloses no volume; use volume 0");
  }
  feature.reference = std::abs(volume);
  feature.weights = Eigen::VectorXd::Ones(1);
  return feature;
}

}  // namespace shapespace
