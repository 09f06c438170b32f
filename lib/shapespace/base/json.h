#ifndef SHAPESPACE_BASE_JSON_H_
#define SHAPESPACE_BASE_JSON_H_

#include <string>
#include <vector>

#include <Eigen/Core>
#include <nlohmann/json.hpp>

// Private: JSON that a person has written, read strictly. What is wrong with it is told by an
// InvalidOptions that begins with the field, such as "ball.radius: ...". `field` names the value
// that is read; it is empty for the outermost one.

namespace shapespace::internal {

using Json = nlohmann::json;

/// \throw InvalidOptions naming the line where `text` is no JSON, holds a number that no double
///        can be, or gives one key twice in an object.
Json ParseJson(const std::string& text);

/// "field.key", or "key" inside the outermost object.
std::string Field(const std::string& field, const std::string& key);

/// \throw InvalidOptions "field: problem".
[[noreturn]] void FailIn(const std::string& field, const std::string& problem);

/// \throw InvalidOptions if `json` is no object, or has a key that is none of `keys`.
void CheckKeys(const Json& json, const std::string& field, const std::vector<std::string>& keys);

/// \throw InvalidOptions if the object `json` lacks `key`.
const Json& Required(const Json& json, const std::string& field, const std::string& key);

double NumberFrom(const Json& json, const std::string& field);
bool BoolFrom(const Json& json, const std::string& field);
std::string TextFrom(const Json& json, const std::string& field);

/// An array that is not empty.
const Json& ListFrom(const Json& json, const std::string& field);

/// Three numbers.
Eigen::Vector3d VectorFrom(const Json& json, const std::string& field);

}  // namespace shapespace::internal

#endif  // SHAPESPACE_BASE_JSON_H_
