#ifndef SHAPESPACE_JAVASCRIPT_OPTIONS_H_
#define SHAPESPACE_JAVASCRIPT_OPTIONS_H_

#include <functional>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include <emscripten/val.h>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/fields.h>
#include <shapespace/files/read.h>
#include <shapespace/metric/internal/option_fields.h>

#include "arrays.h"

namespace shapespace::internal {

/// What is done with meshes, which other doors have in their own words.
template <typename Visit>
void ForOptions(Of<ReadOptions>, const Visit& visit) {
  visit("allow_nonmanifold", &ReadOptions::allow_nonmanifold, "");
  visit("loose_components", &ReadOptions::loose_components, "");
  visit("mirror", &ReadOptions::mirror, "");
  visit("allow_mirrored", &ReadOptions::allow_mirrored, "");
  visit("allow_mismatch", &ReadOptions::allow_mismatch, "");
  visit("open_seams", &ReadOptions::open_seams, "");
}

}  // namespace shapespace::internal

// Options from objects of JavaScript. Names, defaults and meanings are those of the library
// (base/internal/fields.h), with the names as JavaScript writes them: maxIterations.

namespace shapespace::javascript {

/// max_iterations: maxIterations.
std::string CamelCase(const std::string& name);

/// Sets the options that `given`, an object, names; undefined and null set nothing.
/// \throw InvalidOptions naming one that is unknown or has a value of another type.
template <typename Options>
void Set(const val& given, Options* options);

[[noreturn]] void Refuse(const std::string& name, const std::string& type);
[[noreturn]] void RefuseUnknown(const std::string& name, const std::vector<std::string>& known);

template <typename T, typename = void>
struct Value {
  static constexpr bool kTaken = false;
};

template <>
struct Value<bool> {
  static constexpr bool kTaken = true;
  static void Set(const val& given, const std::string& name, bool* value) {
    if (!given.isTrue() && !given.isFalse()) Refuse(name, "true or false");
    *value = given.isTrue();
  }
};

template <typename T>
struct Value<T, std::enable_if_t<std::is_same_v<T, double> || std::is_same_v<T, int>>> {
  static constexpr bool kTaken = true;
  static void Set(const val& given, const std::string& name, T* value) {
    if (!given.isNumber()) Refuse(name, "a number");
    const double number = given.as<double>();
    *value = static_cast<T>(number);
    if (*value != number) Refuse(name, "a whole number");
  }
};

template <typename T>
struct Value<T, std::enable_if_t<std::is_enum_v<T>>> {
  static constexpr bool kTaken = true;
  static void Set(const val& given, const std::string& name, T* value) {
    const auto known =
        given.isString() ? internal::FromWord<T>(given.as<std::string>()) : std::nullopt;
    if (!known) Refuse(name, "one of " + internal::ListWords<T>("'"));
    *value = *known;
  }
};

template <>
struct Value<char> {
  static constexpr bool kTaken = true;
  static void Set(const val& given, const std::string& name, char* value) {
    const std::string text = given.isString() ? given.as<std::string>() : "";
    if (text.size() != 1) Refuse(name, "a single letter");
    *value = text[0];
  }
};

template <>
struct Value<std::vector<double>> {
  static constexpr bool kTaken = true;
  static void Set(const val& given, const std::string& name, std::vector<double>* value);
};

template <>
struct Value<Eigen::VectorXd> {
  static constexpr bool kTaken = true;
  static void Set(const val& given, const std::string& name, Eigen::VectorXd* value);
};

template <>
struct Value<MetricOptions> {
  static constexpr bool kTaken = true;
  static void Set(const val& given, const std::string& name, MetricOptions* value);
};

/// A metric that may be left out, which the caller has set to that of the mesh.
template <>
struct Value<std::optional<MetricOptions>> {
  static constexpr bool kTaken = true;
  static void Set(const val& given, const std::string& name, std::optional<MetricOptions>* value) {
    if (!value->has_value()) value->emplace();
    Value<MetricOptions>::Set(given, name, &**value);
  }
};

template <typename Options>
void Set(const val& given, Options* options) {
  if (given.isUndefined() || given.isNull()) return;
  const val names = val::global("Object").call<val>("keys", given);
  const int count = names["length"].as<int>();
  for (int i = 0; i < count; ++i) {
    const std::string name = names[i].as<std::string>();
    bool found = false;
    std::vector<std::string> known;
    internal::ForOptions(internal::Of<Options>(), [&](const char* field, auto get, const char*) {
      using T = std::decay_t<decltype(std::invoke(get, *options))>;
      if constexpr (Value<T>::kTaken) {
        known.push_back(CamelCase(field));
        if (known.back() != name) return;
        found = true;
        if (!given[name].isUndefined()) {
          Value<T>::Set(given[name], name, &std::invoke(get, *options));
        }
      }
    });
    if (!found) RefuseUnknown(name, known);
  }
}

}  // namespace shapespace::javascript

#endif  // SHAPESPACE_JAVASCRIPT_OPTIONS_H_
