#include <shapespace/mesh/seams.h>

#include <algorithm>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include <shapespace/base/internal/sort_unique.h>
#include <shapespace/mesh/internal/sides.h>

namespace shapespace {
namespace {

using internal::Side;
using internal::Sides;
using internal::UnionFind;

// Vertices coincide if they are nearer to each other than this share of the longest edge beside
// them: programs write six digits or more.
constexpr double kCoincide = 1e-6;
// ... or than so many units in the last place of the largest coordinate, by which the same number
// may differ after it was transformed twice.
constexpr double kLastPlaces = 8 * std::numeric_limits<double>::epsilon();

/// A side of one polygon that no other polygon has, in the direction of its polygon.
struct Border {
  int tail, head, polygon;
};

std::vector<Border> FindBorders(const Sides& sides) {
  std::vector<Border> borders;
  for (int e = 0; e < sides.NumEdges(); ++e) {
    if (sides.Count(e) != 1) continue;
    const Side& side = sides.sides[sides.begin[e]];
    const auto [low, high] = sides.Ends(e);
    borders.push_back(side.ascending ? Border{low, high, side.polygon}
                                     : Border{high, low, side.polygon});
  }
  return borders;
}

/// Sorts vertices by place: those that coincide in all poses have the same.
class Places {
 public:
  // Only `vertices` may coincide with each other, each within its own `slack`.
  Places(const std::vector<Shape>& poses, std::vector<int> vertices, std::vector<double> slack)
      : poses_(poses), slack_(std::move(slack)), vertices_(std::move(vertices)) {
    for (const Shape& pose : poses) {
      rounding_.push_back(kLastPlaces * pose.cwiseAbs().maxCoeff());
    }
    place_.resize(slack_.size());
    std::iota(place_.begin(), place_.end(), 0);
    Split();
  }

  /// A vertex at the same place, the first of those: a number for the place.
  int Of(int vertex) const { return place_[vertex]; }
  /// By how much the same coordinate may differ in a pose.
  double Rounding(size_t pose) const { return rounding_[pose]; }

 private:
  // Vertices of a range that are apart in no coordinate of any pose are at one place; a range that
  // is not yet tried in all coordinates is split where it has gaps in the next one.
  void Split() {
    struct Range {
      size_t begin, end;
      int coordinate, whole;  // the next to be tried; those in which there was no gap
    };
    const int count = 3 * static_cast<int>(poses_.size());
    std::vector<Range> left = {{0, vertices_.size(), 0, 0}};
    while (!left.empty()) {
      const Range range = left.back();
      left.pop_back();
      const auto begin = vertices_.begin() + range.begin, end = vertices_.begin() + range.end;
      if (range.end - range.begin < 2) continue;
      if (range.whole == count) {
        const int first = *std::min_element(begin, end);
        for (auto v = begin; v != end; ++v) place_[*v] = first;
        continue;
      }
      const Shape& pose = poses_[range.coordinate / 3];
      const double rounding = rounding_[range.coordinate / 3];
      const auto low = [&](int v) { return pose(range.coordinate % 3, v) - slack_[v]; };
      const auto high = [&](int v) { return pose(range.coordinate % 3, v) + slack_[v] + rounding; };
      std::sort(begin, end, [&](int v, int w) {
        return std::make_pair(low(v), v) < std::make_pair(low(w), w);
      });
      const int next = (range.coordinate + 1) % count;
      size_t first = range.begin;
      double reach = high(vertices_[first]);
      for (size_t i = first + 1; i < range.end; ++i) {
        if (low(vertices_[i]) > reach) {
          left.push_back({first, i, next, 0});
          first = i;
        }
        reach = std::max(reach, high(vertices_[i]));
      }
      left.push_back({first, range.end, next, first == range.begin ? range.whole + 1 : 0});
    }
  }

  const std::vector<Shape>& poses_;
  const std::vector<double> slack_;
  std::vector<int> vertices_, place_;
  std::vector<double> rounding_;  // of each pose
};

class SeamFinder {
 public:
  SeamFinder(const std::vector<int>& polygon_begin, const std::vector<int>& corners,
             const std::vector<Shape>& poses)
      : begin_(polygon_begin),
        corners_(corners),
        poses_(poses),
        num_vertices_(static_cast<int>(poses[0].cols())),
        borders_(FindBorders(internal::MakeSides(num_vertices_, begin_, corners_))),
        places_(MakePlaces()),
        outline_(begin_.size(), -1),
        vertices_(num_vertices_) {}

  Seams Run() {
    if (borders_.empty()) return {};
    DescribePolygons();
    // By the places of their ends, so that those of one place follow each other.
    const auto ends = [&](const Border& border) {
      return std::pair<int, int>(std::minmax(Tail(border), Head(border)));
    };
    borders_.erase(std::remove_if(borders_.begin(), borders_.end(),
                                  [&](const Border& b) { return Tail(b) == Head(b); }),
                   borders_.end());
    std::stable_sort(borders_.begin(), borders_.end(),
                     [&](const Border& a, const Border& b) { return ends(a) < ends(b); });
    std::vector<std::vector<Border>> unclear;
    for (auto first = borders_.begin(), last = first; first != borders_.end(); first = last) {
      while (last != borders_.end() && ends(*last) == ends(*first)) ++last;
      if (last - first < 2) continue;
      const std::vector<Border> left = JoinAt({first, last});
      if (!left.empty()) unclear.push_back(left);
    }
    Seams seams;
    seams.representatives.resize(num_vertices_);
    for (int v = 0; v < num_vertices_; ++v) {
      seams.representatives[v] = vertices_.Find(v);
      seams.joined += seams.representatives[v] != v;
    }
    if (seams.joined == 0) seams.representatives.clear();
    // Borders beside them may have joined their ends.
    for (const std::vector<Border>& borders : unclear) seams.unclear += !AreJoined(borders);
    return seams;
  }

 private:
  int Tail(const Border& border) const { return places_.Of(border.tail); }
  int Head(const Border& border) const { return places_.Of(border.head); }

  template <typename Use>
  void ForCorners(int polygon, const Use& use) const {
    for (int k = begin_[polygon]; k < begin_[polygon + 1]; ++k) use(corners_[k]);
  }

  // Corners of polygons at borders may coincide with others, within a share of the longest side
  // that any of these polygons has there.
  Places MakePlaces() const {
    std::vector<char> is_at_border(begin_.size(), 0);
    for (const Border& border : borders_) is_at_border[border.polygon] = 1;
    std::vector<double> slack(num_vertices_, 0);
    std::vector<char> is_corner(num_vertices_, 0);
    for (size_t p = 0; p + 1 < begin_.size(); ++p) {
      if (!is_at_border[p]) continue;
      for (int k = begin_[p]; k < begin_[p + 1]; ++k) {
        const int v = corners_[k], w = corners_[k + 1 == begin_[p + 1] ? begin_[p] : k + 1];
        const double share = kCoincide / 2 * LongestLength(v, w);
        for (const int end : {v, w}) slack[end] = std::max(slack[end], share);
        is_corner[v] = 1;
      }
    }
    std::vector<int> vertices;
    for (int v = 0; v < num_vertices_; ++v) {
      if (is_corner[v]) vertices.push_back(v);
    }
    return {poses_, std::move(vertices), std::move(slack)};
  }

  double LongestLength(int v, int w) const {
    double longest = 0;
    for (const Shape& pose : poses_) {
      longest = std::max(longest, (pose.col(w) - pose.col(v)).norm());
    }
    return longest;
  }

  // Numbers the outlines of polygons at borders, sets of places, and finds the polygons that have
  // two different corners at one place.
  void DescribePolygons() {
    std::vector<char> is_at_border(begin_.size(), 0);
    for (const Border& border : borders_) is_at_border[border.polygon] = 1;
    std::map<std::vector<int>, int> numbers;
    std::vector<std::pair<int, int>> at;  // place and vertex
    std::vector<int> outline;
    for (int p = 0; p + 1 < static_cast<int>(begin_.size()); ++p) {
      at.clear();
      outline.clear();
      ForCorners(p, [&](int v) { at.emplace_back(places_.Of(v), v); });
      std::sort(at.begin(), at.end());
      for (size_t i = 0; i < at.size(); ++i) {
        outline.push_back(at[i].first);
        if (i > 0 && at[i].first == at[i - 1].first && at[i].second != at[i - 1].second) {
          doubled_[at[i].first].push_back(p);
          collapsed_.insert(p);
        }
      }
      if (!is_at_border[p]) continue;
      const int next = static_cast<int>(numbers.size());
      outline_[p] = numbers.try_emplace(outline, next).first->second;
    }
  }

  // Joins those of the borders at one place that continue each other. Returns those of which it
  // remains unclear which do.
  std::vector<Border> JoinAt(const std::vector<Border>& here) {
    // A polygon whose corners coincide lies between others like a thread; it follows them.
    std::vector<Border> whole, threads;
    for (const Border& border : here) {
      (collapsed_.count(border.polygon) > 0 ? threads : whole).push_back(border);
    }
    if (whole.empty()) std::swap(whole, threads);
    // Of each direction, those of one outline together: none of them continues another.
    std::map<int, std::vector<Border>> ways[2];
    for (const Border& border : whole) {
      ways[Tail(border) > Head(border)][outline_[border.polygon]].push_back(border);
    }
    std::set<const Border*> joined;
    for (const auto& [outline, forth] : ways[0]) {
      const Border* const other = OnlyOther(ways[1], outline);
      if (forth.size() == 1 && other != nullptr &&
          OnlyOther(ways[0], outline_[other->polygon]) == &forth[0] && Coincide(forth[0], *other)) {
        Join(forth[0], *other);
        joined.insert({&forth[0], other});
      }
    }
    if (!threads.empty() && AreJoined(whole)) {
      for (const Border& thread : threads) JoinAlong(thread, whole[0]);
    }
    // Nothing is unclear about polygons that cover each other, as the two sides of a sheet do.
    std::set<int> left;
    for (const auto& way : ways) {
      for (const auto& [outline, borders] : way) {
        if (joined.count(&borders[0]) == 0) left.insert(outline);
      }
    }
    return left.size() > 1 ? whole : std::vector<Border>();
  }

  // The one border whose polygon has another outline; null if there is none, or more than one.
  static const Border* OnlyOther(const std::map<int, std::vector<Border>>& way, int outline) {
    const Border* found = nullptr;
    for (const auto& [other, borders] : way) {
      if (other == outline) continue;
      if (found != nullptr || borders.size() > 1) return nullptr;
      found = &borders[0];
    }
    return found;
  }

  // Whether borders of opposite directions are nearer to each other than others beside them need
  // be.
  bool Coincide(const Border& border, const Border& opposite) const {
    const double near = kCoincide * LongestLength(border.tail, border.head);
    for (size_t i = 0; i < poses_.size(); ++i) {
      const auto apart = [&](int v, int w) { return (poses_[i].col(w) - poses_[i].col(v)).norm(); };
      const double most = near + 2 * places_.Rounding(i);
      if (apart(border.tail, opposite.head) > most || apart(border.head, opposite.tail) > most) {
        return false;
      }
    }
    return true;
  }

  bool AreJoined(const std::vector<Border>& borders) {
    const Border& first = borders[0];
    return std::all_of(borders.begin(), borders.end(), [&](const Border& border) {
      const bool along = Tail(border) == Tail(first);
      return vertices_.Find(border.tail) == vertices_.Find(along ? first.tail : first.head) &&
             vertices_.Find(border.head) == vertices_.Find(along ? first.head : first.tail);
    });
  }

  void JoinAlong(const Border& border, const Border& other) {
    const bool along = Tail(border) == Tail(other);
    Join(border.tail, along ? other.tail : other.head);
    Join(border.head, along ? other.head : other.tail);
  }

  void Join(const Border& border, const Border& opposite) {
    Join(border.tail, opposite.head);
    Join(border.head, opposite.tail);
  }

  // Joins two vertices unless a polygon would have the result at two corners.
  void Join(int v, int w) {
    const int a = vertices_.Find(v), b = vertices_.Find(w);
    const auto found = doubled_.find(places_.Of(v));
    if (a != b && found != doubled_.end()) {
      for (const int polygon : found->second) {
        bool has_a = false, has_b = false;
        ForCorners(polygon, [&](int corner) {
          has_a = has_a || vertices_.Find(corner) == a;
          has_b = has_b || vertices_.Find(corner) == b;
        });
        if (has_a && has_b) return;
      }
    }
    vertices_.Join(a, b);
  }

  const std::vector<int>&begin_, &corners_;
  const std::vector<Shape>& poses_;
  const int num_vertices_;
  std::vector<Border> borders_;
  const Places places_;
  std::vector<int> outline_;                 // of each polygon at a border
  std::set<int> collapsed_;                  // polygons with two corners at one place
  std::map<int, std::vector<int>> doubled_;  // the same by that place
  UnionFind vertices_;
};

}  // namespace

Seams FindSeams(const std::vector<int>& polygon_begin, const std::vector<int>& corners,
                const std::vector<Shape>& poses) {
  return SeamFinder(polygon_begin, corners, poses).Run();
}

std::vector<int> RepresentativesOf(const Connectivity& connectivity,
                                   const std::vector<int>& vertices) {
  if (connectivity.Twins().empty()) return vertices;
  std::vector<int> result;
  for (const int v : vertices) result.push_back(connectivity.Representative(v));
  internal::SortUnique(&result);
  return result;
}

int CountParted(const Connectivity& connectivity, const Shape& shape) {
  const double extent = (shape.rowwise().maxCoeff() - shape.rowwise().minCoeff()).maxCoeff();
  int count = 0;
  for (const int twin : connectivity.Twins()) {
    const Eigen::Vector3d way = shape.col(twin) - shape.col(connectivity.Representative(twin));
    count += way.norm() > kCoincide * extent;
  }
  return count;
}

}  // namespace shapespace
