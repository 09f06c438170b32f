#ifndef SHAPESPACE_ANALYSIS_SHAPE_ERROR_H_
#define SHAPESPACE_ANALYSIS_SHAPE_ERROR_H_

#include <memory>

#include <shapespace/base/not_computed.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/metric/metric.h>

namespace shapespace {

/// The difference of a shape from another of the same mesh, up to rigid motion.
struct ShapeError {
  /// Of | |e| / |e_reference| - 1 | over all edges: root mean square weighted by area, 99th
  /// percentile and maximum. Edges shorter than a thousandth of the root mean square length are not
  /// counted.
  double edge_rms = kNotComputed, edge_p99 = kNotComputed, edge_max = kNotComputed;
  /// V / V_reference - 1; NaN if the reference encloses no volume (EnclosesVolume).
  double volume = kNotComputed;
  /// Hinges whose angle differs by more than 90 degrees; -1 until they are counted.
  int inverted_hinges = -1;
};

/// The error of `shape` relative to `reference`, both 3 x m and in the same unit.
ShapeError CompareShapes(const std::shared_ptr<const Metric>& metric, const Shape& reference,
                         const Shape& shape);

}  // namespace shapespace

#endif  // SHAPESPACE_ANALYSIS_SHAPE_ERROR_H_
