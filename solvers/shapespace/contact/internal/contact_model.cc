#include <shapespace/contact/internal/contact_model.h>

#include <algorithm>
#include <utility>

#include <shapespace/analysis/intersections.h>
#include <shapespace/base/internal/sort_unique.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/mesh/ties.h>

namespace shapespace::internal {
namespace {

// In each pose a pair has this many times the reach of its potential, or more.
constexpr double kShareOfPose = 0.9;

// A segment touches what is nearer to it in a pose than this share of the pair's length.
constexpr double kTouching = 1e-3;

// Two edges are nearly parallel if they span less than this share of the area that their lengths
// allow.
constexpr double kParallel = 1e-3;

// The corners of a triangle, or the ends of a segment, and the ends of their edges.
std::vector<int> Around(const Connectivity& connectivity, const Eigen::Vector3i& corners) {
  std::vector<int> vertices;
  for (const int corner : corners) {
    for (const int e : connectivity.EdgesOfVertices()[corner]) {
      vertices.push_back(connectivity.OtherEnd(e, corner));
    }
  }
  return vertices;  // each corner is the end of another one's edge
}

// Pairs of vertices round the intersections of shapes with themselves; adds the number of these to
// `count`. Vertices from `num_moving` on are those of an obstacle, which may intersect itself.
std::vector<std::pair<int, int>> RoundIntersections(
    const std::shared_ptr<const Connectivity>& connectivity, const std::vector<Shape>& shapes,
    int num_moving, int* count) {
  std::vector<std::pair<int, int>> round;
  const auto add = [&](const Eigen::Vector3i& s, const Eigen::Vector3i& t) {
    if (std::min(s.minCoeff(), t.minCoeff()) >= num_moving) return;
    ++*count;
    for (const int v : Around(*connectivity, s)) {
      for (const int w : Around(*connectivity, t)) round.emplace_back(v, w);
    }
  };
  const Eigen::Matrix3Xi& triangles = connectivity->Triangles();
  for (const Shape& shape : shapes) {
    for (const auto& [s, t] : FindIntersections(*connectivity, shape)) {
      add(triangles.col(s), triangles.col(t));
    }
  }
  if (!connectivity->Segments().empty()) {
    const NearPairs pairs(connectivity, shapes, num_moving);
    for (const Shape& shape : shapes) {
      for (const auto& [s, t] : pairs.FindTouchingSegments(shape, kTouching)) add(s, t);
    }
  }
  SortUnique(&round);
  return round;
}

Eigen::VectorXd JoinAreas(const Metric& metric, const Obstacle* obstacle) {
  if (obstacle == nullptr) return metric.vertex_area;
  const Connectivity& connectivity = *obstacle->connectivity;
  Eigen::VectorXd areas(metric.vertex_area.size() + connectivity.NumVertices());
  areas << metric.vertex_area, Eigen::VectorXd::Zero(connectivity.NumVertices());
  const int begin = static_cast<int>(metric.vertex_area.size());
  for (int t = 0; t < connectivity.NumTriangles(); ++t) {
    const auto corners = connectivity.Triangles().col(t);
    const double area = TriangleArea(obstacle->shape, corners);
    for (int k = 0; k < 3; ++k) areas(begin + corners(k)) += area / 3;
  }
  return areas;
}

}  // namespace

ContactModel::ContactModel(std::shared_ptr<const Metric> metric, std::vector<Shape> poses,
                           Intersections intersections, const Obstacle* obstacle)
    : metric_(std::move(metric)),
      poses_(std::move(poses)),
      obstacle_(obstacle == nullptr ? Obstacle() : *obstacle),
      at_rest_(Tangent::Zero(3, obstacle_.shape.cols())),
      vertex_area_(JoinAreas(*metric_, obstacle)),
      pairs_([&] {
        std::shared_ptr<const Connectivity> connectivity = WithoutStiffeners(metric_->connectivity);
        std::vector<Shape> shapes = poses_;
        if (HasObstacle()) {
          connectivity = obstacle_.Joined(connectivity);
          for (Shape& shape : shapes) shape = obstacle_.Joined(shape);
        }
        std::vector<std::pair<int, int>> exempt;
        if (intersections == Intersections::kExempt) {
          exempt = RoundIntersections(connectivity, shapes, metric_->connectivity->NumVertices(),
                                      &num_intersections_);
        }
        return NearPairs(connectivity, shapes, metric_->connectivity->NumVertices(), exempt);
      }()) {
  const int num_vertices = metric_->connectivity->NumVertices();
  for (int v = 0; v < num_vertices; ++v) mean_length_ += pairs_.Length(v) / num_vertices;
}

std::vector<NearPair> ContactModel::Find(const Shape& from, const Shape& to, double share,
                                         double margin) const {
  return HasObstacle() ? pairs_.Find(obstacle_.Joined(from), obstacle_.Joined(to), share, margin)
                       : pairs_.Find(from, to, share, margin);
}

PairPotential ContactModel::PotentialOf(const NearPair& pair) const {
  const double length = pairs_.Length(pair);
  PairPotential potential = {pair.kind, 0, kReach * length, 0};
  for (const Shape& pose : poses_) {
    potential.reach = std::min(potential.reach,
                               kShareOfPose * NearestPoints(pair.kind, At(pair, pose)).Distance());
  }
  if (pair.kind == PairKind::kVertexTriangle) {
    potential.weight = vertex_area_(pair.vertices[0]);
  } else {
    constexpr double kPerEnd = 1. / 12;
    for (const int v : pair.vertices) potential.weight += kPerEnd * vertex_area_(v);
    potential.parallel = kParallel * length * length * length * length;
  }
  return potential;
}

bool ContactModel::IsFree(const Shape& from, const Shape& to) const {
  for (const NearPair& pair : Find(from, to, 0, 0)) {
    const FourPoints first = At(pair, from), change = At(pair, to) - first;
    const double begin = std::max(0.f, pair.begin), end = std::min(1.f, pair.end);
    if (!internal::IsFree(pair.kind, first + begin * change, first + end * change,
                          pairs_.Length(pair))) {
      return false;
    }
  }
  return true;
}

}  // namespace shapespace::internal
