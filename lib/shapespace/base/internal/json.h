#ifndef SHAPESPACE_BASE_INTERNAL_JSON_H_
#define SHAPESPACE_BASE_INTERNAL_JSON_H_

#include <string>
#include <string_view>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

// Strict reading of JSON written by a user. Errors are InvalidOptions that begin with the
// field, such as "ball.radius: ...". `field` names the value that is read; it is empty for the
// outermost one.

namespace shapespace::internal {

using Json = nlohmann::json;

/// \throw InvalidOptions naming the line where `text` is not valid JSON, contains a number outside
///        the range of double, or has a repeated key in an object.
Json ParseJson(const std::string& text);

/// The text of a value. Names in it may contain any bytes; those that are not UTF-8, as JSON has to
/// be, are replaced by U+FFFD. With an `indent` of -1 it is one line.
template <typename AnyJson>
std::string JsonText(const AnyJson& json, int indent = -1) {
  return json.dump(indent, ' ', false, AnyJson::error_handler_t::replace);
}

/// "field.key", or "key" inside the outermost object.
std::string Field(const std::string& field, const std::string& key);

/// \throw InvalidOptions "field: problem".
[[noreturn]] void FailIn(const std::string& field, const std::string& problem);

/// \throw InvalidOptions if `json` is not an object, or has a key that is not one of `keys`.
void CheckKeys(const Json& json, const std::string& field, const std::vector<std::string>& keys);

/// \throw InvalidOptions if the object `json` lacks `key`.
const Json& Required(const Json& json, std::string_view field, std::string_view key);

double NumberFrom(const Json& json, const std::string& field);
bool BoolFrom(const Json& json, const std::string& field);
std::string TextFrom(const Json& json, const std::string& field);

/// An array that is not empty.
const Json& ListFrom(const Json& json, std::string_view field);

/// Three numbers.
Eigen::Vector3d VectorFrom(const Json& json, const std::string& field);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_INTERNAL_JSON_H_
