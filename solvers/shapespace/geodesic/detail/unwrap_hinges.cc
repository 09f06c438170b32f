#include <shapespace/geodesic/detail/unwrap_hinges.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <shapespace/base/internal/ranges.h>
#include <shapespace/base/internal/sort_unique.h>
#include <shapespace/mesh/rigid_motion.h>

namespace shapespace::internal {
namespace {

constexpr int kHingesPerTask = 1024;

// Whether the turns of a hinge add up to more than the least turn plus 180 degrees, or whether it
// turns in one segment by more than twice the mean of a turn by 180 degrees.
bool IsWound(const Dihedral& dihedral, int hinge, const std::vector<Shape>& shapes) {
  const int segments = static_cast<int>(shapes.size()) - 1;
  double first = 0, before = 0, turned = 0, fastest = 0;
  for (int i = 0; i <= segments; ++i) {
    double x[12];
    GatherCoordinates(dihedral, hinge, shapes[i], x);
    const double angle = dihedral.Angle(x);
    if (i == 0) {
      first = angle;
    } else {
      const double turn = std::abs(WrapAngle(angle - before));
      turned += turn;
      fastest = std::max(fastest, turn);
    }
    before = angle;
  }
  return turned > std::abs(WrapAngle(before - first)) + M_PI || fastest > 2 * M_PI / segments;
}

// The cosine and the sine of a hinge's angle, zero if one of its triangles has no area. As fast as
// possible: with e from `a` to `b`, the normals e x (c - a) and (d - a) x e have the vector product
// -(e x (c - a)) . (d - a) e.
Eigen::Vector2d PointOnCircle(const Eigen::Vector4i& hinge, const Shape& shape) {
  const Eigen::Vector3d a = shape.col(hinge(0)), e = shape.col(hinge(1)) - a;
  const Eigen::Vector3d f = shape.col(hinge(3)) - a;
  const Eigen::Vector3d normal = e.cross(shape.col(hinge(2)) - a);
  return Eigen::Vector2d(normal.dot(f.cross(e)), -normal.dot(f) * e.norm()).normalized();
}

// Sets `wound` for hinges of a range. An angle is at most half of pi times its chord on the unit
// circle, so that most hinges need no angles.
void FindWound(const Dihedral& dihedral, const std::vector<Shape>& shapes, int begin, int end,
               std::vector<char>* wound) {
  const int segments = static_cast<int>(shapes.size()) - 1;
  struct Bounds {
    Eigen::Vector2d before;
    double turned = 0, fastest = 0;
  };
  std::vector<Bounds> bounds(end - begin);
  for (int i = 0; i <= segments; ++i) {
    for (int h = begin; h < end; ++h) {
      Bounds& bound = bounds[h - begin];
      const Eigen::Vector2d point = PointOnCircle(dihedral.stencils.col(h), shapes[i]);
      if (i > 0) {
        const double turn = M_PI_2 * (point - bound.before).norm();
        bound.turned += turn;
        bound.fastest = std::max(bound.fastest, turn);
      }
      bound.before = point;
    }
  }
  for (int h = begin; h < end; ++h) {
    const Bounds& bound = bounds[h - begin];
    const bool possible = !(bound.turned <= M_PI && bound.fastest <= 2 * M_PI / segments);
    (*wound)[h] = possible && IsWound(dihedral, h, shapes);
  }
}

std::vector<int> WoundHinges(const Dihedral& dihedral, const std::vector<Shape>& shapes) {
  const int num_hinges = static_cast<int>(dihedral.stencils.cols());
  std::vector<char> wound(num_hinges);
  ForRanges(
      num_hinges, [&](int begin, int end) { FindWound(dihedral, shapes, begin, end, &wound); },
      kHingesPerTask);
  std::vector<int> result;
  for (int h = 0; h < num_hinges; ++h) {
    if (wound[h]) result.push_back(h);
  }
  return result;
}

}  // namespace

double ElementEnergy(const Metric& metric, const FeatureElement& element,
                     const std::vector<Shape>& shapes) {
  const Feature& feature = *metric.features[element.first];
  const int e = element.second, num_values = feature.ValuesPerElement();
  double x[Feature::kMaxInputs], values[2][Feature::kMaxValues], sum = 0;
  for (size_t i = 0; i < shapes.size(); ++i) {
    feature.GatherCoordinates(e, e + 1, shapes[i], x);
    double* const value = values[i % 2];
    feature.Evaluate(1, x, value);
    for (int k = 0; i > 0 && k < num_values; ++k) {
      sum += std::pow(value[k] - values[(i + 1) % 2][k], 2);
    }
  }
  return feature.Weight(e) * sum;
}

namespace {

// Moves vertices of a path and measures the change of energy.
class Mover {
 public:
  // Collects the elements and neighbours of `vertices`, the ones that may be moved.
  Mover(const Metric& metric, const std::vector<int>& vertices, std::vector<Shape>* shapes);

  // Puts `group`, some of the vertices, where the energy is least.
  void Move(const std::vector<int>& group);

 private:
  // The positions of the vertices `columns` in a shape.
  Shape Columns(const std::vector<int>& columns, size_t shape) const;
  void Place(const std::vector<int>& group, const std::vector<Shape>& places);
  // The sum over `elements`; stops when it exceeds `enough`.
  double Energy(const std::vector<FeatureElement>& elements, double enough) const;

  const Metric& metric_;
  std::vector<Shape>& shapes_;
  std::vector<int> index_;  // of a vertex of the mesh in the lists below, or -1
  std::vector<std::vector<FeatureElement>> elements_;
};

Mover::Mover(const Metric& metric, const std::vector<int>& vertices, std::vector<Shape>* shapes)
    : metric_(metric),
      shapes_(*shapes),
      index_(metric.connectivity->NumVertices(), -1),
      elements_(vertices.size()) {
  for (size_t i = 0; i < vertices.size(); ++i) index_[vertices[i]] = static_cast<int>(i);
  for (size_t f = 0; f < metric_.features.size(); ++f) {
    const Feature& feature = *metric_.features[f];
    if (feature.IsSum()) continue;
    for (int e = 0; e < feature.NumElements(); ++e) {
      for (int k = 0; k < feature.VerticesPerElement(); ++k) {
        const int i = index_[feature.Element(e)[k]];
        if (i >= 0) elements_[i].emplace_back(static_cast<int>(f), e);
      }
    }
  }
}

void Mover::Move(const std::vector<int>& group) {
  const Connectivity& connectivity = *metric_.connectivity;
  std::vector<int> around;
  std::vector<FeatureElement> elements;
  for (int v : group) {
    const int i = index_[v];
    for (const int edge : connectivity.EdgesOfVertices()[v]) {
      const int neighbour = connectivity.OtherEnd(edge, v);
      if (std::find(group.begin(), group.end(), neighbour) == group.end()) {
        around.push_back(neighbour);
      }
    }
    elements.insert(elements.end(), elements_[i].begin(), elements_[i].end());
  }
  SortUnique(&around);
  SortUnique(&elements);
  if (around.empty()) return;

  const size_t last = shapes_.size() - 1;
  const Eigen::VectorXd weights = Eigen::VectorXd::Ones(static_cast<int>(around.size()));
  const Shape first_around = Columns(around, 0), last_around = Columns(around, last);
  const Shape first_group = Columns(group, 0), last_group = Columns(group, last);
  std::vector<Shape> best, as_first, as_last, between;
  for (size_t i = 1; i < last; ++i) {
    const Shape here = Columns(around, i);
    best.push_back(Columns(group, i));
    as_first.push_back(FitRigidMotion(first_around, here, weights)(first_group));
    as_last.push_back(FitRigidMotion(last_around, here, weights)(last_group));
    const double t = static_cast<double>(i) / last;
    between.push_back((1 - t) * as_first.back() + t * as_last.back());
  }
  double least = Energy(elements, std::numeric_limits<double>::infinity());
  for (std::vector<Shape>* places : {&as_first, &as_last, &between}) {
    Place(group, *places);
    const double energy = Energy(elements, least);
    if (energy < least) {
      least = energy;
      best.swap(*places);
    }
  }
  Place(group, best);
}

Shape Mover::Columns(const std::vector<int>& columns, size_t shape) const {
  return shapes_[shape](Eigen::all, columns);
}

void Mover::Place(const std::vector<int>& group, const std::vector<Shape>& places) {
  for (size_t i = 0; i < places.size(); ++i) shapes_[i + 1](Eigen::all, group) = places[i];
}

double Mover::Energy(const std::vector<FeatureElement>& elements, double enough) const {
  double energy = 0;
  for (const FeatureElement& element : elements) {
    energy += ElementEnergy(metric_, element, shapes_);
    if (energy > enough) break;
  }
  return energy;
}

}  // namespace

void UnwrapHinges(const Metric& metric, std::vector<Shape>* shapes) {
  for (const auto& feature : metric.features) {
    const auto* const dihedral = feature->As<Dihedral>();
    if (dihedral == nullptr) continue;
    const std::vector<int> hinges = WoundHinges(*dihedral, *shapes);
    if (hinges.empty()) continue;
    std::vector<int> vertices;
    for (int h : hinges) {
      for (int v : dihedral->stencils.col(h)) vertices.push_back(v);
    }
    SortUnique(&vertices);
    Mover mover(metric, vertices, shapes);
    for (int h : hinges) {
      const Eigen::Vector4i stencil = dihedral->stencils.col(h);
      mover.Move({stencil(0), stencil(1), stencil(2), stencil(3)});
    }
    for (int v : vertices) mover.Move({v});
  }
}

}  // namespace shapespace::internal
