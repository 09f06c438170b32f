#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include <shapespace/base/internal/sort_unique.h>
#include <shapespace/mesh/check.h>
#include <shapespace/mesh/detail/recut.h>
#include <shapespace/mesh/detail/sorted_polygons.h>
#include <shapespace/mesh/internal/check_structure.h>
#include <shapespace/mesh/internal/check_words.h>
#include <shapespace/mesh/internal/sides.h>
#include <shapespace/mesh/internal/surface_triangles.h>
#include <shapespace/mesh/mirrored.h>
#include <shapespace/mesh/volume.h>

namespace shapespace {
namespace {

using internal::FileName;
using internal::Named;
using internal::Number;
using internal::PolygonName;
using internal::SegmentName;
using internal::Sides;
using internal::SortedPolygons;
using internal::UnionFind;
using internal::VertexName;

using Findings = std::vector<Finding>;

constexpr char kKeepOrder[] =
    "export all poses from one mesh with 'keep vertex order' switched on, and with welding, "
    "triangulation and mesh optimisation switched off";

constexpr char kCutOnce[] =
    "export the polygons of all poses uncut, with triangulation switched off, or cut the mesh into "
    "triangles once, before it is posed";

double Median(std::vector<double> values) {
  const auto middle = values.begin() + values.size() / 2;
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Compares a pose with the reference and appends to `findings`.
class Comparison {
 public:
  Comparison(const Soup& reference, const Soup& pose, Findings* findings)
      : reference_(reference), pose_(pose), findings_(findings) {}

  void Run() {
    if (!CountsAgree() || !PolygonsAgree() || !SegmentsAgree()) return;
    if (!reference_.vertices.allFinite() || !pose_.vertices.allFinite()) return;
    CompareOrientations();
    CompareLengths();
  }

 private:
  void Tell(Severity severity, const char* kind, const std::string& what,
            const std::string& option = {}) {
    findings_->push_back({severity, kind,
                          FileName(pose_) + " against " + FileName(reference_) + ": " + what,
                          option});
  }

  // Marks the findings so far, of two surfaces.
  void MarkAsDifferentMeshes() {
    for (Finding& finding : *findings_) {
      finding.different_meshes = reference_.NumPolygons() > 0 && pose_.NumPolygons() > 0;
    }
  }

  bool CountsAgree() {
    bool agree = true;
    const int recut = pose_.NumVertices() == reference_.NumVertices() &&
                              pose_.NumPolygons() != reference_.NumPolygons()
                          ? internal::CountRecutPolygons(reference_, pose_)
                          : 0;
    if (recut > 0) {
      Tell(Severity::kFatal, "polygon-count",
           std::to_string(pose_.NumPolygons()) + " polygons instead of " +
               std::to_string(reference_.NumPolygons()) + "; " + Recut(recut));
      return false;
    }
    auto compare = [&](size_t count, size_t wanted, const char* kind, const std::string& what) {
      if (count == wanted) return;
      agree = false;
      Tell(Severity::kFatal, kind,
           std::to_string(count) + " " + what + " instead of " + std::to_string(wanted) +
               "; these are not poses of one mesh: " + kKeepOrder);
    };
    compare(pose_.NumVertices(), reference_.NumVertices(), "vertex-count", "vertices");
    compare(pose_.NumPolygons(), reference_.NumPolygons(), "polygon-count", "polygons");
    if (!agree) MarkAsDifferentMeshes();
    compare(pose_.segments.size(), reference_.segments.size(), "segment-count", "segments");
    return agree;
  }

  /// Polygons that differ only in the first corner of their list and in orientation get the same
  /// key; of the two sides of a double-sided polygon the one that was not reversed comes first.
  static SortedPolygons Canonical(const Soup& soup, std::vector<bool>* turned) {
    turned->assign(soup.NumPolygons(), false);
    using Iterator = std::vector<int>::iterator;
    SortedPolygons sorted(soup, [turned](int p, Iterator first, Iterator last) {
      std::rotate(first, std::min_element(first, last), last);
      if (*(first + 1) > *(last - 1)) {
        std::reverse(first + 1, last);
        (*turned)[p] = true;
      }
    });
    for (auto first = sorted.order.begin(), last = first; first != sorted.order.end();
         first = last) {
      while (last != sorted.order.end() && SameKey(sorted, *first, sorted, *last)) ++last;
      std::stable_partition(first, last, [turned](int p) { return !(*turned)[p]; });
    }
    return sorted;
  }

  bool PolygonsAgree() {
    if (reference_.polygon_begin == pose_.polygon_begin && reference_.corners == pose_.corners) {
      return true;
    }
    std::vector<bool> reference_turned, pose_turned;
    SortedPolygons reference = Canonical(reference_, &reference_turned);
    SortedPolygons pose = Canonical(pose_, &pose_turned);
    bool same = true;
    Named wound;
    for (int i = 0; i < reference_.NumPolygons() && same; ++i) {
      const int p = reference.order[i], q = pose.order[i];
      same = SameKey(reference, p, pose, q);
      if (reference_turned[p] != pose_turned[q]) {
        wound.Add([&] { return PolygonName(pose_, q); });
      }
    }
    if (!same) {
      int p = 0;
      while (SameKey(reference, p, pose, p)) ++p;
      const int recut = internal::CountRecutPolygons(reference_, pose_);
      Tell(Severity::kFatal, "polygons-differ",
           "the first polygon that differs is " + PolygonName(pose_, p) + " with vertices " +
               Corners(pose_, p) + ", where the reference has " + PolygonName(reference_, p) +
               " with " + Corners(reference_, p) + "; " +
               (recut > 0 ? Recut(recut) : WhyVerticesDiffer() + ": " + kKeepOrder));
      if (recut == 0) MarkAsDifferentMeshes();
      return false;
    }
    if (wound.Count() == 0) {
      Tell(Severity::kWarning, "polygon-order",
           std::string("the same polygons are in another order or begin at other corners; the "
                       "reference's are used. If the result looks wrong, ") +
               kKeepOrder);
    } else {
      Tell(Severity::kWarning, "polygon-winding",
           "the same polygons, but with reversed orientation (" + std::to_string(wound.Count()) +
               "): " + wound.Names() +
               "; the reference's are used. If the pose is a mirror image, "
               "export both in the same coordinate system");
    }
    return true;
  }

  static std::string Corners(const Soup& soup, int p) {
    constexpr int kMaxNamed = 8;
    const int begin = soup.polygon_begin[p], end = soup.polygon_begin[p + 1];
    std::string result;
    for (int k = begin; k < std::min(end, begin + kMaxNamed); ++k) {
      result += (k > begin ? " " : "") + std::to_string(soup.corners[k] + 1);
    }
    return result + (end - begin > kMaxNamed ? " ..." : "");
  }

  static std::string Recut(int polygons) {
    return "the vertices and their polygons are the same, but polygons are cut along other "
           "diagonals, or not cut in one of the two (" +
           std::to_string(polygons) + "): " + kCutOnce;
  }

  std::string WhyVerticesDiffer() const {
    const int n = reference_.NumVertices();
    // Checks whether the lists of polygons are equal up to a renumbering of vertices.
    if (reference_.polygon_begin == pose_.polygon_begin) {
      std::vector<int> to(n, -1), from(n, -1);
      bool renumbered = true;
      for (size_t k = 0; k < reference_.corners.size() && renumbered; ++k) {
        const int a = reference_.corners[k], b = pose_.corners[k];
        if (to[a] < 0 && from[b] < 0) {
          to[a] = b;
          from[b] = a;
        }
        renumbered = to[a] == b;  // then from[b] == a, as both are set together
      }
      if (renumbered) {
        int v = 0;
        while (to[v] < 0 || to[v] == v) ++v;
        return "the polygons are in the same order, but the vertices are not (the "
               "reference's vertex " +
               std::to_string(v + 1) + " is number " + std::to_string(to[v] + 1) + " here)";
      }
    }
    // After any renumbering, the numbers of polygons at the vertices are the same up to order.
    auto valences = [n](const Soup& soup) {
      std::vector<int> count(n, 0);
      for (int v : soup.corners) ++count[v];
      std::sort(count.begin(), count.end());
      return count;
    };
    return valences(reference_) == valences(pose_)
               ? "it looks like the same mesh with its vertices in another order"
               : "these are different meshes, or one of them was changed";
  }

  bool SegmentsAgree() {
    auto sorted = [](const Soup& soup) {
      std::vector<std::pair<int, int>> segments;
      for (const auto& [a, b] : soup.segments) segments.emplace_back(std::minmax(a, b));
      std::sort(segments.begin(), segments.end());
      return segments;
    };
    if (sorted(reference_) == sorted(pose_)) return true;
    int s = 0;
    while (std::minmax(reference_.segments[s].first, reference_.segments[s].second) ==
           std::minmax(pose_.segments[s].first, pose_.segments[s].second)) {
      ++s;
    }
    Tell(Severity::kFatal, "segments-differ",
         "the first segment that differs is " + SegmentName(pose_, s) +
             ", where the reference has " + SegmentName(reference_, s) + "; " + kKeepOrder);
    return false;
  }

  void CompareOrientations() {
    const Eigen::Matrix3Xi triangles = internal::SurfaceTriangles(reference_, pose_);
    if (IsMirrored(triangles, reference_.vertices, pose_.vertices)) {
      Tell(Severity::kMirrored, "mirrored",
           "the body is a mirror image of the reference: what bulges to one side of the surface "
           "there bulges to the other here; export both in the same coordinate system, or have one "
           "coordinate flipped. If it was turned over on purpose, say so by allow_mirrored",
           "mirror");
    } else if (IsInsideOut(triangles, reference_.vertices, pose_.vertices)) {
      Tell(Severity::kWarning, "inside-out",
           "the body encloses its volume from the other side, but is no mirror image of the "
           "reference: a part of it is turned inside out, and will pass through itself");
    }
  }

  /// Root mean square distance from the centroid, over the vertices that have edges.
  static double Radius(const Soup& soup, const std::vector<int>& vertices) {
    Eigen::Vector3d centre = Eigen::Vector3d::Zero();
    for (int v : vertices) centre += soup.vertices.col(v) / vertices.size();
    double sum = 0.0;
    for (int v : vertices) sum += (soup.vertices.col(v) - centre).squaredNorm() / vertices.size();
    return std::sqrt(sum);
  }

  void CompareLengths() {
    std::vector<std::pair<int, int>> edges;
    const Sides sides =
        internal::MakeSides(reference_.NumVertices(), reference_.polygon_begin, reference_.corners);
    for (int e = 0; e < sides.NumEdges(); ++e) edges.push_back(sides.Ends(e));
    edges.insert(edges.end(), reference_.segments.begin(), reference_.segments.end());
    if (edges.empty()) return;

    auto lengths = [&edges](const Soup& soup) {
      std::vector<double> result;
      for (const auto& [a, b] : edges) {
        result.push_back((soup.vertices.col(a) - soup.vertices.col(b)).norm());
      }
      return result;
    };
    std::vector<double> before = lengths(reference_), stretch = lengths(pose_);
    // The limit keeps the stretch of a collapsed sliver finite.
    constexpr double kShortest = 1e-6;
    const double least_before = kShortest * Median(before), least = kShortest * Median(stretch);
    if (!(least_before > 0.0) || !(least > 0.0)) return;  // a mesh shrunk to points: told elsewhere
    for (size_t e = 0; e < edges.size(); ++e) {
      stretch[e] = std::log(std::max(stretch[e], least) / std::max(before[e], least_before));
    }
    const double scale = Median(stretch);
    for (double& s : stretch) s -= scale;

    std::vector<int> vertices;
    for (const auto& [a, b] : edges) vertices.insert(vertices.end(), {a, b});
    internal::SortUnique(&vertices);
    const double growth = Radius(pose_, vertices) / Radius(reference_, vertices);
    if (CheckScrambled(stretch, scale, growth)) return;
    CheckScale(scale);
    CheckGroups(edges, stretch, vertices);
  }

  /// Detects meshes in which most vertices are in a wrong order: edges have become longer, but the
  /// body has not, and the ratios vary. (If a sheet is rolled up isometrically, the body shrinks
  /// too, but all ratios agree.) Measurements: correct pairs have a factor below 1.5 and a spread
  /// below 0.09.
  bool CheckScrambled(const std::vector<double>& stretch, double scale, double growth) {
    constexpr double kFactor = 4.0, kSpread = 0.25;
    std::vector<double> deviation;
    for (double s : stretch) deviation.push_back(std::abs(s));
    const double factor = std::exp(std::abs(scale - std::log(growth)));
    if (!(factor > kFactor) || Median(deviation) < kSpread) return false;
    Tell(Severity::kDoubtful, "vertex-order",
         "the edges are " + Number(factor) +
             " times as long against the whole as in the reference; most vertices are probably "
             "in another order, although the counts agree: " +
             kKeepOrder + ". If the pose is right, say so by allow_mismatch",
         "allow_mismatch");
    return true;
  }

  void CheckScale(double scale) {
    // Poses may grow; but centimetres are 10 millimetres, and a foot is 12 inches.
    constexpr double kOtherUnits = 2.0, kSurelyOtherUnits = 8.0;
    if (std::abs(scale) < std::log(kOtherUnits)) return;
    const bool surely = std::abs(scale) > std::log(kSurelyOtherUnits);
    Tell(surely ? Severity::kDoubtful : Severity::kWarning, "other-units",
         "the edges are " + Number(std::exp(scale)) +
             " times as long as the reference's; if the units differ, scale one of the files" +
             (surely ? ". If the pose is right, say so by allow_mismatch" : ""),
         surely ? "allow_mismatch" : "");
  }

  /// Detects connected vertices at each of which most edges are strongly stretched or shrunk.
  /// Measurements: in 39 correct pairs of poses slivers cause at most 2 such neighbours; about 140
  /// vertices in a wrong order cause 176 in three groups, the largest of 67.
  void CheckGroups(const std::vector<std::pair<int, int>>& edges,
                   const std::vector<double>& stretch, const std::vector<int>& vertices) {
    constexpr double kFar = 5.0;
    constexpr int kMinVertices = 8;
    const int n = reference_.NumVertices();
    std::vector<std::vector<double>> around(n);
    for (size_t e = 0; e < edges.size(); ++e) {
      around[edges[e].first].push_back(stretch[e]);
      around[edges[e].second].push_back(stretch[e]);
    }
    std::vector<double> factor(n, 1.0);
    for (int v : vertices) factor[v] = std::exp(std::abs(Median(around[v])));
    UnionFind groups(n);
    for (const auto& [a, b] : edges) {
      if (factor[a] > kFar && factor[b] > kFar) groups.Join(a, b);
    }
    std::vector<int> size(n, 0);
    for (int v : vertices) ++size[groups.Find(v)];
    int count = 0;
    double largest = 0.0;
    Named members;
    for (int v : vertices) {
      const int root = groups.Find(v);
      if (size[root] < kMinVertices) continue;
      count += v == root;
      largest = std::max(largest, factor[v]);
      members.Add([&] { return VertexName(pose_, v); });
    }
    if (count == 0) return;
    Tell(Severity::kWarning, "vertex-order",
         "vertices whose edges stretch or shrink together, up to " + Number(largest) + " times (" +
             std::to_string(members.Count()) + " in groups: " + std::to_string(count) +
             "): " + members.Names() +
             "; they are probably in another order than in the reference, although the counts "
             "agree: " +
             kKeepOrder);
  }

  const Soup& reference_;
  const Soup& pose_;
  Findings* findings_;
};

}  // namespace

Findings CheckSameMesh(const Soup& reference, const Soup& pose) {
  for (const Soup* soup : {&reference, &pose}) {
    Findings findings = internal::CheckStructure(*soup);
    if (!findings.empty()) return findings;
  }
  Findings findings;
  Comparison(reference, pose, &findings).Run();
  internal::SortBySeverity(&findings);
  return findings;
}

}  // namespace shapespace
