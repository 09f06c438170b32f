#include <shapespace/mesh/check.h>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <shapespace/mesh/connectivity.h>
#include <shapespace/mesh/detail/sorted_polygons.h>
#include <shapespace/mesh/internal/check_positions.h>
#include <shapespace/mesh/internal/check_structure.h>
#include <shapespace/mesh/internal/check_words.h>
#include <shapespace/mesh/internal/sides.h>
#include <shapespace/mesh/seams.h>
#include <shapespace/mesh/topology.h>

namespace shapespace {
namespace {

using internal::FileName;
using internal::Named;
using internal::Number;
using internal::PolygonName;
using internal::SegmentName;
using internal::Sides;
using internal::SortedPolygons;
using internal::VertexName;

using Findings = std::vector<Finding>;

constexpr char kAllow[] = "repair the mesh, or allow it";

void CheckDegenerate(const Soup& soup, Findings* findings) {
  Named repeated, points;
  std::vector<int> sorted;
  for (int p = 0; p < soup.NumPolygons(); ++p) {
    sorted.assign(soup.corners.begin() + soup.polygon_begin[p],
                  soup.corners.begin() + soup.polygon_begin[p + 1]);
    std::sort(sorted.begin(), sorted.end());
    if (std::adjacent_find(sorted.begin(), sorted.end()) != sorted.end()) {
      repeated.Add([&] { return PolygonName(soup, p); });
    }
  }
  for (size_t s = 0; s < soup.segments.size(); ++s) {
    if (soup.segments[s].first == soup.segments[s].second) {
      points.Add([&] { return SegmentName(soup, static_cast<int>(s)); });
    }
  }
  repeated.Tell(soup, Severity::kNonManifold, "repeated-corner",
                "polygons with the same vertex at two corners", kAllow, findings);
  points.Tell(soup, Severity::kFatal, "degenerate-segment", "segments that join a vertex to itself",
              "take them out", findings);
}

void CheckRepeatedPolygons(const Soup& soup, Findings* findings) {
  using Iterator = std::vector<int>::iterator;
  SortedPolygons sorted(soup, [](int, Iterator first, Iterator last) { std::sort(first, last); });
  std::vector<std::pair<int, int>> pairs;  // the later polygon, the earlier one
  for (size_t i = 1; i < sorted.order.size(); ++i) {
    const int before = sorted.order[i - 1], p = sorted.order[i];
    if (SameKey(sorted, before, sorted, p)) pairs.emplace_back(p, before);
  }
  std::sort(pairs.begin(), pairs.end());
  Named repeated;
  for (const auto& [p, before] : pairs) {
    repeated.Add([&, p = p, before = before] {
      return PolygonName(soup, p) + " repeats " + PolygonName(soup, before);
    });
  }
  repeated.Tell(soup, Severity::kNonManifold, "repeated-polygon",
                "polygons with the same vertices as another one", kAllow, findings);
}

void CheckManifold(const Soup& soup, const Sides& sides, Findings* findings) {
  Named edges, winding, vertices;
  for (int e = 0; e < sides.NumEdges(); ++e) {
    auto name = [&] {
      const auto [a, b] = sides.Ends(e);
      std::string result = "edge " + std::to_string(a + 1) + "-" + std::to_string(b + 1) + " of ";
      constexpr int kMaxNamed = 4;
      for (int i = 0; i < std::min(sides.Count(e), kMaxNamed); ++i) {
        if (i > 0) result += i + 1 == sides.Count(e) ? " and " : ", ";
        result += PolygonName(soup, sides.sides[sides.begin[e] + i].polygon);
      }
      return result + (sides.Count(e) > kMaxNamed ? ", ..." : "");
    };
    if (sides.Count(e) > 2) edges.Add(name);
    if (sides.WoundAlike(e)) winding.Add(name);
  }
  const std::vector<int> fans =
      internal::CountFans(soup.NumVertices(), soup.polygon_begin, soup.corners, sides);
  for (int v = 0; v < soup.NumVertices(); ++v) {
    if (fans[v] > 1) vertices.Add([&] { return VertexName(soup, v); });
  }
  edges.Tell(soup, Severity::kNonManifold, "non-manifold-edge", "edges with more than two polygons",
             kAllow, findings);
  winding.Tell(soup, Severity::kNonManifold, "inconsistent-winding",
               "edges whose two polygons have inconsistent orientation",
               "recompute the orientation of the polygons, or allow it", findings);
  vertices.Tell(soup, Severity::kNonManifold, "non-manifold-vertex",
                "vertices at which separate parts of the surface touch", kAllow, findings);
}

void CheckUnreferenced(const Soup& soup, Findings* findings) {
  std::vector<bool> used(soup.NumVertices(), false);
  for (int v : soup.corners) used[v] = true;
  for (const auto& [a, b] : soup.segments) used[a] = used[b] = true;
  Named unused;
  for (int v = 0; v < soup.NumVertices(); ++v) {
    if (!used[v]) unused.Add([&] { return VertexName(soup, v); });
  }
  unused.Tell(soup, Severity::kWarning, "unreferenced-vertex",
              "vertices that no polygon and no segment uses",
              "their motion is not determined; remove them from every pose", findings);
}

/// Notes for a mesh without fatal findings.
void DescribeTopology(const Soup& soup, const Seams& seams, Findings* findings) {
  const Topology topology =
      ComputeTopology(*Connectivity::Make(soup.NumVertices(), soup.polygon_begin, soup.corners,
                                          soup.segments, {}, {}, seams.representatives));
  auto note = [&](const char* kind, const std::string& what) {
    findings->push_back({Severity::kNote, kind, FileName(soup) + ": " + what});
  };
  std::vector<int> sizes(topology.components, 0);
  for (int c : topology.component) {
    if (c >= 0) ++sizes[c];
  }
  static constexpr size_t kMaxNamed = 3;
  auto list = [](const std::vector<std::string>& parts) {
    std::string result;
    for (size_t i = 0; i < std::min(parts.size(), kMaxNamed); ++i) {
      result += (i > 0 ? ", " : "") + parts[i];
    }
    return result + (parts.size() > kMaxNamed ? ", ..." : "");
  };
  if (seams.joined > 0) note("seams", internal::WordsOfJoined(seams));
  std::sort(sizes.rbegin(), sizes.rend());
  std::vector<std::string> parts;
  for (int size : sizes) parts.push_back(std::to_string(size));
  note("components",
       "components (" + std::to_string(topology.components) + "), of vertices: " + list(parts));
  if (!topology.manifold) return;
  parts.clear();
  for (const std::vector<int>& loop : topology.boundary_loops) {
    double length = 0.0;
    for (size_t i = 0; i < loop.size(); ++i) {
      length +=
          (soup.vertices.col(loop[i]) - soup.vertices.col(loop[(i + 1) % loop.size()])).norm();
    }
    parts.push_back(std::to_string(loop.size()) + " edges of length " + Number(length));
  }
  note("boundary-loops", "boundary loops (" + std::to_string(parts.size()) + ")" +
                             (parts.empty() ? "" : ": " + list(parts)));
  note("genus", "genus " + std::to_string(topology.genus));
}

}  // namespace

namespace internal {

Findings CheckStructure(const Soup& soup) {
  Findings findings;
  auto fatal = [&](const char* kind, const std::string& what) {
    findings.push_back({Severity::kFatal, kind, FileName(soup) + ": " + what});
  };
  if (soup.NumVertices() == 0) fatal("no-vertices", "holds no vertices; export the mesh again");
  const std::vector<int>& begin = soup.polygon_begin;
  if (begin.empty() || begin.front() != 0 ||
      begin.back() != static_cast<int>(soup.corners.size()) ||
      !std::is_sorted(begin.begin(), begin.end())) {
    fatal("bad-structure", "polygon_begin does not rise from 0 to the number of corners");
    return findings;
  }
  if (soup.NumPolygons() == 0 && soup.segments.empty()) {
    fatal("no-elements",
          "holds no polygons and no segments; a point cloud has no element that a metric could "
          "measure, export it with its polygons");
  }
  Named few_corners, outside;
  for (int p = 0; p < soup.NumPolygons(); ++p) {
    if (begin[p + 1] - begin[p] < 3) few_corners.Add([&] { return PolygonName(soup, p); });
  }
  auto is_outside = [&](int v) { return v < 0 || v >= soup.NumVertices(); };
  for (int p = 0; p < soup.NumPolygons(); ++p) {
    for (int k = begin[p]; k < begin[p + 1]; ++k) {
      if (is_outside(soup.corners[k])) outside.Add([&] { return PolygonName(soup, p); });
    }
  }
  for (size_t s = 0; s < soup.segments.size(); ++s) {
    if (is_outside(soup.segments[s].first) || is_outside(soup.segments[s].second)) {
      outside.Add([&] { return SegmentName(soup, static_cast<int>(s)); });
    }
  }
  few_corners.Tell(soup, Severity::kFatal, "bad-structure", "polygons of fewer than three corners",
                   "take them out", &findings);
  outside.Tell(soup, Severity::kFatal, "index-out-of-range", "vertex indices that no vertex has",
               "correct the indices", &findings);
  return findings;
}

Findings CheckPositions(const Soup& soup) {
  Named not_finite, too_large, no_area, no_length;
  for (int v = 0; v < soup.NumVertices(); ++v) {
    const double largest = soup.vertices.col(v).cwiseAbs().maxCoeff();
    if (!soup.vertices.col(v).allFinite()) {
      not_finite.Add([&] { return VertexName(soup, v); });
    } else if (largest > kLargestCoordinate) {
      too_large.Add([&] { return VertexName(soup, v); });
    }
  }
  Findings findings;
  not_finite.Tell(soup, Severity::kFatal, "non-finite-coordinate",
                  "vertices with a coordinate that is not a finite number", "export the mesh again",
                  &findings);
  too_large.Tell(soup, Severity::kFatal, "coordinate-out-of-range",
                 "vertices with a coordinate beyond " + Number(kLargestCoordinate),
                 "choose another unit of length", &findings);
  if (!findings.empty()) return findings;
  const double extent =
      (soup.vertices.rowwise().maxCoeff() - soup.vertices.rowwise().minCoeff()).maxCoeff();
  if (extent > 0 && extent < 1 / kLargestCoordinate) {
    findings.push_back({Severity::kFatal, "coordinate-out-of-range",
                        FileName(soup) + ": the whole mesh is only " + Number(extent) +
                            " in size, less than " + Number(1 / kLargestCoordinate) +
                            "; choose another unit of length"});
    return findings;
  }

  for (int p = 0; p < soup.NumPolygons(); ++p) {
    const int begin = soup.polygon_begin[p], end = soup.polygon_begin[p + 1];
    const Eigen::Vector3d origin = soup.vertices.col(soup.corners[begin]);
    Eigen::Vector3d area = Eigen::Vector3d::Zero();
    double longest = 0.0, shortest = std::numeric_limits<double>::infinity();
    for (int k = begin; k < end; ++k) {
      const Eigen::Vector3d a = soup.vertices.col(soup.corners[k]) - origin;
      const Eigen::Vector3d b =
          soup.vertices.col(soup.corners[k + 1 == end ? begin : k + 1]) - origin;
      area += a.cross(b);
      longest = std::max(longest, (b - a).norm());
      shortest = std::min(shortest, (b - a).norm());
    }
    // About the rounding errors of double coordinates; valid thin triangles have more.
    constexpr double kNoArea = 1e-12;
    if (area.norm() <= kNoArea * longest * longest) {
      no_area.Add([&] { return PolygonName(soup, p); });
    }
    if (shortest == 0.0) no_length.Add([&] { return "a side of " + PolygonName(soup, p); });
  }
  for (size_t s = 0; s < soup.segments.size(); ++s) {
    const auto [a, b] = soup.segments[s];
    if (soup.vertices.col(a) == soup.vertices.col(b)) {
      no_length.Add([&] { return SegmentName(soup, static_cast<int>(s)); });
    }
  }
  no_length.Tell(soup, Severity::kWarning, "zero-length-edge",
                 "edges whose two ends are at the same position",
                 "merge these vertices in every pose, or expect wrinkles there", &findings);
  no_area.Tell(soup, Severity::kWarning, "zero-area", "polygons without area",
               "remesh there in every pose, or expect wrinkles there", &findings);
  return findings;
}

Findings CheckMesh(const Soup& soup) {
  Findings findings = CheckStructure(soup);
  if (!findings.empty()) return findings;
  findings = CheckPositions(soup);
  CheckDegenerate(soup, &findings);
  CheckRepeatedPolygons(soup, &findings);
  CheckManifold(soup, MakeSides(soup.NumVertices(), soup.polygon_begin, soup.corners), &findings);
  CheckUnreferenced(soup, &findings);
  SortBySeverity(&findings);
  return findings;
}

}  // namespace internal

Findings CheckSoup(const Soup& soup, bool open_seams) {
  Findings findings = internal::CheckMesh(soup);
  if (!findings.empty() && findings.front().severity == Severity::kFatal) return findings;
  Seams seams;
  if (!open_seams) seams = FindSeams(soup.polygon_begin, soup.corners, {soup.vertices});
  if (seams.unclear > 0) {
    findings.push_back({Severity::kWarning, "unclear-seam",
                        FileName(soup) + ": " + internal::WordsOfUnclear(seams)});
    internal::SortBySeverity(&findings);
  }
  DescribeTopology(soup, seams, &findings);
  return findings;
}

}  // namespace shapespace
