#include <shapespace/mesh/connectivity.h>

#include <algorithm>
#include <array>
#include <numeric>
#include <string>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/sort_unique.h>
#include <shapespace/mesh/internal/polygons.h>
#include <shapespace/mesh/internal/sides.h>

namespace shapespace {
namespace {

using Edge = std::pair<int, int>;

Edge Sorted(int a, int b) { return a < b ? Edge(a, b) : Edge(b, a); }

void CheckJoins(const std::vector<Edge>& joins, int num_vertices, const char* what) {
  for (const auto& [a, b] : joins) {
    if (a < 0 || b < 0 || a >= num_vertices || b >= num_vertices) {
      throw MeshError(std::string(what) + " " + std::to_string(a) + " " + std::to_string(b) +
                      ": vertex index outside 0 .. " + std::to_string(num_vertices - 1));
    }
    if (a == b) {
      throw MeshError(std::string(what) + " joins vertex " + std::to_string(a) + " to itself");
    }
  }
}

void CheckTriangles(const std::vector<int>& polygon_begin, const std::vector<int>& corners,
                    const Eigen::Matrix3Xi& triangles) {
  const size_t num_polygons = polygon_begin.size() - 1;
  bool good = triangles.cols() == static_cast<Eigen::Index>(corners.size() - 2 * num_polygons);
  int f = 0;
  for (size_t p = 0; p < num_polygons && good; ++p) {
    const auto first = corners.begin() + polygon_begin[p];
    const auto last = corners.begin() + polygon_begin[p + 1];
    for (const int end = f + static_cast<int>(last - first) - 2; f < end; ++f) {
      for (const int v : triangles.col(f)) good = good && std::find(first, last, v) != last;
    }
  }
  if (!good) {
    throw MeshError(
        "triangles: must be those into which the polygons are cut, polygon after polygon, two less "
        "than each has corners");
  }
}

void CheckRepresentatives(const std::vector<int>& representatives, int num_vertices) {
  if (representatives.empty()) return;
  bool good = static_cast<int>(representatives.size()) == num_vertices;
  for (size_t v = 0; v < representatives.size() && good; ++v) {
    const int r = representatives[v];
    good = r >= 0 && r < num_vertices && representatives[r] == r;
  }
  if (!good) {
    throw MeshError(
        "representatives: there must be one for each vertex, which represents itself too");
  }
}

// Per vertex the columns of `elements` that contain it, without repetitions.
template <typename Elements>
IndexLists ListsByVertex(int num_vertices, const Elements& elements) {
  std::vector<int> begin(num_vertices + 1, 0);
  const auto each = [&](auto&& use) {
    for (int i = 0; i < elements.cols(); ++i) {
      for (int k = 0; k < elements.rows(); ++k) {
        const auto before = elements.col(i).head(k);
        if (!(before.array() == elements(k, i)).any()) use(elements(k, i), i);
      }
    }
  };
  each([&](int v, int) { ++begin[v + 1]; });
  std::partial_sum(begin.begin(), begin.end(), begin.begin());
  std::vector<int> items(begin.back()), fill(begin.begin(), begin.end() - 1);
  each([&](int v, int i) { items[fill[v]++] = i; });
  return {std::move(begin), std::move(items)};
}

// Between corners of polygons with more than three corners that have one corner between them.
std::vector<Edge> Diagonals(const std::vector<int>& polygon_begin,
                            const std::vector<int>& corners) {
  std::vector<Edge> diagonals;
  for (size_t p = 0; p + 1 < polygon_begin.size(); ++p) {
    const int* corner = corners.data() + polygon_begin[p];
    const int size = polygon_begin[p + 1] - polygon_begin[p];
    for (int k = 0; k < size && size > 3; ++k) {
      const int a = corner[k], b = corner[(k + 2) % size];
      if (a != b) diagonals.push_back(Sorted(a, b));
    }
  }
  return diagonals;
}

// Where the corners of each triangle begin, and where the last ones end.
std::vector<int> TriangleBegins(const Eigen::Matrix3Xi& triangles) {
  std::vector<int> begin(triangles.cols() + 1);
  for (size_t f = 0; f < begin.size(); ++f) begin[f] = static_cast<int>(3 * f);
  return begin;
}

// The edges, each once. Appends the triangles at each to `list` and where they begin to `begin`,
// and the hinges.
std::vector<Edge> EdgesOfTriangles(int num_vertices, const Eigen::Matrix3Xi& triangles,
                                   std::vector<int>* begin, std::vector<int>* list,
                                   std::vector<std::array<int, 4>>* hinges) {
  const internal::Sides sides =
      internal::MakeSides(num_vertices, TriangleBegins(triangles),
                          {triangles.data(), triangles.data() + triangles.size()});
  // The third corner of the side's triangle.
  const auto opposite = [&](const internal::Side& side) {
    return triangles.data()[9 * side.polygon + 3 - side.at_low - side.at_high];
  };
  std::vector<Edge> edges;
  begin->push_back(0);
  for (int e = 0; e < sides.NumEdges(); ++e) {
    for (int s = sides.begin[e]; s < sides.begin[e + 1]; ++s) {
      const int f = sides.sides[s].polygon;  // once, also if two of its sides are the same edge
      if (s == sides.begin[e] || f != list->back()) list->push_back(f);
    }
    edges.push_back(sides.Ends(e));
    begin->push_back(static_cast<int>(list->size()));
    if (sides.Count(e) != 2 || sides.WoundAlike(e)) continue;
    const internal::Side* const pair = &sides.sides[sides.begin[e]];
    const int c = opposite(pair[pair[0].ascending ? 0 : 1]);
    const int d = opposite(pair[pair[0].ascending ? 1 : 0]);
    const auto [a, b] = edges.back();
    if (c != d && c != a && c != b && d != a && d != b) hinges->push_back({a, b, c, d});
  }
  return edges;
}

// Appends those of `others` that are not among the sorted `edges`, in order and each once.
void AddOtherEdges(std::vector<Edge> others, std::vector<Edge>* edges) {
  internal::SortUnique(&others);
  const size_t sorted = edges->size();
  for (const Edge& e : others) {
    if (!std::binary_search(edges->begin(), edges->begin() + sorted, e)) edges->push_back(e);
  }
}

}  // namespace

std::shared_ptr<const Connectivity> Connectivity::Make(
    int num_vertices, std::vector<int> polygon_begin, std::vector<int> corners,
    const std::vector<Edge>& segments, const std::vector<Edge>& stiffeners,
    const Eigen::Matrix3Xi& triangles, std::vector<int> representatives) {
  if (num_vertices <= 0) throw MeshError("a mesh needs at least one vertex");
  internal::CheckPolygons(num_vertices, polygon_begin, corners);
  CheckJoins(segments, num_vertices, "segment");
  CheckJoins(stiffeners, num_vertices, "stiffener");
  CheckRepresentatives(representatives, num_vertices);

  std::shared_ptr<Connectivity> result(new Connectivity);
  result->num_vertices_ = num_vertices;
  for (size_t v = 0; v < representatives.size(); ++v) {
    if (representatives[v] != static_cast<int>(v)) result->twins_.push_back(static_cast<int>(v));
  }
  if (!result->twins_.empty()) result->representatives_ = std::move(representatives);

  if (triangles.cols() == 0) {
    result->triangles_ = internal::Fans(polygon_begin, corners);
  } else {
    CheckTriangles(polygon_begin, corners, triangles);
    result->triangles_ = triangles;
  }
  const auto represented = [&](int v) { return result->Representative(v); };
  std::vector<int> own_corners = corners;
  if (!result->twins_.empty()) {
    result->file_triangles_ = result->triangles_;
    result->triangles_ = result->triangles_.unaryExpr(represented);
    std::transform(corners.begin(), corners.end(), own_corners.begin(), represented);
  }

  std::vector<std::array<int, 4>> hinges;
  std::vector<int> edge_begin, edge_triangles;
  std::vector<Edge> edges =
      EdgesOfTriangles(num_vertices, result->triangles_, &edge_begin, &edge_triangles, &hinges);
  result->num_triangle_edges_ = static_cast<int>(edges.size());
  std::vector<Edge> extra = Diagonals(polygon_begin, own_corners);
  for (const auto* joins : {&segments, &stiffeners}) {
    for (const auto& [a, b] : *joins) {
      const int v = represented(a), w = represented(b);
      if (v != w) extra.push_back(Sorted(v, w));  // joined twins are at one place anyway
    }
  }
  AddOtherEdges(std::move(extra), &edges);
  result->edges_.resize(2, edges.size());
  for (size_t e = 0; e < edges.size(); ++e) {
    result->edges_.col(e) << edges[e].first, edges[e].second;
  }
  result->hinges_.resize(4, hinges.size());
  for (size_t h = 0; h < hinges.size(); ++h) {
    result->hinges_.col(h) = Eigen::Map<const Eigen::Vector4i>(hinges[h].data());
  }
  result->triangles_of_edges_ = IndexLists(std::move(edge_begin), std::move(edge_triangles));
  result->triangles_of_vertices_ = ListsByVertex(num_vertices, result->triangles_);
  result->edges_of_vertices_ = ListsByVertex(num_vertices, result->edges_);
  result->polygon_begin_ = std::move(polygon_begin);
  result->corners_ = std::move(corners);
  result->segments_ = segments;
  return result;
}

std::shared_ptr<const Connectivity> Connectivity::FromTriangles(int num_vertices,
                                                                const Eigen::Matrix3Xi& triangles) {
  return Make(num_vertices, TriangleBegins(triangles),
              std::vector<int>(triangles.data(), triangles.data() + triangles.size()));
}

}  // namespace shapespace
