#include <shapespace/deformation/handle_file.h>

#include <cmath>
#include <utility>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/json.h>
#include <shapespace/base/internal/quoted.h>
#include <shapespace/base/internal/read_file.h>
#include <shapespace/mesh/internal/geometry.h>
#include <shapespace/mesh/internal/selection_json.h>
#include <shapespace/mesh/seams.h>

namespace shapespace {
namespace {

using internal::BoolFrom;
using internal::CheckKeys;
using internal::FailIn;
using internal::Field;
using internal::Json;
using internal::ListFrom;
using internal::NumberFrom;
using internal::Required;
using internal::VectorFrom;

double BoundedNumber(const Json& json, const std::string& field, double most) {
  const double number = NumberFrom(json, field);
  if (!(std::abs(number) <= most)) {
    FailIn(field, "must be from " + Json(-most).dump() + " to " + Json(most).dump());
  }
  return number;
}

Eigen::Vector3d BoundedVector(const Json& json, const std::string& field) {
  Eigen::Vector3d vector = VectorFrom(json, field);
  for (const Json& number : json) BoundedNumber(number, field, kLargestCoordinate);
  return vector;
}

// The ways in which a handle can be moved; an entry must have exactly one of them.
enum class TargetKind { kFixed, kMotion, kPosition, kPositions };

TargetKind TargetOf(const Json& entry) {
  constexpr char kTargets[] = "fixed, translation, rotation, position, positions";
  const std::pair<const char*, TargetKind> keys[] = {{"fixed", TargetKind::kFixed},
                                                     {"translation", TargetKind::kMotion},
                                                     {"rotation", TargetKind::kMotion},
                                                     {"position", TargetKind::kPosition},
                                                     {"positions", TargetKind::kPositions}};
  const std::pair<const char*, TargetKind>* found = nullptr;
  for (const auto& key : keys) {
    if (!entry.contains(key.first)) continue;
    if (found != nullptr && found->second != key.second) {
      FailIn(key.first, std::string("excludes ") + found->first + "; leave one of them out");
    }
    found = &key;
  }
  if (found == nullptr) FailIn("", std::string("has no target; give one of ") + kTargets);
  return found->second;
}

ScrewMotion MotionFrom(const Json& entry, const Eigen::Vector3d& centroid) {
  constexpr double kMaxDegrees = 36000;  // a larger value is taken for a typing error
  ScrewMotion motion;
  motion.point = centroid;
  if (entry.contains("translation")) {
    motion.translation = BoundedVector(entry["translation"], "translation");
  }
  if (!entry.contains("rotation")) return motion;
  const Json& rotation = entry["rotation"];
  const std::string field = "rotation";
  CheckKeys(rotation, field, {"axis", "degrees", "point"});
  motion.axis = BoundedVector(Required(rotation, field, "axis"), Field(field, "axis"));
  if (motion.axis.isZero(0)) FailIn(Field(field, "axis"), "must not be zero: it is a direction");
  motion.axis.stableNormalize();
  motion.angle =
      BoundedNumber(Required(rotation, field, "degrees"), Field(field, "degrees"), kMaxDegrees) *
      internal::kPi / 180;
  if (rotation.contains("point")) {
    motion.point = BoundedVector(rotation["point"], Field(field, "point"));
  }
  return motion;
}

// The target positions of `count` vertices. Positions are in ascending order of the vertices'
// numbers, so the file must select them in this order.
Shape PositionsFrom(const Json& entry, const Selection& selection, size_t count) {
  const std::string field = "positions";
  const Json& list = ListFrom(entry["positions"], field);
  bool rise = selection.any.empty();
  for (size_t i = 1; i < selection.vertices.size(); ++i) {
    rise = rise && selection.vertices[i].first > selection.vertices[i - 1].second;
  }
  if (!rise) {
    FailIn(field,
           "are assigned in the order of the vertices' numbers; select the vertices in this order, "
           "each once and without \"any\"");
  }
  if (list.size() != count) {
    FailIn(field, std::to_string(list.size()) + " are given for " + std::to_string(count) +
                      " selected vertices; give one for each");
  }
  Shape positions(3, list.size());
  for (size_t i = 0; i < list.size(); ++i) {
    positions.col(i) = BoundedVector(list[i], field + " (position " + std::to_string(i + 1) + ")");
  }
  return positions;
}

void SetWeight(const Json& entry, DeformationHandle* handle) {
  const bool is_soft = entry.contains("weight");
  if (entry.contains("hard") && BoolFrom(entry["hard"], "hard") == is_soft) {
    FailIn("hard", is_soft ? "true excludes weight, which makes a handle soft; leave one out"
                           : "false needs a weight; give one");
  }
  handle->hard = !is_soft;
  if (!is_soft) return;
  handle->weight = NumberFrom(entry["weight"], "weight");
  if (!(handle->weight > 0 && handle->weight <= kLargestCoordinate)) {
    FailIn("weight", "must be positive and at most " + Json(kLargestCoordinate).dump());
  }
}

DeformationHandle HandleFrom(const Json& entry, const Shape& shape,
                             const Connectivity& connectivity, const Appearance& appearance) {
  CheckKeys(entry, "",
            {"name", "select", "fixed", "translation", "rotation", "position", "positions",
             "weight", "hard"});
  DeformationHandle handle;
  if (entry.contains("name")) handle.name = internal::TextFrom(entry["name"], "name");
  const Json& select = Required(entry, "", "select");
  Selection selection;
  try {
    selection = internal::ParseSelection(select);
    handle.vertices = SelectVertices(selection, shape, connectivity, appearance);
  } catch (const InvalidOptions& error) {
    FailIn("select", error.what());
  }
  const std::vector<int> points = RepresentativesOf(connectivity, handle.vertices);
  const Eigen::Vector3d centroid = shape(Eigen::all, points).rowwise().mean();
  switch (TargetOf(entry)) {
    case TargetKind::kFixed:
      if (!BoolFrom(entry["fixed"], "fixed")) {
        FailIn("fixed", "must be true; leave it out if the handle moves");
      }
      break;
    case TargetKind::kMotion:
      handle.motion = MotionFrom(entry, centroid);
      break;
    case TargetKind::kPosition: {
      const Eigen::Vector3d position = BoundedVector(entry["position"], "position");
      if (points.size() == 1) {
        handle.positions = position.replicate(1, static_cast<int>(handle.vertices.size()));
      } else {
        handle.motion.translation = position - centroid;
      }
      break;
    }
    case TargetKind::kPositions:
      handle.positions = PositionsFrom(entry, selection, handle.vertices.size());
      break;
  }
  SetWeight(entry, &handle);
  return handle;
}

// "handle 3 ('head')"; without a valid name only "handle 3".
std::string NameOf(const Json& entry, size_t i) {
  std::string name = "handle " + std::to_string(i + 1);
  if (entry.is_object() && entry.contains("name") && entry["name"].is_string()) {
    name += " (" + internal::Quoted(entry["name"].get<std::string>()) + ")";
  }
  return name;
}

std::vector<DeformationHandle> HandlesFrom(const Json& json, const Shape& shape,
                                           const Connectivity& connectivity,
                                           const Appearance& appearance) {
  CheckKeys(json, "", {"handles", "$schema"});
  const Json& entries = ListFrom(Required(json, "", "handles"), "handles");
  std::vector<DeformationHandle> handles;
  for (size_t i = 0; i < entries.size(); ++i) {
    try {
      handles.push_back(HandleFrom(entries[i], shape, connectivity, appearance));
    } catch (const InvalidOptions& error) {
      FailIn(NameOf(entries[i], i), error.what());
    }
  }
  return handles;
}

}  // namespace

std::vector<DeformationHandle> ReadHandles(const std::string& file, const Shape& shape,
                                           const Connectivity& connectivity,
                                           const Appearance& appearance) {
  const std::string text = internal::ReadFile(file);
  try {
    return HandlesFrom(internal::ParseJson(text), shape, connectivity, appearance);
  } catch (const InvalidOptions& error) {
    throw FileError(file + ": " + error.what());
  }
}

}  // namespace shapespace
