#include <shapespace/mesh/detail/element_tree.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include <shapespace/mesh/internal/nearest_on_triangle.h>

namespace shapespace::internal {
namespace {

constexpr int kElementsPerLeaf = 4;

double SquaredDistance(const Eigen::Vector3d& point, const Eigen::Vector3d& low,
                       const Eigen::Vector3d& high) {
  return (low - point).cwiseMax(point - high).cwiseMax(0).squaredNorm();
}

}  // namespace

ElementTree::ElementTree(const Connectivity& connectivity, const Shape& shape,
                         const std::vector<int>& component)
    : shape_(shape) {
  for (const auto& t : connectivity.Triangles().colwise()) {
    elements_.push_back({{t(0), t(1), t(2)}, component[t(0)]});
  }
  for (int e = connectivity.NumTriangleEdges(); e < connectivity.NumEdges(); ++e) {
    const int a = connectivity.Edges()(0, e), b = connectivity.Edges()(1, e);
    const IndexLists& triangles = connectivity.TrianglesOfVertices();
    // Others, such as diagonals of polygons, lie on the surface or inside of it.
    if (triangles[a].size() == 0 || triangles[b].size() == 0) {
      elements_.push_back({{a, b, b}, component[a]});
    }
  }
  std::vector<Eigen::Vector3d> centres;
  for (const Element& element : elements_) {
    const auto& [a, b, c] = element.corners;
    centres.emplace_back((shape.col(a) + shape.col(b) + shape.col(c)) / 3);
  }
  std::vector<int> order(elements_.size());
  std::iota(order.begin(), order.end(), 0);
  if (!order.empty()) Build(0, static_cast<int>(order.size()), &centres, &order);
  std::vector<Element> sorted;
  for (const int i : order) sorted.push_back(elements_[i]);
  elements_ = std::move(sorted);
}

// Appends the node of the elements order[begin] ... order[end - 1] and all that are below it.
void ElementTree::Build(int begin, int end, std::vector<Eigen::Vector3d>* centres,
                        std::vector<int>* order) {
  const size_t at = nodes_.size();
  const Element& first = elements_[(*order)[begin]];
  Node node = {
      shape_.col(first.corners[0]), shape_.col(first.corners[0]), begin, end, -1, first.component};
  Eigen::Vector3d low = (*centres)[(*order)[begin]], high = low;
  for (int i = begin; i < end; ++i) {
    const Element& element = elements_[(*order)[i]];
    for (const int v : element.corners) {
      node.low = node.low.cwiseMin(shape_.col(v));
      node.high = node.high.cwiseMax(shape_.col(v));
    }
    if (element.component != node.component) node.component = -1;
    low = low.cwiseMin((*centres)[(*order)[i]]);
    high = high.cwiseMax((*centres)[(*order)[i]]);
  }
  nodes_.push_back(node);
  if (end - begin <= kElementsPerLeaf) return;
  int axis;
  (high - low).maxCoeff(&axis);
  const int middle = (begin + end) / 2;
  std::nth_element(order->begin() + begin, order->begin() + middle, order->begin() + end,
                   [&](int i, int j) {
                     const double a = (*centres)[i](axis), b = (*centres)[j](axis);
                     return a < b || (a == b && i < j);
                   });
  Build(begin, middle, centres, order);
  nodes_[at].right = static_cast<int>(nodes_.size());
  Build(middle, end, centres, order);
}

ElementTree::Nearest ElementTree::Find(const Eigen::Vector3d& point, double within,
                                       const std::function<bool(int)>& admits) const {
  Nearest nearest;
  double best = within * within;
  std::vector<std::pair<double, int>> open;  // squared distances of boxes, and nodes
  const auto enter = [&](int i) {
    const Node& node = nodes_[i];
    if (node.component >= 0 && !admits(node.component)) return;
    const double squared = SquaredDistance(point, node.low, node.high);
    if (squared <= best) open.emplace_back(squared, i);
  };
  if (!nodes_.empty()) enter(0);
  while (!open.empty()) {
    const auto [squared, i] = open.back();
    open.pop_back();
    if (squared > best) continue;
    const Node& node = nodes_[i];
    if (node.right >= 0) {
      const size_t first = open.size();
      enter(i + 1);
      enter(node.right);
      // The nearer one is entered first.
      if (open.size() == first + 2 && open[first].first < open[first + 1].first) {
        std::swap(open[first], open[first + 1]);
      }
      continue;
    }
    for (int e = node.begin; e < node.end; ++e) {
      const Element& element = elements_[e];
      if (node.component < 0 && !admits(element.component)) continue;
      const auto& [a, b, c] = element.corners;
      Eigen::Matrix3d corners;
      corners << shape_.col(a) - point, shape_.col(b) - point, shape_.col(c) - point;
      const double distance =
          (corners * NearestOnTriangle(corners.col(0), corners.col(1), corners.col(2)))
              .squaredNorm();
      if (distance > best || (distance == best && nearest.component >= 0)) continue;
      best = distance;
      nearest = {element.corners, element.component, 0};
    }
  }
  if (nearest.component >= 0) nearest.distance = std::sqrt(best);
  return nearest;
}

}  // namespace shapespace::internal
