#ifndef SHAPESPACE_ANALYSIS_PATH_INTERSECTIONS_H_
#define SHAPESPACE_ANALYSIS_PATH_INTERSECTIONS_H_

#include <cstdint>
#include <vector>

#include <shapespace/path/path.h>

namespace shapespace {

/// Where the body passes through itself, which no term of a metric sees: the paper's own
/// limitation. Numbers of pairs of triangles as in analysis/intersections.h.
struct PathIntersections {
  std::vector<std::int64_t> pairs;  ///< of each shape
  std::int64_t poses_max = 0;       ///< of the shapes that were given
  std::int64_t inner_max = 0;       ///< of the others
  double inner_mean = 0;            ///< per shape
  /// Beyond those that the pose before and the pose after have, whichever has more: mean per inner
  /// shape. What the path is to blame for.
  double beyond_poses = 0;
};

/// \throw MeshError if a shape is not finite; Error if Embree fails.
PathIntersections MeasureIntersections(const Path& path);

}  // namespace shapespace

#endif  // SHAPESPACE_ANALYSIS_PATH_INTERSECTIONS_H_
