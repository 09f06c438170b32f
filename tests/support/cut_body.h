#ifndef SHAPESPACE_TESTS_SUPPORT_CUT_BODY_H_
#define SHAPESPACE_TESTS_SUPPORT_CUT_BODY_H_

#include <map>
#include <memory>
#include <utility>
#include <vector>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/shape.h>
#include <shapespace/mesh/soup.h>

namespace shapespace::testing {

/// A mesh as files store it: in islands, between which no polygons have common vertices. The
/// vertices of the whole mesh keep their numbers, and the copies follow after them.
struct CutBody {
  std::vector<int> polygon_begin, corners;
  std::vector<int> source;     ///< per vertex, that of the whole mesh: its representative
  Eigen::Matrix3Xi triangles;  ///< those of the whole mesh, with the copies as corners

  /// A shape, or any columns, of the whole mesh.
  template <typename Columns>
  Columns Of(const Columns& whole) const {
    return whole(Eigen::all, source);
  }

  /// The last copy of a vertex of the whole mesh.
  int LastCopy(int vertex) const {
    int last = vertex;
    for (size_t v = 0; v < source.size(); ++v) {
      if (source[v] == vertex) last = static_cast<int>(v);
    }
    return last;
  }

  /// Whether all copies of each vertex are exactly at one place.
  bool HasNoGap(const Shape& shape) const { return shape == Of(shape); }

  Soup AsSoup(const Shape& whole) const {
    Soup soup;
    soup.vertices = Of(whole);
    soup.polygon_begin = polygon_begin;
    soup.corners = corners;
    return soup;
  }
};

/// Cuts a mesh between polygons of different islands, by their numbers. A vertex remains with the
/// island of its first polygon.
inline CutBody CutIntoIslands(const Connectivity& whole, const std::vector<int>& island) {
  CutBody cut;
  cut.polygon_begin = whole.PolygonBegin();
  cut.triangles = whole.Triangles();
  for (int v = 0; v < whole.NumVertices(); ++v) cut.source.push_back(v);
  std::map<std::pair<int, int>, int> copies;  // by vertex and island
  std::vector<char> is_used(cut.source.size(), 0);
  const auto copy_of = [&](int v, int p) {
    const auto [found, is_new] = copies.try_emplace({v, island[p]}, v);
    if (is_new && is_used[v]) {
      found->second = static_cast<int>(cut.source.size());
      cut.source.push_back(v);
    }
    is_used[v] = 1;
    return found->second;
  };
  int f = 0;
  for (int p = 0; p < whole.NumPolygons(); ++p) {
    const int begin = cut.polygon_begin[p], end = cut.polygon_begin[p + 1];
    for (int k = begin; k < end; ++k) cut.corners.push_back(copy_of(whole.Corners()[k], p));
    for (const int last = f + end - begin - 2; f < last; ++f) {
      for (int& v : cut.triangles.col(f)) v = copy_of(v, p);
    }
  }
  return cut;
}

/// Every polygon by itself.
inline CutBody CutIntoPolygons(const Connectivity& whole) {
  std::vector<int> island;
  for (int p = 0; p < whole.NumPolygons(); ++p) island.push_back(p);
  return CutIntoIslands(whole, island);
}

/// The cut mesh with its copies joined.
inline std::shared_ptr<const Connectivity> Joined(const CutBody& cut, const Connectivity& whole) {
  std::vector<std::pair<int, int>> extra;
  for (int e = whole.NumTriangleEdges(); e < whole.NumEdges(); ++e) {
    extra.emplace_back(whole.Edges()(0, e), whole.Edges()(1, e));
  }
  return Connectivity::Make(static_cast<int>(cut.source.size()), cut.polygon_begin, cut.corners,
                            whole.Segments(), extra, cut.triangles, cut.source);
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SUPPORT_CUT_BODY_H_
