#ifndef SHAPESPACE_FILES_DETAIL_MERGE_H_
#define SHAPESPACE_FILES_DETAIL_MERGE_H_

#include <algorithm>
#include <numeric>
#include <vector>

#include <shapespace/mesh/shape.h>

// Vertices of formats that store a vertex several times.

namespace shapespace::internal {

/// Which vertices are the same: those with equal coordinates in all poses.
struct Merged {
  std::vector<int> first;  ///< of each different vertex, the first that equals it, ascending
  std::vector<int> index;  ///< of each vertex, its place in `first`
};

/// `poses` (one at least) have the same number of vertices, and finite coordinates.
inline Merged MergeEqual(const std::vector<Shape>& poses) {
  const auto count = static_cast<int>(poses[0].cols());
  const auto compare = [&](int a, int b) {
    for (const Shape& pose : poses) {
      for (int axis = 0; axis < 3; ++axis) {
        if (pose(axis, a) != pose(axis, b)) return pose(axis, a) < pose(axis, b) ? -1 : 1;
      }
    }
    return 0;
  };
  std::vector<int> order(count);
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [&](int a, int b) {
    const int sign = compare(a, b);
    return sign < 0 || (sign == 0 && a < b);
  });
  std::vector<int> first_equal(count);
  for (int i = 0; i < count; ++i) {
    const bool same = i > 0 && compare(order[i - 1], order[i]) == 0;
    first_equal[order[i]] = same ? first_equal[order[i - 1]] : order[i];
  }
  Merged merged;
  merged.index.resize(count);
  for (int v = 0; v < count; ++v) {
    if (first_equal[v] == v) {
      merged.index[v] = static_cast<int>(merged.first.size());
      merged.first.push_back(v);
    } else {
      merged.index[v] = merged.index[first_equal[v]];
    }
  }
  return merged;
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_FILES_DETAIL_MERGE_H_
