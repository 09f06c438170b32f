#include <shapespace/mesh/ties.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <unordered_set>

#include <Eigen/Eigenvalues>

#include <shapespace/base/parallel.h>
#include <shapespace/mesh/detail/element_tree.h>
#include <shapespace/mesh/internal/sides.h>

namespace shapespace {
namespace {

using Edge = std::pair<int, int>;
using internal::ElementTree;

// Components are near each other if their distance is at most this share of the smaller one's
// extent: a bracelet that hangs loosely from an arm has an eighth of its own. Points of a component
// serve if they are by as much farther away than its nearest one.
constexpr double kNear = 0.2;
// Of several that are near, the largest is taken that is not farther than the nearest one by this
// factor and this share of the extent.
constexpr double kAsNear = 2, kAsNearShare = 0.02;
// Distances are alike if they differ by at most this share of the radius of the place to which a
// point is tied. Less would leave clothes loose; more would tie what slides.
constexpr double kAlike = 0.25;
// Points of a component from which others are looked for, and how many of these each may find.
constexpr int kProbes = 32, kNeighbours = 3;
// Points of a component that may serve, points that are tried until enough do, and how many are
// enough; vertices to which each is tied.
constexpr int kCandidates = 512, kTried = 24, kPoints = 6, kTargets = 3;
// Points whose second principal extent is less than this share of the first are on a line, about
// which a component could turn.
constexpr double kOnLine = 0.1;
// Least radius of the place to which a point is tied, as a share of its component's extent: where a
// fine surface is touched, distances to the nearest vertices would say little.
constexpr double kPlace = 0.1;
// Vertices of a place at most: a disc of 30 edges across.
constexpr int kMostAround = 1000;
// Distances that differ by this share are equal, so that rounding does not choose.
constexpr double kEqual = 1e-6;

double Distance(const Shape& shape, int v, int w) { return (shape.col(v) - shape.col(w)).norm(); }

// Draws vertices of a list one after the other, each of them as far as possible from those drawn
// before and from one further point; of equally far ones the first.
class FarthestPoints {
 public:
  FarthestPoints(const Shape& shape, const std::vector<int>& vertices, const Eigen::Vector3d& from)
      : shape_(shape),
        vertices_(vertices),
        squared_(vertices.size(), std::numeric_limits<double>::infinity()) {
    KeepAwayFrom(from);
  }

  // -1 if there is none at another place.
  int Draw() {
    const double most = *std::max_element(squared_.begin(), squared_.end());
    if (!(most > 0)) return -1;
    const auto first = std::find_if(squared_.begin(), squared_.end(),
                                    [&](double squared) { return squared >= (1 - kEqual) * most; });
    const int v = vertices_[first - squared_.begin()];
    KeepAwayFrom(shape_.col(v));
    return v;
  }

 private:
  void KeepAwayFrom(const Eigen::Vector3d& point) {
    for (size_t i = 0; i < squared_.size(); ++i) {
      squared_[i] = std::min(squared_[i], (shape_.col(vertices_[i]) - point).squaredNorm());
    }
  }

  const Shape& shape_;
  const std::vector<int>& vertices_;
  std::vector<double> squared_;
};

struct Component {
  std::vector<int> vertices;
  Eigen::Vector3d centre = Eigen::Vector3d::Zero();
  double extent = 0;  // twice the largest distance from the centre
};

// Two components that are near each other in the pose that is searched.
struct ComponentPair {
  int child, parent;  // the smaller and the larger one
  double distance;    // in extents of the child
};

class TieSearch {
 public:
  TieSearch(const Connectivity& connectivity, const std::vector<Shape>& poses)
      : connectivity_(connectivity) {
    NumberComponents();
    if (components_.size() < 2) return;
    shapes_.resize(poses.size());
    ParallelFor(static_cast<int>(poses.size()), [&](int i) { shapes_[i] = Normalised(poses[i]); });
    // The pose that is spread most, in which parts that only pass by are far away.
    std::vector<double> spread;
    for (const Shape& shape : shapes_) spread.push_back(shape.squaredNorm());
    const double most = *std::max_element(spread.begin(), spread.end());
    searched_ = static_cast<int>(std::find_if(spread.begin(), spread.end(),
                                              [&](double s) { return s >= (1 - kEqual) * most; }) -
                                 spread.begin());
    for (Component& component : components_) Measure(&component);
    RankComponents();
  }

  Ties Run() const {
    Ties ties;
    if (components_.size() < 2) return ties;
    const ElementTree tree(connectivity_, shapes_[searched_], component_);
    std::vector<ComponentPair> pairs = PairsNear(tree);
    const std::vector<char> first_choice = TakeFirstChoices(&pairs);
    // Each child's first, on all threads; others are seldom needed.
    std::vector<std::vector<Edge>> found(pairs.size());
    std::vector<char> tried(pairs.size(), 0);
    std::vector<int> favourites;
    std::vector<char> has_favourite(components_.size(), 0);
    for (size_t i = 0; i < pairs.size(); ++i) {
      if (!first_choice[i] || has_favourite[pairs[i].child]) continue;
      has_favourite[pairs[i].child] = 1;
      favourites.push_back(static_cast<int>(i));
    }
    ParallelFor(static_cast<int>(favourites.size()), [&](int k) {
      const int i = favourites[k];
      found[i] = TiesOf(pairs[i], tree);
      tried[i] = 1;
    });

    internal::UnionFind trees(static_cast<int>(components_.size()));
    std::vector<char> is_tied(components_.size(), 0), is_near(components_.size(), 0);
    const auto take = [&](size_t i) {
      const auto& [child, parent, distance] = pairs[i];
      is_near[child] = 1;
      if (trees.Find(child) == trees.Find(parent)) return;
      if (!tried[i]) found[i] = TiesOf(pairs[i], tree);
      if (found[i].empty()) return;
      ties.stiffeners.insert(ties.stiffeners.end(), found[i].begin(), found[i].end());
      trees.Join(child, parent);
      ++ties.tied;
      is_tied[child] = is_tied[parent] = 1;
    };
    for (size_t i = 0; i < pairs.size(); ++i) {
      if (first_choice[i]) take(i);
    }
    for (size_t i = 0; i < pairs.size(); ++i) {
      if (!first_choice[i] && !is_tied[pairs[i].child]) take(i);
    }
    for (size_t c = 0; c < components_.size(); ++c) {
      if (is_near[c] && !is_tied[c]) ++ties.loose;
    }
    std::sort(ties.stiffeners.begin(), ties.stiffeners.end());
    return ties;
  }

 private:
  void NumberComponents() {
    const int num_vertices = connectivity_.NumVertices();
    internal::UnionFind pieces(num_vertices);
    std::vector<char> used(num_vertices, 0);
    for (const auto& edge : connectivity_.Edges().colwise()) {
      pieces.Join(edge(0), edge(1));
      used[edge(0)] = used[edge(1)] = 1;
    }
    component_.assign(num_vertices, -1);
    for (int v = 0; v < num_vertices; ++v) {
      if (!used[v]) continue;
      int& root = component_[pieces.Find(v)];  // not greater than v
      if (root < 0) {
        root = static_cast<int>(components_.size());
        components_.emplace_back();
      }
      component_[v] = root;
      components_[root].vertices.push_back(v);
    }
  }

  // Centred, with edges of length 1 in the root mean square.
  Shape Normalised(const Shape& pose) const {
    const double largest = pose.cwiseAbs().maxCoeff();
    Shape shape = largest > 0 ? Shape(pose / largest) : pose;
    const Eigen::Vector3d mean = shape.rowwise().mean();
    shape.colwise() -= mean;
    double sum = 0;
    for (const auto& edge : connectivity_.Edges().colwise()) {
      sum += (shape.col(edge(1)) - shape.col(edge(0))).squaredNorm();
    }
    const double length = std::sqrt(sum / connectivity_.NumEdges());
    return length > 0 ? Shape(shape / length) : shape;
  }

  void Measure(Component* component) const {
    const Shape& shape = shapes_[searched_];
    for (const int v : component->vertices) component->centre += shape.col(v);
    component->centre /= static_cast<double>(component->vertices.size());
    for (const int v : component->vertices) {
      component->extent =
          std::max(component->extent, 2 * (shape.col(v) - component->centre).norm());
    }
  }

  // By extent; of equally large components the first counts as the largest.
  void RankComponents() {
    const auto extent = [&](int c) { return components_[c].extent; };
    std::vector<int> order(components_.size());
    std::iota(order.begin(), order.end(), 0);
    std::sort(order.begin(), order.end(), [&](int c, int d) {
      return extent(c) < extent(d) || (extent(c) == extent(d) && c > d);
    });
    for (auto begin = order.begin(); begin != order.end();) {
      const auto end = std::find_if(
          begin, order.end(), [&](int c) { return extent(c) > (1 + kEqual) * extent(*begin); });
      std::sort(begin, end, std::greater<>());
      begin = end;
    }
    rank_.resize(order.size());
    for (size_t i = 0; i < order.size(); ++i) rank_[order[i]] = static_cast<int>(i);
  }

  bool IsSmaller(int c, int d) const { return rank_[c] < rank_[d]; }

  // All pairs of components that are near each other, each once.
  std::vector<ComponentPair> PairsNear(const ElementTree& tree) const {
    std::vector<std::vector<ComponentPair>> of_component(components_.size());
    ParallelFor(static_cast<int>(components_.size()), [&](int c) {
      const Component& from = components_[c];
      const Shape& shape = shapes_[searched_];
      FarthestPoints points(shape, from.vertices, from.centre);
      for (int k = 0; k < kProbes; ++k) {
        const int v = points.Draw();
        if (v < 0) break;
        std::vector<int> seen = {c};
        for (int n = 0; n < kNeighbours; ++n) {
          const ElementTree::Nearest nearest = tree.Find(
              shape.col(v), kNear * from.extent,
              [&](int d) { return std::find(seen.begin(), seen.end(), d) == seen.end(); });
          const int d = nearest.component;
          if (d < 0) break;
          seen.push_back(d);
          const bool is_child = IsSmaller(c, d);
          const int child = is_child ? c : d;
          const double share = nearest.distance / components_[child].extent;
          if (share <= kNear) of_component[c].push_back({child, is_child ? d : c, share});
        }
      }
    });
    std::map<Edge, double> nearest;
    for (const std::vector<ComponentPair>& list : of_component) {
      for (const auto& [child, parent, distance] : list) {
        double& least = nearest.try_emplace({child, parent}, distance).first->second;
        least = std::min(least, distance);
      }
    }
    std::vector<ComponentPair> pairs;
    for (const auto& [ends, distance] : nearest) {
      pairs.push_back({ends.first, ends.second, distance});
    }
    return pairs;
  }

  // Sorts the pairs: those that are about as near as their child's nearest one, for which 1 is
  // returned, by the size of the parent; and the others by distance.
  std::vector<char> TakeFirstChoices(std::vector<ComponentPair>* pairs) const {
    std::vector<double> least(components_.size(), std::numeric_limits<double>::infinity());
    for (const ComponentPair& pair : *pairs) {
      least[pair.child] = std::min(least[pair.child], pair.distance);
    }
    const auto end =
        std::stable_partition(pairs->begin(), pairs->end(), [&](const ComponentPair& pair) {
          return pair.distance <= kAsNear * least[pair.child] + kAsNearShare;
        });
    std::stable_sort(pairs->begin(), end, [&](const ComponentPair& a, const ComponentPair& b) {
      return a.parent != b.parent ? IsSmaller(b.parent, a.parent) : a.distance < b.distance;
    });
    std::stable_sort(end, pairs->end(), [](const ComponentPair& a, const ComponentPair& b) {
      return a.distance < b.distance;
    });
    std::vector<char> is_first(pairs->size(), 0);
    std::fill_n(is_first.begin(), end - pairs->begin(), 1);
    return is_first;
  }

  // Whether the distance of two vertices is alike in all poses, up to a share of `radius`.
  bool IsAlike(int v, int w, double radius) const {
    double low = std::numeric_limits<double>::infinity(), high = 0;
    for (const Shape& shape : shapes_) {
      const double distance = Distance(shape, v, w);
      low = std::min(low, distance);
      high = std::max(high, distance);
    }
    return high - low <= kAlike * radius;
  }

  // A vertex of the child with the nearest place on the parent.
  struct Candidate {
    int vertex, target;  // the corner of the nearest element that is nearest
    double distance;
  };

  // Those that are not farther than the child's extent, and whose distances to the nearest element
  // stay alike.
  std::vector<Candidate> CandidatesOf(const ComponentPair& pair, const ElementTree& tree) const {
    const Shape& shape = shapes_[searched_];
    const Component& child = components_[pair.child];
    const int count = static_cast<int>(child.vertices.size());
    const int stride = (count + kCandidates - 1) / kCandidates;
    std::vector<Candidate> candidates;
    for (int i = 0; i < count; i += stride) {
      const int v = child.vertices[i];
      const ElementTree::Nearest nearest =
          tree.Find(shape.col(v), child.extent, [&](int c) { return c == pair.parent; });
      if (nearest.component < 0) continue;
      const auto& [a, b, c] = nearest.corners;
      const double side =
          std::max({Distance(shape, a, b), Distance(shape, b, c), Distance(shape, c, a)});
      Candidate candidate = {v, a, nearest.distance};
      bool alike = true;
      for (const int corner : nearest.corners) {
        const double distance = Distance(shape, v, corner);
        alike = alike && IsAlike(v, corner, std::max({distance, side, kPlace * child.extent}));
        if (distance < (1 - kEqual) * Distance(shape, v, candidate.target)) {
          candidate.target = corner;
        }
      }
      if (alike) candidates.push_back(candidate);
    }
    return candidates;
  }

  // Whether the vertices are on a line, or fewer than three.
  bool AreOnLine(const std::vector<int>& vertices) const {
    if (vertices.size() < 3) return true;
    const Shape points = shapes_[searched_](Eigen::all, vertices);
    const Shape centred = points.colwise() - points.rowwise().mean();
    const Eigen::Vector3d extents = Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(
                                        centred * centred.transpose(), Eigen::EigenvaluesOnly)
                                        .eigenvalues();
    return extents(1) < kOnLine * kOnLine * extents(2);
  }

  // Vertices connected with `target` that are in a ball round `vertex`, so large that it reaches
  // the neighbours of `target` and that ties to its border hold along the surface too.
  std::vector<int> Around(int vertex, int target, double extent, double* radius) const {
    const Shape& shape = shapes_[searched_];
    double edges = 0;
    const IndexLists::Row row = connectivity_.EdgesOfVertices()[target];
    for (const int e : row) edges += Distance(shape, target, connectivity_.OtherEnd(e, target));
    *radius =
        std::max({kPlace * extent, 2 * Distance(shape, vertex, target), 2 * edges / row.size()});
    std::vector<int> found = {target};
    std::unordered_set<int> seen = {target};
    for (size_t next = 0; next < found.size() && found.size() < kMostAround; ++next) {
      const int at = found[next];
      for (const int e : connectivity_.EdgesOfVertices()[at]) {
        const int w = connectivity_.OtherEnd(e, at);
        if (Distance(shape, vertex, w) <= (1 + kEqual) * *radius && seen.insert(w).second) {
          found.push_back(w);
        }
      }
    }
    std::sort(found.begin(), found.end());
    return found;
  }

  // The stiffeners between two components; none if the one does not stay near the other.
  std::vector<Edge> TiesOf(const ComponentPair& pair, const ElementTree& tree) const {
    const Shape& shape = shapes_[searched_];
    const Component& child = components_[pair.child];
    const std::vector<Candidate> candidates = CandidatesOf(pair, tree);
    // The near ones; farther ones too, as long as the near ones are on a line.
    std::vector<int> vertices;
    std::map<int, int> target_of;
    double reach = pair.distance + kNear;
    do {
      vertices.clear();
      for (const Candidate& candidate : candidates) {
        if (candidate.distance > reach * child.extent) continue;
        vertices.push_back(candidate.vertex);
        target_of[candidate.vertex] = candidate.target;
      }
      reach *= 2;
    } while (!vertices.empty() && reach < 2 && AreOnLine(vertices));
    std::vector<Edge> ties;
    if (vertices.empty()) return ties;
    FarthestPoints points(shape, vertices, child.centre);
    for (int tried = 0, good = 0; tried < kTried && good < kPoints; ++tried) {
      const int v = points.Draw();
      if (v < 0) break;
      double radius;
      const std::vector<int> around = Around(v, target_of.at(v), child.extent, &radius);
      FarthestPoints targets(shape, around, shape.col(v));
      std::vector<Edge> edges;
      bool alike = true;
      for (int k = 0; k < kTargets && alike; ++k) {
        const int w = targets.Draw();
        if (w < 0) break;
        alike = IsAlike(v, w, radius);
        edges.emplace_back(std::min(v, w), std::max(v, w));
      }
      if (!alike) continue;
      ++good;
      ties.insert(ties.end(), edges.begin(), edges.end());
    }
    return ties;
  }

  const Connectivity& connectivity_;
  std::vector<int> component_;  // per vertex; -1: of none
  std::vector<Component> components_;
  std::vector<int> rank_;  // of each, the smallest first
  std::vector<Shape> shapes_;
  int searched_ = 0;  // the pose in which components are near each other
};

}  // namespace

Ties FindTies(const Connectivity& connectivity, const std::vector<Shape>& poses) {
  return TieSearch(connectivity, poses).Run();
}

std::shared_ptr<const Connectivity> WithStiffeners(const Connectivity& connectivity,
                                                   const std::vector<Edge>& stiffeners) {
  std::vector<Edge> extra = stiffeners;
  for (int e = connectivity.NumTriangleEdges(); e < connectivity.NumEdges(); ++e) {
    extra.emplace_back(connectivity.Edges()(0, e), connectivity.Edges()(1, e));
  }
  return Connectivity::Make(connectivity.NumVertices(), connectivity.PolygonBegin(),
                            connectivity.Corners(), connectivity.Segments(), extra,
                            connectivity.FileTriangles(), connectivity.Representatives());
}

std::shared_ptr<const Connectivity> WithoutStiffeners(
    const std::shared_ptr<const Connectivity>& connectivity) {
  if (connectivity->NumEdges() == connectivity->NumTriangleEdges()) return connectivity;
  auto surface = Connectivity::Make(connectivity->NumVertices(), connectivity->PolygonBegin(),
                                    connectivity->Corners(), connectivity->Segments(), {},
                                    connectivity->FileTriangles(), connectivity->Representatives());
  return surface->NumEdges() == connectivity->NumEdges() ? connectivity : surface;
}

}  // namespace shapespace
