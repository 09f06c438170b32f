#ifndef SHAPESPACE_ANALYSIS_QUALITY_H_
#define SHAPESPACE_ANALYSIS_QUALITY_H_

#include <vector>

#include <Eigen/Core>

#include <shapespace/base/not_computed.h>
#include <shapespace/path/path.h>

namespace shapespace {

/// Figures for properties that an energy does not show: the deviation of edges from their expected
/// lengths, and wrinkles and folds that the poses do not have.
struct PathQuality {
  /// Number of shapes between two poses. If 0, the figures of inner shapes are not a number.
  int inner_shapes = 0;
  /// |e| / |e_straight| - 1 over all edges and inner shapes: root mean square weighted by A_e; 99th
  /// percentile and maximum of the magnitude, unweighted. |e_straight| is the length that the edge
  /// would have if every element of the metric moved on the straight line between its values in the
  /// two poses around the shape: squared lengths under a cost of edge lengths, logarithmic strains
  /// under a cost of strain (docs/mathematics.md, section 7). Edges shorter than a thousandth of
  /// the root mean square length are not counted.
  double edge_rms = kNotComputed, edge_p99 = kNotComputed, edge_max = kNotComputed;
  /// The same for | |e| / |e_first| - 1 | relative to the first shape, over all shapes, including
  /// extrapolated ones.
  double first_rms = kNotComputed, first_p99 = kNotComputed, first_max = kNotComputed;
  /// Area-weighted root mean square, in degrees, of the difference between the dihedral angle and
  /// the interpolation between the poses' angles, over all inner shapes. NaN without hinges.
  double roughness = kNotComputed;
  /// Hinges folded beyond 120 degrees, and 40 degrees beyond both poses: mean per inner shape.
  double folds = kNotComputed;
  /// The greatest speed of a segment (square root of its energy over its length in t) relative to
  /// the mean of its piece: 1 on a geodesic, more if a part rests and then jumps. NaN for the rigid
  /// metric.
  double speed_max = kNotComputed;
};

PathQuality MeasureQuality(const Path& path);

struct RmsAndMax {
  double rms = 0, max = 0;
};

/// `first_rms` and `first_max` for shape `i` of the path alone; 0 for the first.
RmsAndMax DeviationFromFirst(const Path& path, int i);

/// The dihedral angle of every hinge (Dihedral::Angle) of a shape in the metric's unit.
Eigen::VectorXd DihedralAngles(const Connectivity& connectivity, const Shape& shape);

/// The greatest speed over the mean, as above, for `shapes` (in the metric's unit) at ascending
/// `times`.
double GreatestSpeed(const Metric& metric, const std::vector<Shape>& shapes,
                     const std::vector<double>& times);

/// Per vertex of `shape`, the A_e-weighted mean over its edges of | |e| / |e_reference| - 1 |: the
/// deviation shown by colours in the paper's Figure 5.
Eigen::VectorXd EdgeDeviation(const Metric& metric, const Shape& reference, const Shape& shape);

/// For shape `i` of the path relative to its first.
inline Eigen::VectorXd EdgeDeviation(const Path& path, int i) {
  return EdgeDeviation(*path.metric, path.shapes.front(), path.shapes[i]);
}

}  // namespace shapespace

#endif  // SHAPESPACE_ANALYSIS_QUALITY_H_
