#ifndef SHAPESPACE_TESTS_SOLVERS_REPORTS_TEXTS_H_
#define SHAPESPACE_TESTS_SOLVERS_REPORTS_TEXTS_H_

#include <string>

#include <nlohmann/json.hpp>

namespace shapespace::testing {

/// JSON in lines: each entry of the whole has one, and so has each part of an entry that is long.
inline std::string Layout(const nlohmann::ordered_json& json, int level = 0) {
  constexpr size_t kLong = 200;
  const std::string line = json.dump();
  if (!json.is_structured() || line.size() <= kLong || level > 1) return line;
  const std::string indent(2 * level, ' ');
  std::string text;
  for (const auto& [key, value] : json.items()) {
    text += (text.empty() ? "\n  " : ",\n  ") + indent;
    if (json.is_object()) text += '"' + key + "\": ";
    text += Layout(value, level + 1);
  }
  return line.front() + text + '\n' + indent + line.back();
}

inline std::string JsonOf(const std::string& json) {
  return Layout(nlohmann::ordered_json::parse(json)) + '\n';
}

/// All that a summary says of itself.
template <typename Summary>
std::string TextsOf(const Summary& summary) {
  return summary.BriefReport() + "\n\n" + summary.FullReport() + '\n' + JsonOf(summary.ToJson());
}

/// The same for a summary without a report of several lines.
template <typename Summary>
std::string BriefTextsOf(const Summary& summary) {
  return summary.BriefReport() + '\n' + JsonOf(summary.ToJson());
}

}  // namespace shapespace::testing

#endif  // SHAPESPACE_TESTS_SOLVERS_REPORTS_TEXTS_H_
