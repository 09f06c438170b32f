#ifndef SHAPESPACE_TOOLS_SUPPORT_CHOOSE_H_
#define SHAPESPACE_TOOLS_SUPPORT_CHOOSE_H_

#include <string>
#include <utility>
#include <vector>

#include "support/tool.h"

namespace shapespace::tools {

/// The value for `name`, the argument of --`flag`.
/// \throw UsageError listing the names.
template <typename Value>
Value Choose(const char* flag, const std::string& name,
             const std::vector<std::pair<std::string, Value>>& choices) {
  std::string names;
  for (const auto& [choice, value] : choices) {
    if (choice == name) return value;
    names += (names.empty() ? "" : ", ") + choice;
  }
  throw UsageError("--" + std::string(flag) + " " + name + ": must be one of " + names);
}

}  // namespace shapespace::tools

#endif  // SHAPESPACE_TOOLS_SUPPORT_CHOOSE_H_
