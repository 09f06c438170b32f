#ifndef SHAPESPACE_MESH_INTERNAL_SIDES_H_
#define SHAPESPACE_MESH_INTERNAL_SIDES_H_

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

// The arrangement of polygons at edges and around vertices, from index arrays alone.

namespace shapespace::internal {

/// Disjoint sets of 0 ... size - 1.
class UnionFind {
 public:
  explicit UnionFind(int size) : parent_(size) { std::iota(parent_.begin(), parent_.end(), 0); }

  int Find(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  /// The smaller root remains the root, so that roots do not depend on the order of the calls.
  void Join(int i, int j) {
    i = Find(i);
    j = Find(j);
    parent_[std::max(i, j)] = std::min(i, j);
  }

 private:
  std::vector<int> parent_;
};

/// One side of a polygon: an edge, with the polygon to which it belongs.
struct Side {
  int high;        ///< the edge's larger vertex
  int polygon;     ///< to which the side belongs
  int at_low;      ///< corner of the polygon at the edge's smaller vertex
  int at_high;     ///< ... and at the larger
  bool ascending;  ///< the polygon runs from the smaller vertex to the larger
};

/// All sides of all polygons, by edge.
struct Sides {
  std::vector<int> begin;   ///< edge e has sides[begin[e]] ... sides[begin[e + 1] - 1]
  std::vector<Side> sides;  ///< ordered by smaller vertex, larger vertex, polygon
  std::vector<int> low;     ///< per edge: its smaller vertex
  int NumEdges() const { return static_cast<int>(low.size()); }
  int Count(int e) const { return begin[e + 1] - begin[e]; }
  std::pair<int, int> Ends(int e) const { return {low[e], sides[begin[e]].high}; }
  bool WoundAlike(int e) const {
    return Count(e) == 2 && sides[begin[e]].ascending == sides[begin[e] + 1].ascending;
  }
};

/// Sides that join a vertex to itself are not included.
inline Sides MakeSides(int num_vertices, const std::vector<int>& polygon_begin,
                       const std::vector<int>& corners) {
  const int num_polygons = static_cast<int>(polygon_begin.size()) - 1;
  // Bucket sort by the smaller vertex; only the few sides of each vertex remain to be sorted.
  std::vector<int> at(num_vertices + 1, 0);
  auto each_side = [&](auto&& use) {
    for (int p = 0; p < num_polygons; ++p) {
      const int first = polygon_begin[p], end = polygon_begin[p + 1];
      for (int k = first; k < end; ++k) {
        const int next = k + 1 == end ? first : k + 1;
        if (corners[k] != corners[next]) use(p, k, next);
      }
    }
  };
  each_side([&](int, int k, int next) { ++at[std::min(corners[k], corners[next]) + 1]; });
  std::partial_sum(at.begin(), at.end(), at.begin());
  Sides result;
  result.sides.resize(at.back());
  std::vector<int> fill(at.begin(), at.end() - 1);
  each_side([&](int p, int k, int next) {
    const bool ascending = corners[k] < corners[next];
    const int low = ascending ? k : next, high = ascending ? next : k;
    result.sides[fill[corners[low]]++] = {corners[high], p, low, high, ascending};
  });
  for (int v = 0; v < num_vertices; ++v) {
    const auto first = result.sides.begin() + at[v], end = result.sides.begin() + at[v + 1];
    std::stable_sort(first, end, [](const Side& s, const Side& t) { return s.high < t.high; });
    for (auto side = first; side != end; ++side) {
      if (side != first && side->high == (side - 1)->high) continue;
      result.begin.push_back(static_cast<int>(side - result.sides.begin()));
      result.low.push_back(v);
    }
  }
  result.begin.push_back(static_cast<int>(result.sides.size()));
  return result;
}

/// Per vertex the number of its fans: sets of polygons that are connected through edges at it.
inline std::vector<int> CountFans(int num_vertices, const std::vector<int>& polygon_begin,
                                  const std::vector<int>& corners, const Sides& sides) {
  UnionFind fans(static_cast<int>(corners.size()));
  for (int e = 0; e < sides.NumEdges(); ++e) {
    const Side& first = sides.sides[sides.begin[e]];
    for (int s = sides.begin[e] + 1; s < sides.begin[e + 1]; ++s) {
      fans.Join(first.at_low, sides.sides[s].at_low);
      fans.Join(first.at_high, sides.sides[s].at_high);
    }
  }
  for (size_t p = 0; p + 1 < polygon_begin.size(); ++p) {
    const int first = polygon_begin[p], end = polygon_begin[p + 1];
    for (int k = first; k < end; ++k) {
      const int next = k + 1 == end ? first : k + 1;
      if (corners[k] == corners[next]) fans.Join(k, next);
    }
  }
  std::vector<int> count(num_vertices, 0);
  for (int k = 0; k < static_cast<int>(corners.size()); ++k) {
    if (fans.Find(k) == k) ++count[corners[k]];
  }
  return count;
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_MESH_INTERNAL_SIDES_H_
