#include <shapespace/analysis/shape_error.h>

#include <cmath>

#include <shapespace/analysis/quality.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/mesh/volume.h>

namespace shapespace {

ShapeError CompareShapes(const std::shared_ptr<const Metric>& metric, const Shape& reference,
                         const Shape& shape) {
  const Connectivity& connectivity = *metric->connectivity;
  Path pair;
  pair.metric = metric;
  pair.shapes = {reference, shape};
  pair.parameters = {0, 1};
  pair.poses = {0};
  const PathQuality quality = MeasureQuality(pair);
  ShapeError error;
  error.edge_rms = quality.first_rms;
  error.edge_p99 = quality.first_p99;
  error.edge_max = quality.first_max;
  if (EnclosesVolume(connectivity.Triangles(), reference)) {
    error.volume = EnclosedVolume(connectivity.Triangles(), shape) /
                       EnclosedVolume(connectivity.Triangles(), reference) -
                   1;
  }
  const Eigen::VectorXd before = DihedralAngles(connectivity, reference);
  const Eigen::VectorXd after = DihedralAngles(connectivity, shape);
  error.inverted_hinges = 0;
  for (int h = 0; h < before.size(); ++h) {
    if (std::abs(WrapAngle(after(h) - before(h))) > internal::kPi / 2) ++error.inverted_hinges;
  }
  return error;
}

}  // namespace shapespace
