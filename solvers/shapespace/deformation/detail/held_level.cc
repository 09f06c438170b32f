#include <shapespace/deformation/detail/held_level.h>

#include <algorithm>
#include <map>
#include <set>
#include <utility>

#include <shapespace/mesh/rigid_motion.h>

namespace shapespace::internal {
namespace {

// The constraints on a level. All vertices of components without a handle are prescribed, because a
// cost of volume could move them.
PositionConstraints ConstraintsOf(const HandleTargets& targets, const std::vector<int>& vertices,
                                  const std::vector<int>& component, const Eigen::VectorXd& areas,
                                  double strength) {
  PositionConstraints constraints = targets.Restrict(vertices, areas, strength);
  std::set<int> held;
  for (int v : targets.Held()) {
    const auto found = std::lower_bound(vertices.begin(), vertices.end(), v);
    if (found != vertices.end() && *found == v) held.insert(component[found - vertices.begin()]);
  }
  held.erase(-1);
  for (size_t v = 0; v < vertices.size(); ++v) {
    const bool is_held =
        std::binary_search(targets.Held().begin(), targets.Held().end(), vertices[v]);
    if (held.count(component[v]) == 0 && !is_held) {
      constraints.prescribed.push_back(static_cast<int>(v));
    }
  }
  return constraints;
}

}  // namespace

HeldLevel::HeldLevel(const std::shared_ptr<const Metric>& metric, Shape rest,
                     const std::vector<int>& vertices, std::vector<int> component,
                     const HandleTargets& targets, double strength)
    : component_(std::move(component)),
      path_(metric, std::move(rest),
            ConstraintsOf(targets, vertices, component_, metric->vertex_area, strength)) {
  for (size_t k = 0; k < targets.Held().size(); ++k) {
    const auto found = std::lower_bound(vertices.begin(), vertices.end(), targets.Held()[k]);
    if (found == vertices.end() || *found != targets.Held()[k]) continue;
    held_.push_back({static_cast<int>(k), static_cast<int>(found - vertices.begin()),
                     targets.IsCarried(k), targets.IsGiven(k)});
  }
}

void HeldLevel::MoveComponents(const Shape& handle_positions, Shape* shape) const {
  std::map<int, std::vector<const Held*>> held;
  for (const Held& one : held_) held[component_[one.vertex]].push_back(&one);
  std::map<int, RigidMotion> motions;
  for (const auto& [component, list] : held) {
    Shape from(3, list.size()), to(3, list.size());
    for (size_t k = 0; k < list.size(); ++k) {
      from.col(k) = shape->col(list[k]->vertex);
      to.col(k) = handle_positions.col(list[k]->column);
    }
    motions[component] = FitRigidMotion(from, to, Eigen::VectorXd::Ones(from.cols()));
  }
  for (int v = 0; v < shape->cols(); ++v) {
    const auto found = motions.find(component_[v]);
    if (component_[v] >= 0 && found != motions.end()) {
      shape->col(v) = found->second.rotation * shape->col(v) + found->second.translation;
    }
  }
}

void HeldLevel::MoveHandlesTo(const std::vector<Shape>& handle_positions,
                              std::vector<Shape>* shapes) const {
  const size_t last = shapes->size() - 1;
  std::vector<Tangent> ways(last, Tangent::Zero(3, component_.size()));
  for (size_t i = 1; i <= last; ++i) {
    for (const Held& held : held_) {
      ways[i - 1].col(held.vertex) =
          handle_positions[i].col(held.column) - (*shapes)[i].col(held.vertex);
    }
  }
  const std::vector<Tangent> steps = path_.Factors().Extend(ways);
  for (size_t i = 1; i <= last; ++i) {
    (*shapes)[i] += steps[i - 1];
    Place(handle_positions[i], i == last, &(*shapes)[i]);
  }
}

Shape HeldLevel::WithHardHandlesAt(const Shape& handle_positions, const Shape& shape) const {
  Tangent way = Tangent::Zero(3, shape.cols());
  for (const Held& held : held_) {
    if (held.given) {
      way.col(held.vertex) = handle_positions.col(held.column) - shape.col(held.vertex);
    }
  }
  Shape moved = shape + path_.Factors().Extend({way}).front();
  Place(handle_positions, true, &moved);
  return moved;
}

void HeldLevel::Place(const Shape& handle_positions, bool last, Shape* shape) const {
  for (const Held& held : held_) {
    if (held.prescribed || (held.given && last)) {
      shape->col(held.vertex) = handle_positions.col(held.column);
    }
  }
}

Shape HeldLevel::Target(const Shape& handle_positions) const {
  Shape target = Shape::Zero(3, component_.size());
  for (const Held& held : held_) target.col(held.vertex) = handle_positions.col(held.column);
  return target;
}

}  // namespace shapespace::internal
