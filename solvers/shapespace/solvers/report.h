#ifndef SHAPESPACE_SOLVERS_REPORT_H_
#define SHAPESPACE_SOLVERS_REPORT_H_

#include <cmath>
#include <cstdio>
#include <string>

#include <nlohmann/json.hpp>

// Private: what the reports of all solvers are written with.

namespace shapespace::internal {

/// printf into a string, of at most 511 characters.
template <typename... Arguments>
std::string Format(const char* format, Arguments... arguments) {
  char text[512];
  std::snprintf(text, sizeof text, format, arguments...);
  return text;
}

/// JSON knows no NaN: a figure that does not exist is null.
inline nlohmann::ordered_json JsonNumber(double value) {
  return std::isfinite(value) ? nlohmann::ordered_json(value) : nlohmann::ordered_json(nullptr);
}

}  // namespace shapespace::internal

#endif  // SHAPESPACE_SOLVERS_REPORT_H_
