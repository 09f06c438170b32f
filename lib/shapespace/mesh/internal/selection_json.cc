#include <shapespace/mesh/internal/selection_json.h>

#include <cstdint>
#include <limits>

#include <shapespace/base/internal/text.h>

namespace shapespace {
namespace internal {
namespace {

// More nested selections are not plausible, and each needs space on the stack.
constexpr int kMaxNested = 50;

// A vertex number, counted from 1, as an index from 0.
int VertexFrom(const Json& json, const std::string& field) {
  constexpr std::uint64_t kMax = std::numeric_limits<int>::max();
  if (!json.is_number_integer()) {
    FailIn(field, "must hold vertex numbers and ranges of them, such as [1, 2, [10, 20]]");
  }
  const auto number = json.is_number_unsigned() ? json.get<std::uint64_t>() : 0;
  if (number < 1 || number > kMax) {
    FailIn(field, json.dump() + " is not a vertex number" +
                      (json == 0 ? kCountsFromOne : "; the first vertex has the number 1"));
  }
  return static_cast<int>(number - 1);
}

std::vector<std::pair<int, int>> RangesFrom(const Json& json, const std::string& field) {
  std::vector<std::pair<int, int>> ranges;
  for (const Json& item : ListFrom(json, field)) {
    if (!item.is_array()) {
      const int vertex = VertexFrom(item, field);
      ranges.emplace_back(vertex, vertex);
    } else if (item.size() == 2) {
      ranges.emplace_back(VertexFrom(item[0], field), VertexFrom(item[1], field));
    } else {
      FailIn(field, "a range is two vertex numbers, its first and its last, such as [10, 20]");
    }
  }
  return ranges;
}

Selection ParseNested(const Json& json, const std::string& field, int depth) {
  if (depth > kMaxNested) {
    FailIn(field, "more than " + std::to_string(kMaxNested) + " selections inside each other");
  }
  CheckKeys(json, field, {"vertices", "ball", "box", "halfspace", "group", "any"});
  Selection selection;
  const auto vector = [](const Json& object, const std::string& within, const std::string& key) {
    return VectorFrom(Required(object, within, key), Field(within, key));
  };
  if (json.contains("vertices")) {
    selection.vertices = RangesFrom(json["vertices"], Field(field, "vertices"));
  }
  if (json.contains("ball")) {
    const Json& ball = json["ball"];
    const std::string own = Field(field, "ball");
    CheckKeys(ball, own, {"centre", "center", "radius"});
    const char* centre = ball.contains("center") ? "center" : "centre";
    if (ball.contains("centre") && ball.contains("center")) {
      FailIn(Field(own, "center"), "is another spelling of centre; leave one out");
    }
    selection.ball = {vector(ball, own, centre),
                      NumberFrom(Required(ball, own, "radius"), Field(own, "radius"))};
  }
  if (json.contains("box")) {
    const Json& box = json["box"];
    const std::string own = Field(field, "box");
    CheckKeys(box, own, {"low", "high"});
    selection.box = {vector(box, own, "low"), vector(box, own, "high")};
  }
  if (json.contains("halfspace")) {
    const Json& halfspace = json["halfspace"];
    const std::string own = Field(field, "halfspace");
    CheckKeys(halfspace, own, {"point", "normal"});
    selection.halfspace = {vector(halfspace, own, "point"), vector(halfspace, own, "normal")};
  }
  if (json.contains("group")) selection.group = TextFrom(json["group"], Field(field, "group"));
  if (json.contains("any")) {
    const Json& any = ListFrom(json["any"], Field(field, "any"));
    for (size_t i = 0; i < any.size(); ++i) {
      selection.any.push_back(ParseNested(any[i], FieldOfAny(field, i), depth + 1));
    }
  }
  return selection;
}

nlohmann::ordered_json JsonOf(const Selection& selection) {
  using Ordered = nlohmann::ordered_json;
  const auto vector = [](const Eigen::Vector3d& v) { return Ordered({v.x(), v.y(), v.z()}); };
  Ordered json = Ordered::object();
  for (const auto& [first, last] : selection.vertices) {
    const auto from = std::int64_t{first} + 1, to = std::int64_t{last} + 1;
    json["vertices"].push_back(from == to ? Ordered(from) : Ordered({from, to}));
  }
  if (selection.ball) {
    json["ball"] = {{"centre", vector(selection.ball->centre)}, {"radius", selection.ball->radius}};
  }
  if (selection.box) {
    json["box"] = {{"low", vector(selection.box->low)}, {"high", vector(selection.box->high)}};
  }
  if (selection.halfspace) {
    json["halfspace"] = {{"point", vector(selection.halfspace->point)},
                         {"normal", vector(selection.halfspace->normal)}};
  }
  if (selection.group) json["group"] = *selection.group;
  for (const Selection& each : selection.any) json["any"].push_back(JsonOf(each));
  return json;
}

}  // namespace

Selection ParseSelection(const Json& json) {
  Selection selection = ParseNested(json, "", 0);
  selection.Validate();
  return selection;
}

std::string FieldOfAny(const std::string& field, size_t i) {
  return Field(field, "any") + " (selection " + std::to_string(i + 1) + ")";
}

}  // namespace internal

Selection ReadSelection(const std::string& text) {
  return internal::ParseSelection(internal::ParseJson(text));
}

std::string ToText(const Selection& selection) {
  return internal::JsonText(internal::JsonOf(selection));
}

}  // namespace shapespace
