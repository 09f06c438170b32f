#ifndef SHAPESPACE_SUMMARY_INTERNAL_JSON_OF_H_
#define SHAPESPACE_SUMMARY_INTERNAL_JSON_OF_H_

#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

#include <nlohmann/json.hpp>

#include <shapespace/base/internal/fields.h>
#include <shapespace/base/internal/json.h>
#include <shapespace/summary/internal/report.h>

namespace shapespace::internal {

/// A value of a summary in JSON: numbers that are not finite are null, enumerations are words
/// (`WordOf`), structs with fields are objects.
template <typename T>
nlohmann::ordered_json JsonOf(const T& value);

template <typename T>
nlohmann::ordered_json JsonOf(const std::vector<T>& values) {
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const T& value : values) json.push_back(JsonOf(value));
  return json;
}

template <typename T>
nlohmann::ordered_json JsonOf(const std::vector<std::pair<std::string, T>>& values) {
  nlohmann::ordered_json json = nlohmann::ordered_json::object();
  for (const auto& [name, value] : values) json[name] = JsonOf(value);
  return json;
}

template <typename T>
nlohmann::ordered_json JsonOf(const T& value) {
  if constexpr (HasFields<T>::value) {
    nlohmann::ordered_json json;
    ForFields(Of<T>(), [&](const char* name, const auto& get) {
      json[name] = JsonOf(std::invoke(get, value));
    });
    return json;
  } else if constexpr (std::is_enum_v<T>) {
    return WordOf(value);
  } else if constexpr (std::is_floating_point_v<T>) {
    return JsonNumber(value);
  } else {
    return value;
  }
}

/// The text of a report.
inline std::string TextOf(const nlohmann::ordered_json& json) { return JsonText(json, 2) + "\n"; }

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SUMMARY_INTERNAL_JSON_OF_H_
