#include <shapespace/analysis/path_intersections.h>

#include <algorithm>

#include <shapespace/analysis/intersections.h>

namespace shapespace {

PathIntersections MeasureIntersections(const Path& path) {
  PathIntersections result;
  result.pairs = CountIntersections(*path.metric->connectivity, path.shapes);
  int inner = 0;
  double all_inner = 0, beyond_poses = 0;
  for (int i = 0; i < path.NumShapes(); ++i) {
    const std::int64_t pairs = result.pairs[i];
    const auto next = std::lower_bound(path.poses.begin(), path.poses.end(), i);
    if (next != path.poses.end() && *next == i) {
      result.poses_max = std::max(result.poses_max, pairs);
      continue;
    }
    ++inner;
    result.inner_max = std::max(result.inner_max, pairs);
    all_inner += static_cast<double>(pairs);
    std::int64_t around = 0;  // before the first and after the last pose there is only one
    if (next != path.poses.end()) around = result.pairs[*next];
    if (next != path.poses.begin()) around = std::max(around, result.pairs[*(next - 1)]);
    beyond_poses += static_cast<double>(std::max<std::int64_t>(0, pairs - around));
  }
  if (inner > 0) {
    result.inner_mean = all_inner / inner;
    result.beyond_poses = beyond_poses / inner;
  }
  return result;
}

}  // namespace shapespace
