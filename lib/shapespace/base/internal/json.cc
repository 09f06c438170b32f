#include <shapespace/base/internal/json.h>

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <set>

#include <shapespace/base/error.h>
#include <shapespace/base/internal/quoted.h>

namespace shapespace::internal {
namespace {

// Passes a text to the parser and records the position reached.
class Reader {
 public:
  using iterator_category = std::input_iterator_tag;
  using value_type = char;
  using difference_type = std::ptrdiff_t;
  using pointer = const char*;
  using reference = const char&;

  Reader(const char* at, const char** reached) : at_(at), reached_(reached) {}
  reference operator*() const { return *at_; }
  Reader& operator++() {
    *reached_ = ++at_;
    return *this;
  }
  bool operator==(const Reader& other) const { return at_ == other.at_; }
  bool operator!=(const Reader& other) const { return at_ != other.at_; }

 private:
  const char* at_;
  const char** reached_;
};

// The parser's message without its prefix: "[json.exception.parse_error.101] parse error at line 1,
// column 2: syntax error ...".
std::string WithoutPreamble(std::string message) {
  message.erase(0, message.find("] ") + 2);
  if (message.rfind("parse error at", 0) == 0) message.erase(0, message.find(": ") + 2);
  for (char& c : message) c = c >= ' ' && c <= '~' ? c : '?';
  return message;
}

std::string Listed(const std::vector<std::string>& words) {
  std::string list;
  for (const std::string& word : words) list += (list.empty() ? "" : ", ") + word;
  return list;
}

// "must be a number; this is of type string".
[[noreturn]] void FailOfType(const Json& json, const std::string& field,
                             const std::string& expected) {
  FailIn(field, "must be " + expected + "; this is of type " + json.type_name());
}

}  // namespace

Json ParseJson(const std::string& text) {
  const char* const begin = text.data();
  const char* reached = begin;
  const auto error_here = [&](const std::string& problem) {
    // The parser may have read one byte beyond the error.
    const auto lines = std::count(begin, std::max(begin, reached - 1), '\n');
    return InvalidOptions("line " + std::to_string(lines + 1), problem);
  };
  std::vector<std::set<std::string>> keys;  // of the objects that are being parsed
  const auto look_for_repetitions = [&](int, Json::parse_event_t event, const Json& parsed) {
    if (event == Json::parse_event_t::object_start) keys.emplace_back();
    if (event == Json::parse_event_t::object_end) keys.pop_back();
    if (event != Json::parse_event_t::key) return true;
    const auto key = parsed.get<std::string>();
    if (!keys.back().insert(key).second) {
      throw error_here("the key " + Quoted(key) + " occurs twice in one object; remove one");
    }
    return true;
  };
  try {
    return Json::parse(Reader(begin, &reached), Reader(begin + text.size(), &reached),
                       look_for_repetitions);
  } catch (const Json::exception& error) {
    throw error_here("this is not valid JSON: " + WithoutPreamble(error.what()));
  }
}

std::string Field(const std::string& field, const std::string& key) {
  return field.empty() ? key : field + "." + key;
}

void FailIn(const std::string& field, const std::string& problem) {
  throw InvalidOptions(field, problem);
}

void CheckKeys(const Json& json, const std::string& field, const std::vector<std::string>& keys) {
  if (!json.is_object()) FailOfType(json, field, "an object, { }, with keys of " + Listed(keys));
  for (const auto& [key, value] : json.items()) {
    if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
      FailIn(field, "unknown key " + Quoted(key) + "; the keys here are " + Listed(keys));
    }
  }
}

const Json& Required(const Json& json, std::string_view field, std::string_view key) {
  const auto found = json.find(std::string(key));
  if (found == json.end()) {
    FailIn(Field(std::string(field), std::string(key)), "is missing; add it");
  }
  return *found;
}

double NumberFrom(const Json& json, const std::string& field) {
  if (!json.is_number()) FailOfType(json, field, "a number");
  return json.get<double>();
}

bool BoolFrom(const Json& json, const std::string& field) {
  if (!json.is_boolean()) FailOfType(json, field, "true or false");
  return json.get<bool>();
}

std::string TextFrom(const Json& json, const std::string& field) {
  if (!json.is_string()) FailOfType(json, field, "a text in quotation marks");
  return json.get<std::string>();
}

const Json& ListFrom(const Json& json, std::string_view field) {
  if (!json.is_array()) FailOfType(json, std::string(field), "a list, [ ]");
  if (json.empty()) FailIn(std::string(field), "the list is empty");
  return json;
}

Eigen::Vector3d VectorFrom(const Json& json, const std::string& field) {
  const bool is_vector =
      json.is_array() && json.size() == 3 &&
      std::all_of(json.begin(), json.end(), [](const Json& number) { return number.is_number(); });
  if (!is_vector) FailIn(field, "must be three numbers, [x, y, z]");
  return {json[0].get<double>(), json[1].get<double>(), json[2].get<double>()};
}

}  // namespace shapespace::internal
