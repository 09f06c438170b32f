#include <shapespace/analysis/near_pairs.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <tuple>
#include <utility>

#include <Eigen/Geometry>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/sort_unique.h>
#include <shapespace/base/parallel.h>

namespace shapespace {
namespace {

using Eigen::Vector3d;

// The lengths of all edges, the mean of those in some shapes.
Eigen::VectorXd MeanEdgeLengths(const Connectivity& connectivity,
                                const std::vector<Shape>& shapes) {
  Eigen::VectorXd lengths = Eigen::VectorXd::Zero(connectivity.NumEdges());
  for (const Shape& shape : shapes) {
    for (int e = 0; e < connectivity.NumEdges(); ++e) {
      const auto edge = connectivity.Edges().col(e);
      lengths(e) +=
          (shape.col(edge(1)) - shape.col(edge(0))).norm() / static_cast<double>(shapes.size());
    }
  }
  return lengths;
}

std::vector<double> LengthsAtVertices(const Connectivity& connectivity,
                                      const Eigen::VectorXd& edges) {
  std::vector<double> lengths(connectivity.NumVertices(), 0);
  for (int v = 0; v < connectivity.NumVertices(); ++v) {
    const auto around = connectivity.EdgesOfVertices()[v];
    for (const int e : around) lengths[v] += edges(e) / around.size();
  }
  return lengths;
}

// The neighbours of a vertex on the surface as NearPairs defines them, but for symmetry.
std::vector<int> NeighboursOf(int vertex, const Connectivity& connectivity,
                              const Eigen::VectorXd& edges, double within) {
  struct Reached {
    int vertex, steps;
    double distance;
  };
  std::vector<Reached> reached = {{vertex, 0, 0}};
  // Whoever is reached in fewer steps or on a shorter way than before passes it on.
  std::vector<size_t> queue = {0};
  for (size_t next = 0; next < queue.size(); ++next) {
    const Reached at = reached[queue[next]];
    for (const int e : connectivity.EdgesOfVertices()[at.vertex]) {
      const Reached end = {connectivity.OtherEnd(e, at.vertex), at.steps + 1,
                           at.distance + edges(e)};
      if (end.steps > 2 && end.distance > within) continue;
      const size_t i = std::find_if(reached.begin(), reached.end(),
                                    [&](const Reached& r) { return r.vertex == end.vertex; }) -
                       reached.begin();
      if (i == reached.size()) {
        reached.push_back(end);
      } else if (end.steps < reached[i].steps || end.distance < reached[i].distance) {
        reached[i].steps = std::min(reached[i].steps, end.steps);
        reached[i].distance = std::min(reached[i].distance, end.distance);
      } else {
        continue;
      }
      queue.push_back(i);
    }
  }
  std::vector<int> found;
  for (const Reached& r : reached) found.push_back(r.vertex);
  std::sort(found.begin(), found.end());
  return found;
}

IndexLists ToLists(const std::vector<std::vector<int>>& rows) {
  std::vector<int> begin = {0}, items;
  for (const std::vector<int>& row : rows) {
    items.insert(items.end(), row.begin(), row.end());
    begin.push_back(static_cast<int>(items.size()));
  }
  return {std::move(begin), std::move(items)};
}

IndexLists Neighbours(const Connectivity& connectivity, const Eigen::VectorXd& edges,
                      const std::vector<double>& lengths,
                      const std::vector<std::pair<int, int>>& more) {
  constexpr double kLengths = 2;
  std::vector<std::vector<int>> rows(connectivity.NumVertices());
  ParallelFor(connectivity.NumVertices(), [&](int v) {
    rows[v] = NeighboursOf(v, connectivity, edges, kLengths * lengths[v]);
  });
  std::vector<std::vector<int>> both = rows;
  for (int v = 0; v < connectivity.NumVertices(); ++v) {
    for (const int w : rows[v]) {
      if (!std::binary_search(rows[w].begin(), rows[w].end(), v)) both[w].push_back(v);
    }
  }
  for (const auto& [v, w] : more) {
    both[v].push_back(w);
    both[w].push_back(v);
  }
  for (std::vector<int>& row : both) {
    internal::SortUnique(&row);
  }
  return ToLists(both);
}

// Appends to row t the vertices, or edges, whose first triangle is t.
void GiveToTriangles(const IndexLists& triangles, std::vector<std::vector<int>>* rows) {
  for (int i = 0; i < triangles.NumRows(); ++i) {
    if (triangles[i].size() > 0) (*rows)[triangles[i][0]].push_back(i);
  }
}

// Whether a segment passes through the inside of a triangle.
bool Pierces(const Vector3d& from, const Vector3d& to, const Eigen::Matrix3d& triangle) {
  const auto side = [](const Vector3d& a, const Vector3d& b, const Vector3d& c, const Vector3d& p) {
    return (b - a).cross(c - a).dot(p - a);
  };
  const Vector3d a = triangle.col(0), b = triangle.col(1), c = triangle.col(2);
  if (side(a, b, c, from) * side(a, b, c, to) >= 0) return false;
  const double first = side(from, to, a, b), second = side(from, to, b, c),
               third = side(from, to, c, a);
  return (first > 0) == (second > 0) && (second > 0) == (third > 0);
}

bool ShareCorner(const Eigen::Vector3i& s, const Eigen::Vector3i& t) {
  return (s.array() == t(0)).any() || (s.array() == t(1)).any() || (s.array() == t(2)).any();
}

}  // namespace

namespace internal {

// A box at the beginning and at the end of a motion.
struct MovingBox {
  Vector3d low[2], high[2];
};

}  // namespace internal

namespace {

using internal::MovingBox;

void Extend(MovingBox* box, const MovingBox& by) {
  for (int end = 0; end < 2; ++end) {
    box->low[end] = box->low[end].cwiseMin(by.low[end]);
    box->high[end] = box->high[end].cwiseMax(by.high[end]);
  }
}

// A part of the motion.
struct Times {
  double begin = 0, end = 1;
};

// Restricts `times` to those at which a gap that changes linearly is at most 0; returns whether
// there are any.
bool Restrict(double first, double last, Times* times) {
  if (first <= 0 && last <= 0) return true;
  if (first > 0 && last > 0) return false;
  const double zero = first / (first - last);
  (first > 0 ? times->begin : times->end) =
      first > 0 ? std::max(times->begin, zero) : std::min(times->end, zero);
  return times->begin <= times->end;
}

bool Meet(const MovingBox& a, const MovingBox& b, double reach, Times* times) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!Restrict(a.low[0](axis) - b.high[0](axis) - reach,
                  a.low[1](axis) - b.high[1](axis) - reach, times) ||
        !Restrict(b.low[0](axis) - a.high[0](axis) - reach,
                  b.low[1](axis) - a.high[1](axis) - reach, times)) {
      return false;
    }
  }
  return true;
}

}  // namespace

// One search: the boxes of its motion. What is found on all threads is joined in the order of the
// pairs of nodes with which they begin.
class NearPairs::Search {
 public:
  Search(const NearPairs& pairs, const Shape& from, const Shape& to, double share, double margin)
      : pairs_(pairs),
        from_(from),
        to_(to),
        share_(share),
        margin_(margin),
        boxes_(pairs.nodes_.size()) {
    for (int i = static_cast<int>(boxes_.size()) - 1; i >= 0; --i) {
      const Node& node = pairs.nodes_[i];
      if (node.right < 0) {
        const auto corners = pairs.elements_.col(node.left);
        boxes_[i] = Around(corners(0));
        Extend(&boxes_[i], Around(corners(1)));
        Extend(&boxes_[i], Around(corners(2)));
      } else {
        boxes_[i] = boxes_[node.left];
        Extend(&boxes_[i], boxes_[node.right]);
      }
    }
  }

  std::vector<NearPair> Run() const {
    return RunWith<NearPair>(
        [&](int a, int b, std::vector<NearPair>* found) { AddElements(a, b, found); });
  }

  // Calls add(a, b, found) for all two leaves that come near each other.
  template <typename Found, typename Add>
  std::vector<Found> RunWith(const Add& add) const {
    constexpr int kPerTask = 256;
    const int count = static_cast<int>(pairs_.fronts_.size());
    std::vector<std::vector<Found>> found((count + kPerTask - 1) / kPerTask);
    ParallelFor(static_cast<int>(found.size()), [&](int task) {
      const int end = std::min(count, (task + 1) * kPerTask);
      for (int i = task * kPerTask; i < end; ++i) {
        Between(pairs_.fronts_[i].first, pairs_.fronts_[i].second,
                [&](int a, int b) { add(a, b, &found[task]); });
      }
    });
    std::vector<Found> all;
    for (const std::vector<Found>& part : found) all.insert(all.end(), part.begin(), part.end());
    return all;
  }

 private:
  MovingBox Around(int vertex) const {
    return {{from_.col(vertex), to_.col(vertex)}, {from_.col(vertex), to_.col(vertex)}};
  }
  MovingBox AroundEdge(int edge) const {
    const auto ends = pairs_.connectivity_->Edges().col(edge);
    MovingBox box = Around(ends(0));
    Extend(&box, Around(ends(1)));
    return box;
  }

  // All leaves of two nodes that come near each other.
  template <typename Add>
  void Between(int a, int b, const Add& add) const {
    const Node &first = pairs_.nodes_[a], &second = pairs_.nodes_[b];
    if (!first.moves && !second.moves) return;
    Times times;
    if (!Meet(boxes_[a], boxes_[b], share_ * std::min(first.length, second.length) + margin_,
              &times)) {
      return;
    }
    if (first.elements == 1 && second.elements == 1) {
      add(a, b);
    } else if (first.elements >= second.elements) {
      Between(first.left, b, add);
      Between(first.right, b, add);
    } else {
      Between(a, second.left, add);
      Between(a, second.right, add);
    }
  }

  void AddElements(int a, int b, std::vector<NearPair>* found) const {
    const int s = pairs_.nodes_[a].left, t = pairs_.nodes_[b].left;
    const Connectivity& connectivity = *pairs_.connectivity_;
    for (const auto& [owner, other, box] :
         {std::make_tuple(s, t, &boxes_[b]), {t, s, &boxes_[a]}}) {
      // To a segment a vertex is as near as its edges are, or farther.
      if (other >= connectivity.NumTriangles()) continue;
      const auto corners = connectivity.Triangles().col(other);
      for (const int v : pairs_.vertices_of_elements_[owner]) {
        Add(PairKind::kVertexTriangle, {v, corners(0), corners(1), corners(2)}, Around(v), *box,
            found);
      }
    }
    for (const int i : pairs_.edges_of_elements_[s]) {
      for (const int j : pairs_.edges_of_elements_[t]) {
        const int e = std::min(i, j), f = std::max(i, j);
        const auto first = connectivity.Edges().col(e), second = connectivity.Edges().col(f);
        Add(PairKind::kEdgeEdge, {first(0), first(1), second(0), second(1)}, AroundEdge(e),
            AroundEdge(f), found);
      }
    }
  }

  void Add(PairKind kind, const std::array<int, 4>& vertices, const MovingBox& first,
           const MovingBox& second, std::vector<NearPair>* found) const {
    NearPair pair = {kind, vertices, 0, 1};
    Times times;
    if (!Meet(first, second, share_ * pairs_.Length(pair) + margin_, &times)) return;
    if (pairs_.AreNeighbours(pair)) return;
    if (*std::min_element(vertices.begin(), vertices.end()) >= pairs_.num_moving_) return;
    // Rounded outwards to single precision.
    pair.begin = std::nextafter(static_cast<float>(times.begin), -1.f);
    pair.end = std::nextafter(static_cast<float>(times.end), 2.f);
    found->push_back(pair);
  }

  const NearPairs& pairs_;
  const Shape &from_, &to_;
  const double share_, margin_;
  std::vector<MovingBox> boxes_;  // by node
};

NearPairs::NearPairs(std::shared_ptr<const Connectivity> connectivity,
                     const std::vector<Shape>& shapes, int num_moving,
                     const std::vector<std::pair<int, int>>& exempt)
    : connectivity_(std::move(connectivity)), num_moving_(num_moving) {
  if (connectivity_->NumTriangles() == 0) throw MeshError("contact: the mesh has no triangles");
  for (const Shape& shape : shapes) {
    if (shape.cols() != connectivity_->NumVertices() || !shape.allFinite()) {
      throw MeshError(
          "contact: a shape is not finite, or has another number of vertices than the mesh");
    }
  }
  const Eigen::VectorXd edges = MeanEdgeLengths(*connectivity_, shapes);
  lengths_ = LengthsAtVertices(*connectivity_, edges);
  FindElements();
  ParallelTasks(2, 2, [&](int task) {
    if (task == 0) {
      neighbours_ = Neighbours(*connectivity_, edges, lengths_, exempt);
    } else {
      BuildTree(shapes.front());
    }
  });
}

void NearPairs::FindElements() {
  const int num_triangles = connectivity_->NumTriangles();
  std::vector<int> segments;  // edges that are no sides of triangles
  for (const auto& [from, to] : connectivity_->Segments()) {
    const int a = connectivity_->Representative(from), b = connectivity_->Representative(to);
    for (const int e : connectivity_->EdgesOfVertices()[a]) {
      if (e >= connectivity_->NumTriangleEdges() && connectivity_->OtherEnd(e, a) == b) {
        segments.push_back(e);
      }
    }
  }
  internal::SortUnique(&segments);
  const size_t count = num_triangles + segments.size();
  std::vector<std::vector<int>> vertices(count), edges(count);
  GiveToTriangles(connectivity_->TrianglesOfVertices(), &vertices);
  GiveToTriangles(connectivity_->TrianglesOfEdges(), &edges);
  elements_.resize(3, static_cast<Eigen::Index>(count));
  elements_.leftCols(num_triangles) = connectivity_->Triangles();
  std::vector<char> has_element(connectivity_->NumVertices(), 0);
  for (size_t i = 0; i < segments.size(); ++i) {
    const auto ends = connectivity_->Edges().col(segments[i]);
    elements_.col(static_cast<Eigen::Index>(num_triangles + i)) << ends(0), ends(1), ends(1);
    edges[num_triangles + i] = {segments[i]};
    for (const int v : ends) {
      if (has_element[v] != 0 || connectivity_->TrianglesOfVertices()[v].size() > 0) continue;
      has_element[v] = 1;
      vertices[num_triangles + i].push_back(v);
    }
  }
  vertices_of_elements_ = ToLists(vertices);
  edges_of_elements_ = ToLists(edges);
}

void NearPairs::BuildTree(const Shape& shape) {
  const int num_elements = static_cast<int>(elements_.cols());
  Shape centres(3, num_elements);
  for (int t = 0; t < num_elements; ++t) {
    const auto corners = elements_.col(t);
    centres.col(t) = shape.col(corners(0)) + shape.col(corners(1)) + shape.col(corners(2));
  }
  std::vector<int> order(num_elements);
  std::iota(order.begin(), order.end(), 0);
  nodes_.reserve(2 * static_cast<size_t>(num_elements));
  Build(centres, order.data(), order.data() + num_elements);
  std::vector<Eigen::AlignedBox3d> boxes(nodes_.size());
  for (int i = static_cast<int>(boxes.size()) - 1; i >= 0; --i) {
    const Node& node = nodes_[i];
    if (node.right < 0) {
      for (const int v : elements_.col(node.left)) boxes[i].extend(shape.col(v));
    } else {
      boxes[i] = boxes[node.left].merged(boxes[node.right]);
      FindFronts(node.left, node.right, boxes);
    }
  }
}

// Halves the elements along the longest side of the box of their centres; returns the node.
int NearPairs::Build(const Shape& centres, int* begin, int* end) {
  const int index = static_cast<int>(nodes_.size());
  nodes_.emplace_back();
  Node node = {*begin, -1, static_cast<int>(end - begin), 0, false};
  if (end - begin == 1) {
    for (int k = 0; k < 3; ++k) {
      const int v = elements_(k, *begin);
      node.length = std::max(node.length, lengths_[v]);
      node.moves = node.moves || v < num_moving_;
    }
  } else {
    Vector3d low = centres.col(*begin), high = low;
    for (const int* t = begin; t != end; ++t) {
      low = low.cwiseMin(centres.col(*t));
      high = high.cwiseMax(centres.col(*t));
    }
    int axis;
    (high - low).maxCoeff(&axis);
    int* const middle = begin + (end - begin) / 2;
    std::nth_element(begin, middle, end, [&](int s, int t) {
      return std::make_pair(centres(axis, s), s) < std::make_pair(centres(axis, t), t);
    });
    node.left = Build(centres, begin, middle);
    node.right = Build(centres, middle, end);
    node.length = std::max(nodes_[node.left].length, nodes_[node.right].length);
    node.moves = nodes_[node.left].moves || nodes_[node.right].moves;
  }
  nodes_[index] = node;
  return index;
}

bool NearPairs::FindFronts(int a, int b, const std::vector<Eigen::AlignedBox3d>& boxes) {
  const Node &first = nodes_[a], &second = nodes_[b];
  if (!first.moves && !second.moves) return false;
  const size_t begin = fronts_.size();
  bool share = false;
  if (first.elements == 1 && second.elements == 1) {
    share = ShareCorner(elements_.col(first.left), elements_.col(second.left));
  } else if (boxes[a].intersects(boxes[b])) {
    if (first.elements >= second.elements) {
      share = FindFronts(first.left, b, boxes);
      share = FindFronts(first.right, b, boxes) || share;
    } else {
      share = FindFronts(a, second.left, boxes);
      share = FindFronts(a, second.right, boxes) || share;
    }
  }
  if (!share) {
    fronts_.resize(begin);
    fronts_.emplace_back(a, b);
  }
  return share;
}

double NearPairs::Length(const NearPair& pair) const {
  double least = lengths_[pair.vertices[0]];
  for (const int v : pair.vertices) least = std::min(least, lengths_[v]);
  return least;
}

bool NearPairs::AreNeighbours(int v, int w) const {
  const auto row = neighbours_[v];
  return std::binary_search(row.begin(), row.end(), w);
}

bool NearPairs::AreNeighbours(const NearPair& pair) const {
  const int first = FirstElementSize(pair.kind);
  for (int i = 0; i < first; ++i) {
    for (int j = first; j < 4; ++j) {
      if (AreNeighbours(pair.vertices[i], pair.vertices[j])) return true;
    }
  }
  return false;
}

std::vector<NearPair> NearPairs::Find(const Shape& from, const Shape& to, double share,
                                      double margin) const {
  return Search(*this, from, to, share, margin).Run();
}

std::vector<std::pair<Eigen::Vector3i, Eigen::Vector3i>> NearPairs::FindTouchingSegments(
    const Shape& shape, double share) const {
  using Found = std::pair<Eigen::Vector3i, Eigen::Vector3i>;
  const Search search(*this, shape, shape, share, 0);
  return search.RunWith<Found>([&](int a, int b, std::vector<Found>* found) {
    const int segment = std::max(nodes_[a].left, nodes_[b].left),
              other = std::min(nodes_[a].left, nodes_[b].left);
    const int num_triangles = connectivity_->NumTriangles();
    if (segment < num_triangles) return;
    const Eigen::Vector3i ends = elements_.col(segment), corners = elements_.col(other);
    const Vector3d from = shape.col(ends(0)), to = shape.col(ends(1));
    const auto is_near = [&](const NearPair& pair) {
      return !AreNeighbours(pair) &&
             NearestPoints(pair.kind, pair.At(shape)).Distance() <= share * Length(pair);
    };
    bool touches = false;
    for (int k = 0; k < 3 && !touches; ++k) {
      const int next = corners((k + 1) % 3);
      if (corners(k) == next) continue;
      touches = is_near({PairKind::kEdgeEdge, {ends(0), ends(1), corners(k), next}, 0, 1});
    }
    for (int k = 0; k < 2 && !touches && other < num_triangles; ++k) {
      touches =
          is_near({PairKind::kVertexTriangle, {ends(k), corners(0), corners(1), corners(2)}, 0, 1});
    }
    if (!touches && other < num_triangles) {
      touches = Pierces(from, to, shape(Eigen::all, corners));
    }
    if (touches) found->emplace_back(corners, ends);
  });
}

}  // namespace shapespace
