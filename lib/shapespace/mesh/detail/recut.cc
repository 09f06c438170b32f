#include <shapespace/mesh/detail/recut.h>

#include <algorithm>
#include <utility>
#include <vector>

#include <shapespace/mesh/internal/sides.h>

namespace shapespace::internal {
namespace {

using Edge = std::pair<int, int>;

std::vector<Edge> EdgesOf(const Sides& sides) {
  std::vector<Edge> edges;
  for (int e = 0; e < sides.NumEdges(); ++e) edges.push_back(sides.Ends(e));
  return edges;
}

/// Polygons that are connected through edges which the other mesh does not have.
struct Region {
  std::vector<Edge> border;  // ascending
  int polygons = 0;
  int triangles = 0;  // into which these can be cut

  /// Whether it can be one polygon, of which every edge that was taken out is a diagonal.
  bool IsPolygon() const { return triangles + 2 == static_cast<int>(border.size()); }
};

/// The regions by their borders; empty unless all are polygons. `edges` are those of the other
/// mesh.
std::vector<Region> Regions(const Soup& soup, const Sides& sides, const std::vector<Edge>& edges) {
  const auto is_common = [&](int e) {
    return std::binary_search(edges.begin(), edges.end(), sides.Ends(e));
  };
  UnionFind joined(soup.NumPolygons());
  std::vector<bool> is_border(sides.NumEdges());
  for (int e = 0; e < sides.NumEdges(); ++e) {
    is_border[e] = sides.Count(e) == 1 || is_common(e);
    for (int s = sides.begin[e] + 1; s < sides.begin[e + 1] && !is_border[e]; ++s) {
      joined.Join(sides.sides[s - 1].polygon, sides.sides[s].polygon);
    }
  }
  std::vector<Region> regions(soup.NumPolygons());
  for (int p = 0; p < soup.NumPolygons(); ++p) {
    Region& region = regions[joined.Find(p)];
    ++region.polygons;
    region.triangles += soup.polygon_begin[p + 1] - soup.polygon_begin[p] - 2;
  }
  for (int e = 0; e < sides.NumEdges(); ++e) {
    for (int s = sides.begin[e]; s < sides.begin[e + 1] && is_border[e]; ++s) {
      regions[joined.Find(sides.sides[s].polygon)].border.push_back(sides.Ends(e));
    }
  }
  regions.erase(std::remove_if(regions.begin(), regions.end(),
                               [](const Region& region) { return region.polygons == 0; }),
                regions.end());
  for (const Region& region : regions) {
    if (!region.IsPolygon()) return {};
  }
  std::sort(regions.begin(), regions.end(),
            [](const Region& r, const Region& s) { return r.border < s.border; });
  return regions;
}

}  // namespace

int CountRecutPolygons(const Soup& a, const Soup& b) {
  const Sides sides_a = MakeSides(a.NumVertices(), a.polygon_begin, a.corners);
  const Sides sides_b = MakeSides(b.NumVertices(), b.polygon_begin, b.corners);
  const std::vector<Region> regions_a = Regions(a, sides_a, EdgesOf(sides_b));
  const std::vector<Region> regions_b = Regions(b, sides_b, EdgesOf(sides_a));
  const auto same_border = [](const Region& r, const Region& s) { return r.border == s.border; };
  if (!std::equal(regions_a.begin(), regions_a.end(), regions_b.begin(), regions_b.end(),
                  same_border)) {
    return 0;
  }
  int count = 0;
  for (size_t i = 0; i < regions_a.size(); ++i) {
    count += regions_a[i].polygons > 1 || regions_b[i].polygons > 1;
  }
  return count;
}

}  // namespace shapespace::internal
