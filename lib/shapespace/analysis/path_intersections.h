#ifndef SHAPESPACE_ANALYSIS_PATH_INTERSECTIONS_H_
#define SHAPESPACE_ANALYSIS_PATH_INTERSECTIONS_H_

#include <cstdint>
#include <vector>

#include <shapespace/base/not_computed.h>
#include <shapespace/path/path.h>

namespace shapespace {

/// Self-intersections of the body, which no term of a metric prevents, a limitation of the paper
/// too. Numbers are pairs of triangles as in analysis/intersections.h.
struct PathIntersections {
  std::vector<std::int64_t> pairs;   ///< per shape
  std::int64_t poses_max = -1;       ///< maximum over the given shapes
  std::int64_t inner_max = -1;       ///< maximum over the other shapes; -1 if there is none
  double inner_mean = kNotComputed;  ///< per shape; NaN if there is none
  /// Pairs in excess of the number in the previous and the next pose (the larger of the two): mean
  /// per inner shape. These are due to the path.
  double beyond_poses = kNotComputed;
};

/// \throw MeshError if a shape is not finite; Error if Embree fails.
PathIntersections MeasureIntersections(const Path& path);

}  // namespace shapespace

#endif  // SHAPESPACE_ANALYSIS_PATH_INTERSECTIONS_H_
