#ifndef SHAPESPACE_GEODESIC_INTERNAL_ARC_LENGTH_H_
#define SHAPESPACE_GEODESIC_INTERNAL_ARC_LENGTH_H_

#include <vector>

#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>

namespace shapespace::internal {

/// The times, from 0 to 1, at which a motion of constant speed along the curve of `shapes` (in the
/// metric's unit) reaches them: shares of the curve's length. A hundredth of each is the uniform
/// time, so that times ascend where shapes rest. The times are uniform if nothing moves, or if the
/// metric has no lengths (MetricOptions::Rigid).
std::vector<double> ArcLengthTimes(const Metric& metric, const std::vector<Shape>& shapes);

/// Equidistant times from 0 to 1, with `inner` ones between the two.
std::vector<double> UniformTimes(int inner);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_GEODESIC_INTERNAL_ARC_LENGTH_H_
