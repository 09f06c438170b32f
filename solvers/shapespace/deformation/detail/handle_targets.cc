#include <shapespace/deformation/detail/handle_targets.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include <shapespace/base/error.h>

namespace shapespace::internal {
namespace {

// Number of a handle's vertices that are kept on every level of a hierarchy.
constexpr int kPins = 12;

void CheckHandle(const DeformationHandle& handle, int number, int num_vertices) {
  const auto fail = [&](const std::string& what) {
    throw InvalidOptions("handles", "" + std::to_string(number) +
                                        (handle.name.empty() ? "" : " (\"" + handle.name + "\")") +
                                        ": " + what);
  };
  if (handle.vertices.empty()) fail("has no vertex");
  std::vector<int> sorted = handle.vertices;
  std::sort(sorted.begin(), sorted.end());
  for (size_t i = 0; i < sorted.size(); ++i) {
    if (sorted[i] < 0 || sorted[i] >= num_vertices) {
      fail("vertex " + std::to_string(sorted[i]) + " is not in 0 .. " +
           std::to_string(num_vertices - 1));
    }
    if (i > 0 && sorted[i] == sorted[i - 1]) {
      fail("vertex " + std::to_string(sorted[i]) + " is listed twice");
    }
  }
  if (handle.positions) {
    if (handle.positions->cols() != static_cast<int>(handle.vertices.size())) {
      fail("has " + std::to_string(handle.positions->cols()) + " positions for " +
           std::to_string(handle.vertices.size()) + " vertices");
    }
    if (!handle.positions->allFinite()) fail("a position is not finite");
  }
  const ScrewMotion& motion = handle.motion;
  if (!motion.axis.allFinite() || motion.axis.isZero(0)) fail("the axis must be finite and not 0");
  if (!std::isfinite(motion.angle)) fail("the angle is not finite");
  if (!motion.point.allFinite()) fail("the point is not finite");
  if (!motion.translation.allFinite()) fail("the translation is not finite");
  if (!handle.hard && !(handle.weight > 0 && std::isfinite(handle.weight))) {
    fail("the weight must be positive and finite");
  }
}

}  // namespace

HandleTargets::HandleTargets(const std::vector<DeformationHandle>& handles, const Shape& rest,
                             const Eigen::Vector3d& origin, double unit)
    : handles_(handles), rest_(rest), origin_(origin), unit_(unit) {
  std::vector<std::vector<Part>> parts(rest.cols());
  for (size_t h = 0; h < handles.size(); ++h) {
    CheckHandle(handles[h], static_cast<int>(h), static_cast<int>(rest.cols()));
    for (size_t k = 0; k < handles[h].vertices.size(); ++k) {
      parts[handles[h].vertices[k]].push_back(
          {static_cast<int>(h), static_cast<int>(k), handles[h].hard ? 1 : handles[h].weight});
    }
  }
  const auto is_hard = [&](const Part& part) { return handles_[part.handle].hard; };
  for (int v = 0; v < rest.cols(); ++v) {
    if (parts[v].empty()) continue;
    Hold hold = Hold::kSoft;
    if (std::any_of(parts[v].begin(), parts[v].end(), is_hard)) {
      parts[v].erase(std::remove_if(parts[v].begin(), parts[v].end(),
                                    [&](const Part& part) { return !is_hard(part); }),
                     parts[v].end());
      const bool moves_freely =
          std::any_of(parts[v].begin(), parts[v].end(),
                      [&](const Part& part) { return handles_[part.handle].positions; });
      hold = moves_freely ? Hold::kPrescribedLast : Hold::kPrescribed;
    }
    held_.push_back(v);
    hold_.push_back(hold);
    parts_.push_back(std::move(parts[v]));
  }
}

Eigen::Vector3d HandleTargets::Target(const Part& part, double t) const {
  const DeformationHandle& handle = handles_[part.handle];
  const Eigen::Vector3d from = rest_.col(handle.vertices[part.place]);
  return (handle.Target(part.place, t, from) - origin_) / unit_;
}

Shape HandleTargets::At(double t) const {
  Shape result = Shape::Zero(3, held_.size());
  for (size_t i = 0; i < held_.size(); ++i) {
    double sum = 0;
    for (const Part& part : parts_[i]) {
      result.col(i) += part.weight * Target(part, t);
      sum += part.weight;
    }
    result.col(i) /= sum;
  }
  return result;
}

PositionConstraints HandleTargets::Restrict(const std::vector<int>& vertices,
                                            const Eigen::VectorXd& areas, double strength) const {
  // Area of each handle on this mesh, and the number of soft handles with any.
  std::vector<double> area(handles_.size(), 0.0);
  const auto for_held = [&](const auto& body) {
    size_t i = 0;
    for (size_t v = 0; v < vertices.size(); ++v) {
      while (i < held_.size() && held_[i] < vertices[v]) ++i;
      if (i < held_.size() && held_[i] == vertices[v]) body(static_cast<int>(v), i);
    }
  };
  for_held([&](int v, size_t i) {
    if (hold_[i] != Hold::kSoft) return;
    for (const Part& part : parts_[i]) area[part.handle] += areas(v);
  });
  const double pulling = static_cast<double>(
      std::count_if(area.begin(), area.end(), [](double sum) { return sum > 0; }));
  PositionConstraints constraints;
  constraints.penalty = Eigen::VectorXd::Zero(vertices.size());
  for_held([&](int v, size_t i) {
    if (hold_[i] == Hold::kPrescribed) constraints.prescribed.push_back(v);
    if (hold_[i] == Hold::kPrescribedLast) constraints.prescribed_last.push_back(v);
    if (hold_[i] != Hold::kSoft) return;
    for (const Part& part : parts_[i]) {
      constraints.penalty(v) += strength / pulling * part.weight * areas(v) / area[part.handle];
    }
  });
  return constraints;
}

double HandleTargets::GreatestTurn() const {
  double greatest = 0;
  for (const DeformationHandle& handle : handles_) {
    if (!handle.positions) greatest = std::max(greatest, std::abs(handle.motion.angle));
  }
  return greatest;
}

std::vector<int> HandleTargets::Pins() const {
  std::vector<int> pins;
  for (const DeformationHandle& handle : handles_) {
    const Shape handle_positions = rest_(Eigen::all, handle.vertices);
    Eigen::VectorXd distance =
        Eigen::VectorXd::Constant(handle_positions.cols(), std::numeric_limits<double>::infinity());
    int next = 0;
    for (int k = 0; k < kPins && distance(next) > 0; ++k) {
      pins.push_back(handle.vertices[next]);
      distance = distance.cwiseMin((handle_positions.colwise() - handle_positions.col(next))
                                       .colwise()
                                       .squaredNorm()
                                       .transpose());
      distance.maxCoeff(&next);
    }
  }
  return pins;
}

bool HandleTargets::HoldAlike(const HandleTargets& other) const {
  const auto alike = [](const Part& a, const Part& b) {
    return a.handle == b.handle && a.weight == b.weight;
  };
  const auto lists_alike = [&](const std::vector<Part>& a, const std::vector<Part>& b) {
    return std::equal(a.begin(), a.end(), b.begin(), b.end(), alike);
  };
  return held_ == other.held_ && hold_ == other.hold_ &&
         std::equal(parts_.begin(), parts_.end(), other.parts_.begin(), other.parts_.end(),
                    lists_alike);
}

bool HandleTargets::IsNear(const HandleTargets& other, double most) const {
  for (const std::vector<Part>& parts : parts_) {
    for (const auto& [handle, place, weight] : parts) {
      // Angles that differ by a full turn have the same end but not the same course.
      const double angle = handles_[handle].motion.angle;
      if (std::abs(angle - other.handles_[handle].motion.angle) > most) return false;
    }
  }
  for (double t : {0.5, 1.0}) {
    if (((At(t) - other.At(t)).colwise().squaredNorm().array() > most * most).any()) return false;
  }
  return true;
}

}  // namespace shapespace::internal
