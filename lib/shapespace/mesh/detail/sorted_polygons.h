#ifndef SHAPESPACE_MESH_DETAIL_SORTED_POLYGONS_H_
#define SHAPESPACE_MESH_DETAIL_SORTED_POLYGONS_H_

#include <algorithm>
#include <numeric>
#include <vector>

#include <shapespace/mesh/soup.h>

// Finds equal polygons whose lists of vertices differ in order.

namespace shapespace::internal {

/// One list of vertices per polygon, and the polygons in lexicographic order of these lists.
struct SortedPolygons {
  std::vector<int> keys;   // as Soup::corners, with each polygon in a canonical order
  std::vector<int> order;  // polygons
  const std::vector<int>* begin;

  template <typename MakeKey>
  SortedPolygons(const Soup& soup, const MakeKey& make_key)
      : keys(soup.corners), order(soup.NumPolygons()), begin(&soup.polygon_begin) {
    for (int p = 0; p < soup.NumPolygons(); ++p) make_key(p, First(p), Last(p));
    std::iota(order.begin(), order.end(), 0);
    std::stable_sort(order.begin(), order.end(), [this](int p, int q) {
      return std::lexicographical_compare(First(p), Last(p), First(q), Last(q));
    });
  }

  std::vector<int>::iterator First(int p) { return keys.begin() + (*begin)[p]; }
  std::vector<int>::iterator Last(int p) { return keys.begin() + (*begin)[p + 1]; }
};

inline bool SameKey(SortedPolygons& a, int p, SortedPolygons& b, int q) {
  return std::equal(a.First(p), a.Last(p), b.First(q), b.Last(q));
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MESH_DETAIL_SORTED_POLYGONS_H_
